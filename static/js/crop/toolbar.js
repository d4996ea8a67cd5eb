// The toolbar of a crop: buttons that set, undo and zoom it, and what it is in words.

import { find } from "../lib/dom.js";

/** @typedef {"in" | "out" | "fit"} ZoomTool */
/** @typedef {"draw" | "undo" | "redo" | ZoomTool} Tool */

export class Toolbar {
  /**
   * @param {HTMLElement} root of the input
   * @param {{ all: () => void, suggested: () => void, tool: (name: Tool) => void }} on
   */
  constructor(root, on) {
    this.element = find(root, "[id$=crop-tools]");
    this.readout = find(root, "[id$=crop-size]");
    this.all = find(this.element, "[data-crop=all]");
    this.suggested = find(this.element, "[data-suggested]");
    this.element.hidden = false;
    this.element.addEventListener("click", ({ target }) => {
      const button = target instanceof Element ? target.closest("button") : null;
      if (!button || button.getAttribute("aria-disabled") === "true") return;
      if (button === this.all) on.all();
      else if (button === this.suggested) on.suggested();
      else on.tool(/** @type {Tool} */ (button.dataset.tool));
    });
  }

  /** @param {Tool} name */
  button(name) {
    return find(this.element, `[data-tool=${name}]`);
  }

  /**
   * @param {Record<Exclude<Tool, "draw">, boolean>} off tools that would change nothing; they keep the focus
   * @param {boolean} drawing
   * @param {string} words
   */
  show(off, drawing, words) {
    for (const [name, none] of Object.entries(off)) {
      this.button(/** @type {Tool} */ (name)).setAttribute("aria-disabled", String(none));
    }
    this.button("draw").setAttribute("aria-pressed", String(drawing));
    this.readout.textContent = words;
  }
}
