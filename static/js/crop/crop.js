// The crop on a photograph or a clip: the box shows what the four number fields say, and dragging writes to them. Every change
// is told to the form as a "crop" event, and can be taken back.

import { Box } from "./box.js";
import { Gestures } from "./gestures.js";
import { Steps } from "./history.js";
import { Zoom } from "./zoom.js";
import { NumberGroup } from "../lib/number_group.js";
import { fitted, moved, resized, same, spanned } from "./rectangle.js";

export const SIDES = ["x", "y", "width", "height"];
const LARGEST = 3; // times that a small photograph is enlarged on the screen
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const ZOOMS = { "+": "in", "=": "in", "-": "out", 0: "fit" };
const WHOLE_AGAIN = 1.02; // an enlargement that is none

/** Say what had to give way to the side that was typed. */
function gaveWay(side, wanted, crop) {
  const long = { x: "width", y: "height" }[side] ?? side;
  const start = long === "width" ? "x" : "y";
  if (crop[long] !== wanted[long]) return `The ${long} is ${crop[long]} now: there is no more.`;
  return `${start} is ${crop[start]} now: from ${wanted[start]} on, a ${long} of ${wanted[long]} does not fit.`;
}

/** The editor of one input's crop; `root` holds the photograph's frame and the fields. */
export class Crop {
  constructor(root) {
    this.form = root.closest("form");
    this.frame = root.querySelector(".frame");
    this.ground = this.frame.parentElement;
    this.tools = root.querySelector("[id$=crop-tools]");
    this.readout = root.querySelector("[id$=crop-size]");
    this.box = new Box(this.frame, root.querySelector("legend"));
    this.zoom = new Zoom();
    this.steps = new Steps();
    this.drawing = false; // whether the next drag draws, wherever it begins
    const fields = SIDES.map((side) => [side, root.querySelector(`[data-side=${side}]`)]);
    this.fields = new NumberGroup(Object.fromEntries(fields), root.querySelector("[data-fit=crop]"), {
      read: () => this.fields.read((side) => this.steps.now[side]),
      fitted: (crop) => fitted(crop, this.size),
      words: gaveWay,
      typed: (crop) => this.preview(crop ?? this.steps.now),
      left: (crop) => this.change(crop),
    });
    this.gestures = new Gestures(this.frame, {
      kind: (event, finger) => this.kind(event, finger),
      begin: (drag) => this.begin(drag),
      dragged: (drag, at) => this.pull(drag, at),
      end: (drag) => this.end(drag),
      cancel: (drag) => drag.under && this.put(drag.before),
      grip: (at) => ({ ...this.at(at), times: this.zoom.times }),
      zoom: (grip, factor, at) => this.look(grip, at, grip.times * factor),
      settle: () => this.settle(),
    });
    this.tools.hidden = false;
    for (const hint of root.querySelectorAll(".gestures")) hint.hidden = false;
    this.listen();
    this.readSize();
    this.follow();
    new ResizeObserver(() => this.layOut()).observe(this.ground);
    window.addEventListener("resize", () => this.layOut());
  }

  readSize() {
    this.size = { width: Number(this.frame.dataset.width), height: Number(this.frame.dataset.height) };
    const { width, height } = this.size;
    if (!width) return;
    const most = { x: width - 1, y: height - 1, width, height };
    for (const side of SIDES) this.fields.fields[side].dataset.max = most[side];
  }

  get suggested() {
    const wanted = this.tools.querySelector("[data-suggested]").dataset.crop.split(",").map(Number);
    const [x, y, width, height] = wanted.length === 4 ? wanted : [0, 0, this.size.width, this.size.height];
    return { x, y, width, height };
  }

  /** Show another photograph, or a clip if it has an address as such, with the crop to start from. */
  show({ address, video, title, width, height, crop }) {
    this.frame.querySelector("img, video")?.remove();
    const shown = document.createElement(video ? "video" : "img");
    if (video) Object.assign(shown, { src: video, poster: address, loop: true, muted: true, playsInline: true, ariaLabel: title });
    else Object.assign(shown, { src: address, alt: title });
    Object.assign(shown, { width, height });
    this.frame.prepend(shown);
    Object.assign(this.frame.dataset, { width, height });
    this.tools.querySelector("[data-crop=all]").textContent = video ? "Whole frame" : "Whole photograph";
    this.tools.querySelector("[data-suggested]").dataset.crop = crop;
    this.readSize();
    this.zoom.whole();
    this.steps.start(this.suggested);
    this.shown = this.suggested;
    this.layOut();
    this.put(this.shown);
  }

