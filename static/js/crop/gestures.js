// Gestures of pointers on a photograph's frame. A mouse drags, and so does one finger where `on.kind` says what it
// drags: where it does not, the browser scrolls the page. Two fingers zoom, whatever one of them had begun.

import { distance, middle, placeOf } from "../lib/pinch.js";

/** @import { Place } from "../lib/pinch.js" */
/** @typedef {"pan" | "move" | "resize" | "draw"} Kind what a drag does */

const SLOP = { mouse: 4, touch: 16 }; // screen pixels that a press may slip and still be no drag
const LINE = 16; // screen pixels of a line that a wheel scrolls

/**
 * @template Start
 * @typedef {object} Drag
 * @property {Kind} kind
 * @property {string} edge of the box, where one is dragged
 * @property {number} id of the pointer
 * @property {Place} screen where it began
 * @property {number} slop
 * @property {boolean} under whether it is under way: it has left where it began
 * @property {Start} start what `begin` keeps of before
 */

/**
 * What is dragged and zoomed.
 *
 * @template Start, Grip
 * @typedef {object} Ground
 * @property {(event: PointerEvent, finger: boolean) => Kind | null} kind what a press drags
 * @property {(kind: Kind, at: Place) => Start} begin
 * @property {(drag: Drag<Start>, at: Place) => void} pull
 * @property {(drag: Drag<Start>) => void} end
 * @property {(drag: Drag<Start>) => void} cancel
 * @property {(at: Place) => Grip} grip what a zoom about a place on the screen begins with
 * @property {(grip: Grip, factor: number, at: Place) => void} zoom where that place is since, and how often it was enlarged
 * @property {() => void} settle the zoom is over
 */

/** @template Start, Grip */
export class Gestures {
  /**
   * @param {HTMLElement} frame
   * @param {Ground<Start, Grip>} on
   */
  constructor(frame, on) {
    this.frame = frame;
    this.on = on;
    this.pressed = false; // whether a drag begins or goes on
    /** @type {Drag<Start> | null} */
    this.drag = null;
    /** @type {{ grip: Grip, distance: number } | null} */
    this.pinch = null;
    /** @type {Map<number, Place>} */
    this.fingers = new Map();
    frame.addEventListener("pointerdown", (event) => this.press(event));
    frame.addEventListener("pointermove", (event) => this.move(event));
    frame.addEventListener("pointerup", (event) => this.lift(event, (drag) => on.end(drag)));
    frame.addEventListener("pointercancel", (event) => this.lift(event, (drag) => on.cancel(drag)));
    for (const kind of /** @type {const} */ (["touchstart", "touchmove"])) {
      frame.addEventListener(kind, (event) => this.keepFromScrolling(event), { passive: false });
    }
    frame.addEventListener("mousedown", (event) => {
      if (event.button === 1 && this.drag) event.preventDefault(); // scrolls by itself
    });
    frame.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  /** @param {TouchEvent} event */
  keepFromScrolling(event) {
    if (this.fingers.size > 1 && event.cancelable) event.preventDefault();
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    if (!event.ctrlKey && !event.metaKey) return; // the page's
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE : 1;
    const at = placeOf(event);
    this.on.zoom(this.on.grip(at), Math.exp(-event.deltaY * lines * 0.01), at); // so a trackpad's pinch comes, too
    this.on.settle();
  }

  /** Two of the fingers that are down, null where there are fewer. */
  get pair() {
    const [one, other] = this.fingers.values();
    return one && other ? { middle: middle(one, other), distance: distance(one, other) } : null;
  }

  /** @param {PointerEvent} event */
  press(event) {
    const finger = event.pointerType !== "mouse";
    const at = placeOf(event);
    if (finger) this.fingers.set(event.pointerId, at);
    const { pair } = this;
    if (pair) {
      this.cancel();
      this.pinch = { grip: this.on.grip(pair.middle), distance: pair.distance };
    }
    if (this.drag || this.pinch || event.button > 1) return;
    const kind = this.on.kind(event, finger);
    if (!kind) return;
    if (!finger) event.preventDefault();
    this.frame.setPointerCapture(event.pointerId);
    const edge = (event.target instanceof HTMLElement && event.target.dataset.edge) || "";
    const slop = finger ? SLOP.touch : SLOP.mouse;
    this.pressed = true; // before the drag begins, which moves the focus
    this.drag = { kind, edge, id: event.pointerId, screen: at, slop, under: false, start: this.on.begin(kind, at) };
  }

  /** @param {PointerEvent} event */
  move(event) {
    const at = placeOf(event);
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, at);
    const { drag, pair, pinch } = this;
    if (pinch) {
      if (pair) this.on.zoom(pinch.grip, pair.distance / pinch.distance, pair.middle);
    } else if (drag?.id === event.pointerId) {
      const [x, y] = drag.screen;
      drag.under ||= Math.max(Math.abs(at[0] - x), Math.abs(at[1] - y)) >= drag.slop;
      if (drag.under) this.on.pull(drag, at);
    }
  }

  /**
   * @param {PointerEvent} event
   * @param {(drag: Drag<Start>) => void} finish
   */
  lift(event, finish) {
    this.fingers.delete(event.pointerId);
    if (this.drag?.id === event.pointerId) {
      finish(this.drag);
      this.release();
    }
    if (!this.pinch || this.fingers.size) return;
    this.pinch = null;
    this.on.settle();
  }

  /** Take back the drag that is under way. */
  cancel() {
    if (this.drag) this.on.cancel(this.drag);
    this.release();
  }

  release() {
    this.pressed = false;
    this.drag = null;
  }
}
