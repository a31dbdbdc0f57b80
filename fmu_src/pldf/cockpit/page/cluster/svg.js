// Drawings, built as elements as the page's other content is (dom.js).

const SPACE = "http://www.w3.org/2000/svg";

/**
 * Return a new SVG element.
 * @param {string} name of the tag
 * @param {Record<string, string | number>} [attributes]
 * @param {...(Node | string)} children
 * @returns {SVGElement}
 */
export function svg(name, attributes = {}, ...children) {
  const made = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.append(...children);
  return /** @type {SVGElement} */ (made);
}

/**
 * Set attributes that differ from what stands there: a drawing that stays the same costs nothing.
 * @param {Element} element
 * @param {Record<string, string | number>} attributes
 */
export function update(element, attributes) {
  for (const [key, value] of Object.entries(attributes)) {
    if (element.getAttribute(key) !== String(value)) element.setAttribute(key, String(value));
  }
}

/**
 * Set a text if it is another one: a screen reader is not told what stays the same.
 * @param {Element} element
 * @param {string} text
 */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
