// Copy buttons beside texts.

import { start } from "./start.js";

/** Copy a text; raises where the browser does not let a script do so. */
async function copy(source) {
  if (navigator.clipboard) {
    await navigator.clipboard.writeText(source.textContent);
    return;
  }
  // Browsers give pages no clipboard over plain http from another machine: the selection is what remains.
  getSelection().selectAllChildren(source);
  if (!document.execCommand("copy")) throw new Error("no clipboard");
}

export function offerCopies(root) {
  for (const button of root.querySelectorAll("[data-copy]")) {
    button.hidden = false;
    button.setAttribute("aria-live", "polite");
    button.addEventListener("click", () => start(() => press(button)));
  }
}

async function press(button) {
  const source = document.getElementById(button.dataset.copy);
  try {
    await copy(source);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(source);
    button.textContent = "Press Ctrl+C";
  }
  button.addEventListener("blur", () => (button.textContent = "Copy"), { once: true });
}
