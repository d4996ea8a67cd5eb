// The steps of a crop's editor: every change that is done with can be taken back, and made again.

import { same } from "./rectangle.js";

const DEPTH = 100;

export class Steps {
  /** Begin anew: before this crop there is nothing to take back. */
  start(crop) {
    Object.assign(this, { now: crop, past: [], future: [] });
  }

  /** Keep a change; one that goes on, such as that of a key held down, is part of the change before. */
  keep(crop, goesOn = false) {
    if (same(crop, this.now)) return;
    if (!goesOn) this.past = [...this.past, this.now].slice(-DEPTH);
    this.future = [];
    this.now = crop;
  }

  undo() {
    if (!this.past.length) return;
    this.future.push(this.now);
    this.now = this.past.pop();
  }

  redo() {
    if (!this.future.length) return;
    this.past.push(this.now);
    this.now = this.future.pop();
  }
}
