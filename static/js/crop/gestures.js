// What pointers do on a photograph's frame. A mouse drags, and so does one finger where `on.kind` says what it drags: where
// it does not, the browser scrolls the page. Two fingers zoom, whatever one of them had begun.

const SLOP = { mouse: 4, touch: 16 }; // screen pixels that a press may slip and still be no drag

const place = (event) => [event.clientX, event.clientY];
const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
const apart = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;

/**
 * `on.kind(event, finger)` says what a press drags, or nothing; `on.begin`, `on.dragged`, `on.end` and `on.cancel` are told of the
 * drag. `on.grip(at)` gives what a zoom about a place on the screen begins with, `on.zoom(grip, factor, at)` is told where that
 * place is since, and how often it was enlarged; `on.settle()` is told of the end.
 */
export class Gestures {
  constructor(frame, on) {
    Object.assign(this, { frame, on, drag: null, grip: null });
    this.fingers = new Map();
    frame.addEventListener("pointerdown", (event) => this.press(event));
    frame.addEventListener("pointermove", (event) => this.move(event));
    frame.addEventListener("pointerup", (event) => this.lift(event, () => on.end(this.drag)));
    frame.addEventListener("pointercancel", (event) => this.lift(event, () => on.cancel(this.drag)));
    const keep = (event) => this.fingers.size > 1 && event.cancelable && event.preventDefault(); // else it scrolls
    for (const kind of ["touchstart", "touchmove"]) frame.addEventListener(kind, keep, { passive: false });
    frame.addEventListener("mousedown", (event) => event.button === 1 && this.drag && event.preventDefault()); // scrolls by itself
    frame.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return; // the page's
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      on.zoom(on.grip(place(event)), Math.exp(-event.deltaY * lines * 0.01), place(event)); // so a trackpad's pinch comes, too
      on.settle();
    }, { passive: false });
  }

  press(event) {
    const finger = event.pointerType !== "mouse";
    if (finger) this.fingers.set(event.pointerId, place(event));
    if (this.fingers.size > 1) {
      this.cancel();
      const points = [...this.fingers.values()];
      this.grip = { ...this.on.grip(middle(points)), apart: apart(points) };
    }
    if (this.drag || this.grip || event.button > 1) return;
    const kind = this.on.kind(event, finger);
    if (!kind) return;
    if (!finger) event.preventDefault();
    this.frame.setPointerCapture(event.pointerId);
    const slop = finger ? SLOP.touch : SLOP.mouse;
    this.drag = { kind, slop, id: event.pointerId, edge: event.target.dataset.edge, screen: place(event), under: false };
    this.on.begin(this.drag, event);
  }

  move(event) {
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, place(event));
    const points = [...this.fingers.values()];
    if (this.grip) {
      if (points.length > 1) this.on.zoom(this.grip, apart(points) / this.grip.apart, middle(points));
    } else if (event.pointerId === this.drag?.id) {
      const [dx, dy] = place(event).map((now, axis) => Math.abs(now - this.drag.screen[axis]));
      this.drag.under ||= Math.max(dx, dy) >= this.drag.slop;
      if (this.drag.under) this.on.dragged(this.drag, place(event));
    }
  }

  lift(event, finish) {
    this.fingers.delete(event.pointerId);
    if (event.pointerId === this.drag?.id) {
      finish();
      this.drag = null;
    }
    if (!this.grip || this.fingers.size) return;
    this.grip = null;
    this.on.settle();
  }

  /** Take back the drag that is under way. */
  cancel() {
    if (this.drag) this.on.cancel(this.drag);
    this.drag = null;
  }
}
