// Prepared roads for tests, written as docs/native.md says.
import { crc32 } from "../../../fmu_src/pldf/cockpit/page/engine/crc32.js";
import { roadFromPrepared, roadOf } from "../../../fmu_src/pldf/cockpit/page/engine/road.js";

/** @typedef {import("../../../fmu_src/pldf/cockpit/page/types.js").Road} Road */
/** @typedef {(s_m: number) => number} Along */

/**
 * @param {number} length_m
 * @param {{limit_mps?: Along, curvature_per_m?: Along, grade?: Along, x_m?: Along, y_m?: Along, marks?: string[]}} made
 * @returns {Uint8Array} with a line if it has `x_m`
 */
export function preparedRoad(length_m, made = {}) {
  const { limit_mps = () => 25, curvature_per_m = () => 0, grade = () => 0 } = made;
  const { x_m, y_m = () => 0, marks = [] } = made;
  const columns = [limit_mps, curvature_per_m, grade, x_m ?? (() => 0), y_m];
  const lines = [
    `PLDF-PREPARED ${marks.length ? 2 : 1}`,
    "kind route",
    "key 0123456789abcdef",
    "columns 5",
    `rows ${length_m + 1}`,
    `line ${x_m ? 1 : 0}`,
    ...(marks.length ? [`marks ${marks.length}`, ...marks] : []),
    "end",
  ];
  const head = lines.join("\n");
  const size = Math.ceil((new TextEncoder().encode(head).length + 1) / 64) * 64;
  const padded = head + " ".repeat(size - new TextEncoder().encode(head).length - 1) + "\n";
  const numbers = new DataView(new ArrayBuffer(columns.length * (length_m + 1) * 8));
  columns.forEach((along, column) => {
    for (let s_m = 0; s_m <= length_m; s_m++) {
      numbers.setFloat64((column * (length_m + 1) + s_m) * 8, along(s_m), true);
    }
  });
  return summed([...new TextEncoder().encode(padded), ...new Uint8Array(numbers.buffer)]);
}

/** @param {number[]} body @returns {Uint8Array} with its check sum */
export function summed(body) {
  const sum = crc32(new Uint8Array(body)).toString(16).padStart(8, "0");
  return new Uint8Array([...body, ...new TextEncoder().encode(`crc32 ${sum}\n`)]);
}

/**
 * @param {number} length_m @param {Parameters<typeof preparedRoad>[1]} made
 * @param {Partial<Road>} about
 */
export function roadModel(length_m, made = {}, about = {}) {
  return roadOf({ ...roadFromPrepared(preparedRoad(length_m, made), "Test road"), ...about });
}
