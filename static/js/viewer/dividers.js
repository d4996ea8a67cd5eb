// Dividers of the slider view: one between each two pictures, moved by pointer or keys.

import { append } from "../lib/dom.js";
import { move, share } from "./splits.js";

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1 };

export class Dividers {
  /**
   * @param {HTMLElement} stage
   * @param {string[]} titles of the pictures
   * @param {() => void} change hears that they have moved
   */
  constructor(stage, titles, change) {
    this.stage = stage;
    this.change = change;
    this.splits = share(titles.length);
    this.handles = this.splits.map((_, index) => this.offer(index, `${titles[index]} and ${titles[index + 1]}`));
    this.show();
  }

  /**
   * @param {number} index
   * @param {string} pair the titles on both sides
   */
  offer(index, pair) {
    const range = { "aria-orientation": "horizontal", "aria-valuemin": "0", "aria-valuemax": "100" };
    const role = { role: "slider", tabindex: "0", "aria-label": `Divider between ${pair}`, ...range };
    const handle = append("div", { class: "divider", ...role }, this.stage);
    handle.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      handle.focus();
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener("pointermove", (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const bounds = this.stage.getBoundingClientRect();
      this.move(index, (event.clientX - bounds.left) / bounds.width);
    });
    handle.addEventListener("keydown", (event) => {
      const to = this.aim(index, event.key);
      if (to === null) return;
      event.preventDefault();
      this.move(index, to);
    });
    return handle;
  }

  /**
   * Where a key sends a divider; null where it sends none.
   *
   * @param {number} index
   * @param {string} key
   */
  aim(index, key) {
    if (key === "Home") return 0;
    if (key === "End") return 1;
    const [from, step] = [this.splits[index], KEYS[key]];
    return from === undefined || step === undefined ? null : from + step;
  }

  /**
   * @param {number} index
   * @param {number} to part of the stage's width
   */
  move(index, to) {
    this.splits = move(this.splits, index, to);
    this.show();
    this.change();
  }

  show() {
    this.handles.forEach((handle, index) => {
      const percent = (this.splits[index] ?? 0) * 100;
      handle.style.left = `${percent}%`;
      handle.setAttribute("aria-valuenow", String(Math.round(percent)));
    });
  }

  remove() {
    for (const handle of this.handles) handle.remove();
  }
}
