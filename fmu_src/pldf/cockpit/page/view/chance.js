// Chance that is the same on every visit: what grows at a place depends on the place alone.

/** @param {...number} keys whole numbers @returns {number} 0..1 */
export function chance(...keys) {
  let hash = 0x9e3779b9;
  for (const key of keys) {
    hash = Math.imul(hash ^ (key | 0), 0x85ebca6b);
    hash = Math.imul(hash ^ (hash >>> 13), 0xc2b2ae35);
    hash ^= hash >>> 16;
  }
  return (hash >>> 0) / 2 ** 32;
}

/** @param {number} low @param {number} high @param {number} share 0..1 */
export function between(low, high, share) {
  return low + (high - low) * share;
}

/**
 * 0 below `low`, 1 above `high`, smooth between.
 * @param {number} low
 * @param {number} high
 * @param {number} value
 */
export function rising(low, high, value) {
  const t = Math.min(Math.max((value - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}

/** Smooth hills of about one size. @param {number} x @param {number} y @returns {number} -1..1 */
export function hills(x, y, seed = 0) {
  const [i, j] = [Math.floor(x), Math.floor(y)];
  const [u, v] = [rising(0, 1, x - i), rising(0, 1, y - j)];
  const corner = (/** @type {number} */ a, /** @type {number} */ b) => chance(i + a, j + b, seed);
  const low = between(corner(0, 0), corner(1, 0), u);
  const high = between(corner(0, 1), corner(1, 1), u);
  return 2 * between(low, high, v) - 1;
}
