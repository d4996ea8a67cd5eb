// Undo and redo of a crop: every change that is done with can be taken back, and made again.

import { same } from "./rectangle.js";

/** @import { Rectangle } from "./rectangle.js" */

const DEPTH = 100;

export class History {
  /** @param {Rectangle} crop */
  constructor(crop) {
    this.now = crop;
    /** @type {Rectangle[]} */
    this.past = [];
    /** @type {Rectangle[]} */
    this.future = [];
  }

  /**
   * Keep a change; one that goes on, such as that of a key held down, is part of the change before.
   *
   * @param {Rectangle} crop
   * @param {boolean} goesOn
   */
  keep(crop, goesOn = false) {
    if (same(crop, this.now)) return;
    if (!goesOn) this.past = [...this.past, this.now].slice(-DEPTH);
    this.future = [];
    this.now = crop;
  }

  undo() {
    const before = this.past.pop();
    if (!before) return;
    this.future.push(this.now);
    this.now = before;
  }

  redo() {
    const after = this.future.pop();
    if (!after) return;
    this.past.push(this.now);
    this.now = after;
  }
}
