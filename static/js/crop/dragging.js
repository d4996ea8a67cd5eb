// Dragging of a crop: what a press on the photograph's frame drags, and what the drag does to the crop and to the view.

import { move, resize, same, span } from "./rectangle.js";

/** @import { Place } from "../lib/pinch.js" */
/** @import { Crop } from "./crop.js" */
/** @import { Drag, Ground, Kind } from "./gestures.js" */
/** @import { Point, Rectangle } from "./rectangle.js" */

/** @typedef {{ from: Point, before: Rectangle, drawn: boolean }} Start what a drag keeps of before it */
/** @typedef {Point & { times: number }} Grip what a zoom keeps of before it */

/** @implements {Ground<Start, Grip>} */
export class Dragging {
  /** @param {Crop} crop */
  constructor(crop) {
    this.crop = crop;
  }

  /**
   * What a press drags, if anything: a finger that neither moves the crop nor the view scrolls the page.
   *
   * @param {PointerEvent} event
   * @param {boolean} finger
   * @returns {Kind | null}
   */
  kind({ button, target }, finger) {
    const { box, drawing, everything, shown, view } = this.crop;
    const onBox = target === box.element;
    const pan = view.zoom.zoomed ? "pan" : null;
    if (button === 1) return pan;
    if (drawing) return "draw";
    if (target instanceof HTMLElement && target.dataset.edge) return "resize";
    if (finger) return onBox && !box.fills ? "move" : pan;
    return onBox && !same(shown, everything) ? "move" : "draw"; // what cannot be moved is drawn anew
  }

  /**
   * @param {Kind} kind
   * @param {Place} at
   * @returns {Start}
   */
  begin(kind, at) {
    const { box, shown, view } = this.crop;
    if (kind !== "pan") box.element.focus({ preventScroll: true }); // and a number field is left
    return { from: view.pointAt(at), before: shown, drawn: false };
  }

  /**
   * @param {Drag<Start>} drag
   * @param {Place} at
   */
  pull({ kind, edge, slop, start }, at) {
    const { crop } = this;
    const { size, zoom } = crop.view;
    const { from, before } = start;
    const to = crop.view.pointAt(at);
    const [dx, dy] = [to.x - from.x, to.y - from.y];
    if (kind === "pan") {
      crop.view.bring(from, at);
      crop.draw();
    } else if (kind === "move") crop.put(move(before, dx, dy, size));
    else if (kind === "resize") crop.put(resize(before, edge, dx, dy, size));
    else {
      const drawn = span(from, to, size);
      start.drawn = Math.min(drawn.width, drawn.height) * zoom.scale >= slop; // a line is a slip
      crop.put(start.drawn ? drawn : before);
    }
  }

  /** @param {Drag<Start>} drag */
  end({ under, start }) {
    if (start.drawn) this.crop.drawing = false;
    if (under) this.crop.write(this.crop.shown);
  }

  /** @param {Drag<Start>} drag */
  cancel({ under, start }) {
    if (under) this.crop.put(start.before);
  }

  /**
   * @param {Place} at
   * @returns {Grip}
   */
  grip(at) {
    const { view } = this.crop;
    return { ...view.pointAt(at), times: view.zoom.times };
  }

  /**
   * @param {Grip} grip
   * @param {number} factor
   * @param {Place} at
   */
  zoom(grip, factor, at) {
    this.crop.view.bring(grip, at, grip.times * factor);
    this.crop.draw();
  }

  settle() {
    this.crop.settle();
  }
}
