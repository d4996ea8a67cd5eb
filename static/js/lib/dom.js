// Elements of a page, found by a selector or made, with the kind that they are of. What a script cannot do without is
// looked up by `find`: where a template has lost it, the error names the selector instead of a property of null.

/**
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @returns {HTMLElement | null}
 */
/**
 * @template {Element} E
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => E} kind
 * @returns {E | null}
 */
/**
 * The first element that a selector finds, null where it finds none or one of another kind.
 *
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => Element} kind
 */
export function seek(root, selector, kind = HTMLElement) {
  const found = root.querySelector(selector);
  return found instanceof kind ? found : null;
}

/**
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @returns {HTMLElement}
 */
/**
 * @template {Element} E
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => E} kind
 * @returns {E}
 */
/**
 * The first element that a selector finds; an error where it finds none, or one of another kind.
 *
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => Element} kind
 */
export function find(root, selector, kind = HTMLElement) {
  const found = root.querySelector(selector);
  if (!(found instanceof kind)) throw new TypeError(`the page has no ${kind.name} ${selector}`);
  return found;
}

/**
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @returns {HTMLElement[]}
 */
/**
 * @template {Element} E
 * @overload
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => E} kind
 * @returns {E[]}
 */
/**
 * All elements of a kind that a selector finds.
 *
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => Element} kind
 */
export function findAll(root, selector, kind = HTMLElement) {
  return [...root.querySelectorAll(selector)].filter((each) => each instanceof kind);
}

/**
 * Make an element with attributes, and put it at the end of another one.
 *
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Record<string, string>} attributes
 * @param {ParentNode} parent
 */
export function append(name, attributes, parent) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

/**
 * The element that an event is about; null where that is none, such as the document.
 *
 * @param {Event} event
 */
export const targetOf = ({ target }) => (target instanceof HTMLElement ? target : null);
