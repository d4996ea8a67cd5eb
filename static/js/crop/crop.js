// The crop on a photograph or a clip: the box shows what the four number fields say, and dragging writes to them. Every
// change is told to the form as a "crop" event, and can be taken back.

import { find, findAll } from "../lib/dom.js";
import { observe } from "../lib/lifetime.js";
import { NumberGroup } from "../lib/number_group.js";
import { Box } from "./box.js";
import { Dragging } from "./dragging.js";
import { Gestures } from "./gestures.js";
import { History } from "./history.js";
import { SIDES, explain, fit, move, parse, resize, same } from "./rectangle.js";
import { Toolbar } from "./toolbar.js";
import { View } from "./view.js";

/** @import { Rectangle, Side } from "./rectangle.js" */
/** @import { Tool, ZoomTool } from "./toolbar.js" */
/** @import { Picture } from "./view.js" */

/** @type {Record<string, [dx: number, dy: number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
/** @type {Record<string, ZoomTool>} */
const ZOOMS = { "+": "in", "=": "in", "-": "out", 0: "fit" };

/** The editor of one input's crop. */
export class Crop {
  drawing = false; // whether the next drag draws, wherever it begins

  /**
   * @param {HTMLElement} root holds the photograph's frame and the fields
   * @param {AbortSignal} signal
   */
  constructor(root, signal) {
    this.form = /** @type {HTMLElement} */ (root.closest("form"));
    this.view = new View(find(root, ".frame"));
    this.box = new Box(this.view.frame, find(root, "legend"));
    this.tools = new Toolbar(root, {
      all: () => this.change(this.everything),
      suggested: () => this.change(this.suggested),
      tool: (name) => this.use(name),
    });
    const field = (/** @type {Side} */ side) => find(root, `[data-side=${side}]`, HTMLInputElement);
    const fields = { x: field("x"), y: field("y"), width: field("width"), height: field("height") };
    /** @type {NumberGroup<Side>} */
    this.fields = new NumberGroup(fields, find(root, "[data-fit=crop]"), {
      read: () => this.fields.read((side) => this.history.now[side]),
      fit: (crop) => fit(crop, this.view.size),
      explain,
      preview: (crop) => this.preview(crop ?? this.history.now),
      keep: (crop) => this.change(crop),
    });
    this.gestures = new Gestures(this.view.frame, new Dragging(this));
    for (const hint of findAll(root, ".gestures")) hint.hidden = false;
    this.boundFields();
    this.shown = fit(this.read() ?? this.suggested, this.view.size);
    this.history = new History(this.shown);
    this.follow();
    this.listen(signal);
  }

  /** Tell the fields how large their numbers may be. */
  boundFields() {
    const { width, height } = this.view.size;
    if (!width) return;
    const most = { x: width - 1, y: height - 1, width, height };
    for (const side of SIDES) this.fields.fields[side].dataset.max = String(most[side]);
  }

  get everything() {
    return { x: 0, y: 0, ...this.view.size };
  }

  /** @returns {Rectangle} */
  get suggested() {
    return parse(this.tools.suggested.dataset.crop ?? "") ?? this.everything;
  }

  /**
   * Show another photograph or clip.
   *
   * @param {Picture} picture
   * @param {string} suggested the crop to start from
   */
  show(picture, suggested) {
    this.view.show(picture);
    this.tools.all.textContent = picture.video ? "Whole frame" : "Whole photograph";
    this.tools.suggested.dataset.crop = suggested;
    this.boundFields();
    this.shown = this.suggested;
    this.history = new History(this.shown);
    this.layOut();
    this.put(this.shown);
  }

  read() {
    return this.fields.read();
  }

  /** Take what the fields say; those left empty take the crop to start from. */
  follow() {
    const { empty } = this.fields;
    const crop = fit(this.read() ?? this.shown, this.view.size);
    if (!same(crop, this.shown)) this.history = new History(crop);
    this.shown = crop;
    if (empty && this.view.size.width) this.fields.write(crop);
    this.draw(); // also says what it is where nothing is on the screen yet
    this.layOut();
  }

  layOut() {
    if (this.view.layOut()) this.draw();
  }

