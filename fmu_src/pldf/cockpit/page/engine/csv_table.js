// A table as people and programs write it: comma, semicolon or tab, decimal point or comma.

/** @typedef {{names: string[], rows: string[][], lines: number[], comments: string[]}} Table lines: of the rows */

const SEPARATORS = [",", ";", "\t"];

/**
 * Return the text of a file: UTF-8, UTF-16, or what is neither as Windows-1252.
 * @param {Uint8Array} bytes
 */
export function textOf(bytes) {
  const [first, second] = bytes;
  if ((first === 0xff && second === 0xfe) || (first === 0xfe && second === 0xff)) {
    return new TextDecoder(first === 0xff ? "utf-16le" : "utf-16be").decode(bytes);
  }
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/**
 * Return the cells of a table; lines that begin with # are comments, empty ones are passed over.
 * @param {string} text
 * @returns {Table}
 */
export function readTable(text) {
  const separator = separatorOf(text);
  /** @type {Table} */
  const table = { names: [], rows: [], lines: [], comments: [] };
  const lines = text.includes('"') ? quotedCells(text, separator) : plainCells(text, separator);
  for (const { line, cells } of lines) {
    if (cells[0].startsWith("#")) {
      table.comments.push(cells.join(separator).slice(1).trim());
    } else if (table.names.length === 0) {
      table.names = cells.map((cell) => cell.trim());
    } else {
      table.rows.push(cells);
      table.lines.push(line);
    }
  }
  return table;
}

/**
 * Return the number that a cell says, with a point or a comma; NaN if it says none.
 * @param {string} cell
 */
export function numberOf(cell) {
  const plain = cell.includes(",") ? cell.replace(",", ".") : cell;
  return plain.trim() === "" ? NaN : Number(plain);
}

/** @param {string} text */
function separatorOf(text) {
  const header =
    text.split(/\r\n|\r|\n/).find((line) => line.trim() !== "" && line[0] !== "#") ?? "";
  /** @param {string} separator */
  const count = (separator) => header.split(separator).length;
  return SEPARATORS.reduce((best, other) => (count(other) > count(best) ? other : best));
}

/**
 * Yield the cells of each line that is not empty, of a text without quotes.
 * @param {string} text
 * @param {string} separator
 * @returns {Generator<{line: number, cells: string[]}>}
 */
function* plainCells(text, separator) {
  let line = 0;
  for (const whole of text.split(/\r\n|\r|\n/)) {
    line += 1;
    if (whole.trim() !== "") {
      yield { line, cells: whole.split(separator) };
    }
  }
}

/**
 * Yield the cells of each line that is not empty; a quoted cell may hold separators and line breaks.
 * @param {string} text
 * @param {string} separator
 * @returns {Generator<{line: number, cells: string[]}>}
 */
function* quotedCells(text, separator) {
  const plain = `(?!")[^${separator}\\r\\n]*`;
  const end = `${separator}|\\r\\n|\\r|\\n|$`;
  const form = new RegExp(`(?:"((?:[^"]|"")*)"|(${plain}))(${end})`, "gy");
  let line = 1;
  let next = 1;
  /** @type {string[]} */
  let cells = [];
  for (let at = 0; at < text.length; at = form.lastIndex) {
    const found = form.exec(text);
    if (found === null) {
      throw new RangeError(`line ${next}: a quote that does not end`);
    }
    const [whole, quoted, bare, behind] = found;
    cells.push(quoted === undefined ? bare : quoted.replaceAll('""', '"'));
    next += whole.split(/\r\n|\r|\n/).length - 1;
    if (behind !== separator) {
      if (cells.length > 1 || cells[0].trim() !== "") {
        yield { line, cells };
      }
      cells = [];
      line = next;
    }
    if (form.lastIndex === at) {
      return;
    }
  }
  if (cells.length > 0) {
    yield { line, cells };
  }
}
