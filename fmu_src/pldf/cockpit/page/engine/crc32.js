// The check sum of prepared roads and profile files.

/** @type {Uint32Array | null} */
let table = null;

/**
 * @param {Uint8Array} bytes
 * @returns {number} CRC-32 as zlib has it
 */
export function crc32(bytes) {
  table ??= remainders();
  let crc = 0xffffffff;
  for (const byte of bytes) crc = (crc >>> 8) ^ table[(crc ^ byte) & 0xff];
  return (crc ^ 0xffffffff) >>> 0;
}

function remainders() {
  const made = new Uint32Array(256);
  for (let byte = 0; byte < 256; byte++) {
    let rest = byte;
    for (let bit = 0; bit < 8; bit++) rest = rest & 1 ? (rest >>> 1) ^ 0xedb88320 : rest >>> 1;
    made[byte] = rest;
  }
  return made;
}