  read() {
    return this.fields.read();
  }

  /** Take what the fields say; those left empty take the crop to start from. */
  follow() {
    const { empty } = this.fields;
    const crop = fitted(this.read() ?? this.shown ?? this.suggested, this.size);
    if (!this.shown || !same(crop, this.shown)) this.steps.start(crop);
    this.shown = crop;
    if (empty && this.size.width) this.fields.write(crop);
    this.draw(); // also says what it is where nothing is on the screen yet
    this.layOut();
  }

  layOut() {
    const style = getComputedStyle(this.ground);
    const room = this.ground.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    if (room <= 0 || !this.size.width) return; // not on the screen
    const narrow = window.matchMedia("(max-width: 960px)").matches;
    const tall = Math.max(240, narrow ? window.innerHeight * 0.6 : window.innerHeight - 360);
    const scale = Math.min(room / this.size.width, tall / this.size.height, LARGEST);
    this.frame.style.width = `${this.size.width * scale}px`;
    this.frame.style.height = `${this.size.height * scale}px`;
    this.frame.classList.add("ready");
    this.zoom.layOut(this.size, scale);
    this.draw();
  }

  draw() {
    const { zoom, size, steps } = this;
    if (size.width) this.frame.dataset.crop = SIDES.map((side) => this.shown[side]).join(",");
    if (!zoom.size) return; // not laid out yet
    const { width, height } = this.shown;
    this.box.draw(this.shown, zoom, size.width * zoom.base, size.height * zoom.base);
    const at = `translate(${-zoom.x * zoom.scale}px, ${-zoom.y * zoom.scale}px) scale(${zoom.times})`;
    this.frame.querySelector("img, video").style.transform = zoom.zoomed ? at : "";
    this.frame.classList.toggle("zoomed", zoom.zoomed);
    this.frame.classList.toggle("drawing", this.drawing);
    const off = { undo: !steps.past.length, redo: !steps.future.length, in: zoom.largest, out: !zoom.zoomed, fit: !zoom.zoomed };
    for (const [tool, none] of Object.entries(off)) this.tool(tool).setAttribute("aria-disabled", String(none)); // keeps the focus
    this.tool("draw").setAttribute("aria-pressed", String(this.drawing));
    this.readout.textContent = this.drawing
      ? "Drag from one corner of the new crop to the other."
      : `${width} × ${height} of ${size.width} × ${size.height} at ${Math.round(zoom.scale * 100)} %`;
  }

  tool(name) {
    return this.tools.querySelector(`[data-tool=${name}]`);
  }

  /** Show a crop that may still change. */
  put(crop) {
    this.fields.write(crop);
    this.preview(crop);
  }

  /** Show what the fields say. */
  preview(crop) {
    this.shown = crop;
    this.draw();
    this.form.dispatchEvent(new CustomEvent("crop"));
  }

  /** Set the crop; a change that goes on is one with the change before. */
  write(crop, goesOn = false) {
    this.steps.keep(crop, goesOn);
    this.put(crop);
  }

  /** Set the crop other than by a pointer, and bring it into view. */
  change(crop, goesOn = false) {
    this.zoom.reveal(crop);
    this.write(crop, goesOn);
  }

  undo(way = "undo") {
    this.gestures.cancel();
    const written = this.read();
    // What is half typed, or no number, goes first.
    if (way === "redo" || (written && same(written, this.steps.now))) this.steps[way]();
    this.change(this.steps.now);
  }

  listen() {
    this.box.element.addEventListener("keydown", (event) => this.key(event));
    this.box.element.addEventListener("focus", () => {
      if (!this.zoom.zoomed || this.gestures.drag) return;
      this.zoom.reveal(this.shown);
      this.draw();
    });
    this.tools.addEventListener("click", ({ target }) => this.use(target.closest("button")));
    for (const part of [this.frame, this.tools]) part.addEventListener("keydown", (event) => this.command(event));
    // Browsers put back what was in the fields when one returns to the page; the box follows.
    window.addEventListener("pageshow", () => {
      this.follow();
      this.form.dispatchEvent(new CustomEvent("crop"));
    });
  }

