// Elements without markup in texts: what people wrote is always text, never HTML.

/**
 * Return a new element.
 * @param {string} name of the tag
 * @param {Record<string, unknown>} [attributes] `on...`: a listener; `class`, `data-...`, `aria-...`:
 *   attributes; false, null or undefined: left out; true: without value
 * @param {...(Node | string | number | null | undefined | false)} children what is no node becomes text
 * @returns {HTMLElement}
 */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") {
      made.addEventListener(key.slice(2), /** @type {EventListener} */ (value));
    } else if (value !== false && value !== null && value !== undefined) {
      made.setAttribute(key, value === true ? "" : String(value));
    }
  }
  made.append(...content(children));
  return made;
}

/**
 * Put `children` in place of what an element holds.
 * @param {Element} parent
 * @param {...(Node | string | number | null | undefined | false)} children
 */
export function fill(parent, ...children) {
  parent.replaceChildren(...content(children));
}

/** @param {(Node | string | number | null | undefined | false)[]} children */
function content(children) {
  return children
    .filter((child) => child !== null && child !== undefined && child !== false)
    .map((child) => (child instanceof Node ? child : String(child)));
}
