// Copy buttons beside texts.

import { findAll } from "./dom.js";
import { start } from "./start.js";

/** @param {Element} source */
const select = (source) => getSelection()?.selectAllChildren(source);

/**
 * Copy a text; raises where the browser does not let a script do so.
 *
 * @param {Element} source
 */
async function copy(source) {
  if (navigator.clipboard) {
    await navigator.clipboard.writeText(source.textContent);
    return;
  }
  // Browsers give pages no clipboard over plain http from another machine: the selection is what remains.
  select(source);
  if (!document.execCommand("copy")) throw new Error("no clipboard");
}

/** @param {ParentNode} root */
export function offerCopies(root) {
  for (const button of findAll(root, "[data-copy]")) {
    button.hidden = false;
    button.setAttribute("aria-live", "polite");
    button.addEventListener("click", () => start(() => press(button)));
  }
}

/** @param {HTMLElement} button */
async function press(button) {
  const source = document.getElementById(button.dataset.copy ?? "");
  if (!source) throw new TypeError(`nothing to copy: ${button.dataset.copy}`);
  try {
    await copy(source);
    button.textContent = "Copied";
  } catch {
    select(source);
    button.textContent = "Press Ctrl+C";
  }
  button.addEventListener("blur", () => (button.textContent = "Copy"), { once: true });
}