  draw() {
    const { drawing, history, shown, view } = this;
    const { size, zoom } = view;
    if (size.width) view.frame.dataset.crop = SIDES.map((side) => shown[side]).join(",");
    if (!zoom.base) return; // not laid out yet
    view.draw();
    view.frame.classList.toggle("drawing", drawing);
    this.box.draw(shown, zoom, size.width * zoom.base, size.height * zoom.base);
    const [undo, redo] = [!history.past.length, !history.future.length];
    const percent = Math.round(zoom.scale * 100);
    this.tools.show(
      { undo, redo, in: zoom.largest, out: !zoom.zoomed, fit: !zoom.zoomed },
      drawing,
      drawing
        ? "Drag from one corner of the new crop to the other."
        : `${shown.width} × ${shown.height} of ${size.width} × ${size.height} at ${percent} %`,
    );
  }

  /**
   * Show a crop that may still change.
   *
   * @param {Rectangle} crop
   */
  put(crop) {
    this.fields.write(crop);
    this.preview(crop);
  }

  /**
   * Show what the fields say.
   *
   * @param {Rectangle} crop
   */
  preview(crop) {
    this.shown = crop;
    this.draw();
    this.form.dispatchEvent(new CustomEvent("crop"));
  }

  /**
   * Set the crop; a change that goes on is one with the change before.
   *
   * @param {Rectangle} crop
   */
  write(crop, goesOn = false) {
    this.history.keep(crop, goesOn);
    this.put(crop);
  }

  /**
   * Set the crop other than by a pointer, and bring it into view.
   *
   * @param {Rectangle} crop
   */
  change(crop, goesOn = false) {
    this.view.zoom.reveal(crop);
    this.write(crop, goesOn);
  }

  /** @param {"undo" | "redo"} way */
  step(way) {
    this.gestures.cancel();
    const written = this.read();
    // What is half typed, or no number, goes first.
    if (way === "redo" || (written && same(written, this.history.now))) this.history[way]();
    this.change(this.history.now);
  }

  /** @param {AbortSignal} signal */
  listen(signal) {
    const { box, tools, view } = this;
    box.element.addEventListener("keydown", (event) => this.key(event));
    box.element.addEventListener("focus", () => {
      if (!view.zoom.zoomed || this.gestures.pressed) return;
      view.zoom.reveal(this.shown);
      this.draw();
    });
    for (const part of [view.frame, tools.element]) part.addEventListener("keydown", (event) => this.command(event));
    // Browsers put back what was in the fields when one returns to the page; the box follows.
    const comeBack = () => {
      this.follow();
      this.form.dispatchEvent(new CustomEvent("crop"));
    };
    window.addEventListener("pageshow", comeBack, { signal });
    window.addEventListener("resize", () => this.layOut(), { signal });
    observe(new ResizeObserver(() => this.layOut()), view.ground, signal);
  }

  /** @param {Tool} tool */
  use(tool) {
    if (tool === "draw") this.arm(!this.drawing);
    else if (tool === "undo" || tool === "redo") this.step(tool);
    else this.enlarge(tool);
  }

  /**
   * Let the next drag draw a crop, or not.
   *
   * @param {boolean} on
   */
  arm(on) {
    this.drawing = on;
    this.draw();
  }

  /**
   * Zoom by a step about the middle of the crop, or of what is seen where the crop is not.
   *
   * @param {ZoomTool} way
   */
  enlarge(way) {
    const { zoom } = this.view;
    const { x, y, width, height } = this.shown;
    if (way === "fit") zoom.whole();
    else zoom.about(way === "in" ? Math.SQRT2 : Math.SQRT1_2, { x: x + width / 2, y: y + height / 2 });
    if (way === "in") zoom.reveal(this.shown);
    this.settle();
  }

  settle() {
    this.view.settle();
    this.draw();
  }

  /**
   * Keys of the whole editor, but not of its number fields, which take back what was typed by themselves.
   *
   * @param {KeyboardEvent} event
   */
  command(event) {
    if (event.key === "Escape") {
      this.gestures.cancel();
      this.arm(false);
    }
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const letter = event.key.toLowerCase();
    if (letter !== "z" && letter !== "y") return;
    event.preventDefault();
    this.step(letter === "y" || event.shiftKey ? "redo" : "undo");
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const { key, ctrlKey, shiftKey, repeat } = event;
    const [arrow, zoom] = [ARROWS[key], ZOOMS[key]];
    if (event.altKey || event.metaKey) return;
    if (zoom && !ctrlKey) this.enlarge(zoom);
    else if (arrow) {
      const [dx, dy] = ctrlKey ? [10 * arrow[0], 10 * arrow[1]] : arrow;
      const { size } = this.view;
      this.change(shiftKey ? resize(this.shown, "se", dx, dy, size) : move(this.shown, dx, dy, size), repeat);
    } else return;
    event.preventDefault();
  }
}
