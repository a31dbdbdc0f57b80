// The lever: how long it is held decides between a short and a long tip.

/** Held this long, a tip is a long one; it is made at this moment, not when the lever is let go. */
const LONG_MS = 500;
/** How long a tip closes its contact, and then opens it: longer than what counts as chatter. */
const TIP_MS = 60;

/** @typedef {"resume" | "cancel" | "up" | "down"} Way in which the lever is moved */
/** @typedef {"resume" | "cancel" | "up" | "down" | "up_long" | "down_long"} Contact */

/** A lever that is moved in four ways and has six contacts; tips follow each other. */
export class Lever {
  constructor() {
    /** @type {Map<Way, number>} since when it is held, in ms; NaN: its tip is made */
    this.held = new Map();
    /** @type {Contact[]} tips that wait */
    this.tips = [];
    /** @type {Contact | null} */
    this.closed = null;
    this.until_ms = -Infinity;
  }

  /**
   * Hear whether the lever is held in a way now.
   * @param {Way} way
   * @param {boolean} held
   * @param {number} now_ms
   */
  hold(way, held, now_ms) {
    const since_ms = this.held.get(way);
    if (held && since_ms === undefined) {
      this.held.set(way, now_ms);
      this.tipAtOnce(way);
    } else if (!held && since_ms !== undefined) {
      this.held.delete(way);
      this.tipBehind(way, now_ms - since_ms);
    }
  }

  /** Let go without a tip: the device is gone, or the keys belong to something else. */
  release() {
    this.held.clear();
    this.tips.length = 0;
    this.closed = null;
  }

  /**
   * Return which contacts are closed; a closed one is returned at least once.
   * @param {number} now_ms
   * @returns {Record<Contact, boolean>}
   */
  contacts(now_ms) {
    this.noticeLong(now_ms);
    if (now_ms >= this.until_ms) {
      const pause = this.closed !== null;
      this.closed = pause ? null : (this.tips.shift() ?? null);
      this.until_ms = pause || this.closed !== null ? now_ms + TIP_MS : -Infinity;
    }
    const contacts = {
      resume: false,
      cancel: false,
      up: false,
      down: false,
      up_long: false,
      down_long: false,
    };
    if (this.closed !== null) {
      contacts[this.closed] = true;
    }
    return contacts;
  }

  /** @param {Way} way */
  tipAtOnce(way) {
    if (way === "resume" || way === "cancel") {
      this.tips.push(way);
      this.held.set(way, NaN);
    }
  }

  /**
   * @param {Way} way
   * @param {number} held_ms NaN: its tip is made
   */
  tipBehind(way, held_ms) {
    if ((way === "up" || way === "down") && held_ms >= 0) {
      this.tips.push(held_ms < LONG_MS ? way : `${way}_long`);
    }
  }

  /** @param {number} now_ms */
  noticeLong(now_ms) {
    for (const [way, since_ms] of this.held) {
      if (now_ms - since_ms >= LONG_MS) {
        this.tipBehind(way, now_ms - since_ms);
        this.held.set(way, NaN);
      }
    }
  }
}
