// How many pixels the picture has: fewer where the machine is slow, since a drive must run smoothly.

const FRAMES = 20; // looked at together
const SLOW_MS = { software: 45, card: 24 };
const FAST_MS = 20;
const STEP = 0.8;
const LOWEST = 0.5;
const PAUSE_MS = 500; // no frame at all: a pause, not a slow machine
const CALM = 8; // so many looks must be fast before there are more pixels again

/** Watches the time between frames. */
export class Sharpness {
  /**
   * @param {number} finest pixels of the picture per pixel of the page
   * @param {boolean} software
   */
  constructor(finest, software) {
    this.finest = finest;
    this.ratio = finest;
    this.slow_ms = software ? SLOW_MS.software : SLOW_MS.card;
    /** @type {number[]} */
    this.times_ms = [];
    this.last_ms = NaN;
    this.calm = 0;
    this.patience = CALM;
  }

  /** @param {number} now_ms @returns {boolean} `ratio` has changed */
  frame(now_ms) {
    const passed_ms = now_ms - this.last_ms;
    this.last_ms = now_ms;
    if (!(passed_ms < PAUSE_MS)) return false;
    this.times_ms.push(passed_ms);
    if (this.times_ms.length < FRAMES) return false;
    const middle_ms = this.times_ms.sort((a, b) => a - b)[FRAMES / 2];
    this.times_ms = [];
    const before = this.ratio;
    if (middle_ms > this.slow_ms) this.#lower();
    else if (middle_ms < FAST_MS) this.#raise();
    else this.calm = 0;
    return this.ratio !== before;
  }

  #lower() {
    this.calm = 0;
    if (this.ratio <= LOWEST) return;
    this.ratio = Math.max(this.ratio * STEP, LOWEST);
    this.patience *= 2; // not to and fro
  }

  #raise() {
    this.calm += 1;
    if (this.calm < this.patience) return;
    this.ratio = Math.min(this.ratio / STEP, this.finest);
    this.calm = 0;
  }
}

/** Whether the processor paints, not a graphics card. @param {HTMLCanvasElement} canvas */
export function isSoftware(canvas) {
  const probe = canvas.ownerDocument.createElement("canvas").getContext("webgl2");
  const named = probe?.getExtension("WEBGL_debug_renderer_info");
  const name = named ? String(probe?.getParameter(named.UNMASKED_RENDERER_WEBGL)) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