  use(button) {
    if (!button || button.getAttribute("aria-disabled") === "true") return;
    const { tool, crop } = button.dataset;
    if (crop === "all") this.change({ x: 0, y: 0, ...this.size });
    else if (crop) this.change(this.suggested);
    else if (tool === "draw") this.arm(!this.drawing);
    else if (tool === "undo" || tool === "redo") this.undo(tool);
    else this.enlarge(tool);
  }

  /** Let the next drag draw a crop, or not. */
  arm(on) {
    this.drawing = on;
    this.draw();
  }

  /** Zoom by a step about the middle of the crop, or of what is seen where the crop is not. */
  enlarge(way) {
    const { x, y, width, height } = this.shown;
    if (way === "fit") this.zoom.whole();
    else this.zoom.about(way === "in" ? Math.SQRT2 : Math.SQRT1_2, { x: x + width / 2, y: y + height / 2 });
    if (way === "in") this.zoom.reveal(this.shown);
    this.settle();
  }

  /** Bring a point of the original to a place on the screen. */
  look(point, [left, top], times) {
    const bounds = this.frame.getBoundingClientRect();
    this.zoom.hold(point, left - bounds.left, top - bounds.top, times);
    this.draw();
  }

  settle() {
    if (this.zoom.times < WHOLE_AGAIN) this.zoom.whole();
    this.draw();
  }

  /** Where in the original a place on the screen is. */
  at([left, top]) {
    const bounds = this.frame.getBoundingClientRect();
    return { x: this.zoom.x + (left - bounds.left) / this.zoom.scale, y: this.zoom.y + (top - bounds.top) / this.zoom.scale };
  }

  /** What a press on the frame drags, if anything: a finger that neither moves the crop nor the view scrolls the page. */
  kind({ button, target }, finger) {
    const onBox = target === this.box.element;
    if (button === 1) return this.zoom.zoomed && "pan";
    if (this.drawing) return "draw";
    if (target.dataset.edge) return "resize";
    if (finger) return onBox && !this.box.fills ? "move" : this.zoom.zoomed && "pan";
    const everything = same(this.shown, { x: 0, y: 0, ...this.size }); // cannot be moved: a drag draws anew
    return onBox && !everything ? "move" : "draw";
  }

  begin(drag) {
    if (drag.kind !== "pan") this.box.element.focus({ preventScroll: true }); // and a number field is left
    Object.assign(drag, { from: this.at(drag.screen), before: this.shown });
  }

  pull(drag, screen) {
    const [to, { size }] = [this.at(screen), this];
    const [dx, dy] = [to.x - drag.from.x, to.y - drag.from.y];
    if (drag.kind === "pan") this.look(drag.from, screen);
    else if (drag.kind === "move") this.put(moved(drag.before, dx, dy, size));
    else if (drag.kind === "resize") this.put(resized(drag.before, drag.edge, dx, dy, size));
    else {
      const drawn = spanned(drag.from, to, size);
      drag.drawn = Math.min(drawn.width, drawn.height) * this.zoom.scale >= drag.slop; // a line is a slip
      this.put(drag.drawn ? drawn : drag.before);
    }
  }

  end(drag) {
    if (drag.drawn) this.drawing = false;
    if (drag.under) this.write(this.shown);
  }

  /** Keys of the whole editor, but not of its number fields, which take back what was typed by themselves. */
  command(event) {
    if (event.key === "Escape") {
      this.gestures.cancel();
      this.arm(false);
    }
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const letter = event.key.toLowerCase();
    const way = { z: event.shiftKey ? "redo" : "undo", y: "redo" }[letter];
    if (!way) return;
    event.preventDefault();
    this.undo(way);
  }

  key(event) {
    const arrow = ARROWS[event.key];
    if (event.altKey || event.metaKey) return;
    if (ZOOMS[event.key] && !event.ctrlKey) this.enlarge(ZOOMS[event.key]);
    else if (arrow) {
      const [dx, dy] = arrow.map((step) => step * (event.ctrlKey ? 10 : 1));
      const { shown, size } = this;
      this.change(event.shiftKey ? resized(shown, "se", dx, dy, size) : moved(shown, dx, dy, size), event.repeat);
    } else return;
    event.preventDefault();
  }
}
