// How many pixels the picture has: fewer where the machine is slow, since a drive must run smoothly.

const FRAMES = 20; // looked at together
const SLOW_MS = { software: 45, card: 24 };
const FAST_MS = 20;
const STEP = 0.8;
const LOWEST = 0.5;
const PAUSE_MS = 500; // no frame at all: a pause, not a slow machine
const CALM = 8; // so many looks must be fast before there are more pixels again
const HELPS = 0.9; // fewer pixels must shorten a frame to this, or they are not what it waits for
const OWN_PACE = 1.3;

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
    this.software = software;
    /** what was before there were fewer pixels @type {{ratio: number, middle_ms: number} | null} */
    this.before = null;
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
    const { ratio } = this;
    if (this.#inVain(middle_ms)) this.slow_ms = OWN_PACE * middle_ms;
    else if (middle_ms > this.slow_ms) this.#lower(middle_ms);
    else if (middle_ms < FAST_MS) this.#raise();
    else this.calm = 0;
    return this.ratio !== ratio;
  }

  /** Screens of 30 pictures a second give no more for fewer pixels: they come back. @param {number} middle_ms */
  #inVain(middle_ms) {
    const { before } = this;
    this.before = null;
    if (!before || middle_ms < HELPS * before.middle_ms) return false;
    this.ratio = before.ratio;
    return true;
  }

  /** @param {number} middle_ms */
  #lower(middle_ms) {
    this.calm = 0;
    if (this.ratio <= LOWEST) return;
    // Where the processor paints, others' work makes times too uneven to be compared.
    if (!this.software) this.before = { ratio: this.ratio, middle_ms };
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
