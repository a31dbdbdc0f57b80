// Numbers as Python writes them, so that a file is the same to the byte whoever wrote it.

// Sizes that are written without an exponent.
const PLAIN_MIN = 1e-4;
const PLAIN_END = 1e16;

/**
 * Return the shortest text that reads back to the same bits, as Python's `repr` writes a float.
 * @param {number} value
 */
export function floatText(value) {
  if (!Number.isFinite(value)) {
    return Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf";
  }
  if (Object.is(value, -0)) {
    return "-0.0";
  }
  const size = Math.abs(value);
  if (size === 0 || (size >= PLAIN_MIN && size < PLAIN_END)) {
    const text = String(value);
    return text.includes(".") ? text : `${text}.0`;
  }
  const [digits, power] = value.toExponential().split("e");
  return `${digits}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}
