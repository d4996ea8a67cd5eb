// The crop on a photograph. The four numeric fields are the truth: the box shows them, and dragging writes to them.
// Every change is told to the form as a "crop" event.

import { fitted, moved, resized, spanned } from "./rectangle.js";

export const SIDES = ["x", "y", "width", "height"];
const EDGES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
const LARGEST = 3; // times that a small photograph is enlarged on the screen
const SLOP = 4; // screen pixels that a press may slip and still be no drag
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const KEYS = "Arrow keys move the crop, with Shift they resize it, with Ctrl ten pixels at a time.";

function element(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

/** The editor of one input's crop; `root` holds the photograph's frame and the fields. */
export class Crop {
  constructor(root) {
    this.form = root.closest("form");
    this.frame = root.querySelector(".frame");
    this.ground = this.frame.parentElement;
    this.fields = Object.fromEntries(SIDES.map((side) => [side, root.querySelector(`[data-side=${side}]`)]));
    this.tools = root.querySelector("[id$=crop-tools]");
    this.readout = root.querySelector("[id$=crop-size]");
    this.scale = 1; // screen pixels per pixel of the original
    this.drag = null;
    this.build(root.querySelector("legend"));
    this.listen();
    this.readSize();
    this.follow();
    new ResizeObserver(() => this.layOut()).observe(this.ground);
    window.addEventListener("resize", () => this.layOut());
  }

  build(legend) {
    const shade = element("div", { class: "shade", "aria-hidden": "true" }, this.frame);
    this.dark = element("span", {}, shade);
    const keys = element("span", { id: `${legend.id}-keys`, hidden: "" }, this.frame);
    keys.textContent = `Crop. ${KEYS}`;
    const names = { tabindex: "0", role: "application", "aria-labelledby": `${legend.id} ${keys.id}` };
    this.box = element("div", { class: "box", ...names }, this.frame);
    for (const edge of EDGES) element("span", { class: "handle", "data-edge": edge }, this.box);
    this.label = element("span", { class: "readout", "aria-hidden": "true" }, this.box);
    this.tools.hidden = false;
  }

  readSize() {
    this.size = { width: Number(this.frame.dataset.width), height: Number(this.frame.dataset.height) };
  }

  get suggested() {
    const wanted = this.tools.querySelector("button:last-of-type").dataset.crop.split(",").map(Number);
    return wanted.length === 4 ? wanted : [0, 0, this.size.width, this.size.height];
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
    this.tools.querySelector("button").textContent = video ? "Whole frame" : "Whole photograph";
    this.tools.querySelector("button:last-of-type").dataset.crop = crop;
    const most = { x: width - 1, y: height - 1, width, height };
    for (const side of SIDES) this.fields[side].max = most[side];
    this.readSize();
    const [x, y, wide, high] = this.suggested;
    this.shown = { x, y, width: wide, height: high };
    this.layOut();
    this.write(this.shown);
  }

  read() {
    const values = Object.fromEntries(SIDES.map((side) => [side, Math.round(Number(this.fields[side].value))]));
    const said = SIDES.every((side) => this.fields[side].value.trim() !== "" && Number.isFinite(values[side]));
    return said ? values : null;
  }

  /** Take what the fields say; those left empty take the crop to start from. */
  follow() {
    const [x, y, width, height] = this.suggested;
    const empty = SIDES.every((side) => this.fields[side].value === "");
    this.shown = fitted(this.read() ?? this.shown ?? { x, y, width, height }, "width", this.size);
    if (empty && this.size.width) for (const side of SIDES) this.fields[side].value = this.shown[side];
    this.layOut();
  }

  layOut() {
    const style = getComputedStyle(this.ground);
    const room = this.ground.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    if (room <= 0 || !this.size.width) return; // not on the screen
    const narrow = window.matchMedia("(max-width: 960px)").matches;
    const tall = Math.max(240, narrow ? window.innerHeight * 0.6 : window.innerHeight - 360);
    this.scale = Math.min(room / this.size.width, tall / this.size.height, LARGEST);
    this.frame.style.width = `${this.size.width * this.scale}px`;
    this.frame.style.height = `${this.size.height * this.scale}px`;
    this.frame.classList.add("ready");
    this.draw();
  }

  draw() {
    const { scale, size } = this;
    const crop = fitted(this.shown, "width", size);
    const [left, top, width, height] = SIDES.map((side) => crop[side] * scale);
    Object.assign(this.box.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
    const [wide, high] = [size.width * scale, size.height * scale];
    const hole = [[left, top], [left, top + height], [left + width, top + height], [left + width, top], [left, top]];
    const outer = [[0, 0], [wide, 0], [wide, high], [0, high], [0, 0]];
    this.dark.style.clipPath = `polygon(evenodd, ${[...outer, ...hole].map(([x, y]) => `${x}px ${y}px`).join(", ")})`;
    this.label.textContent = `${crop.width} × ${crop.height}`;
    this.box.classList.toggle("small", width < 120 || height < 64);
    this.box.classList.toggle("tiny", width < 88 || height < 88);
    this.box.classList.toggle("low", top + height + 52 > high);
    const percent = Math.round(scale * 100);
    this.readout.textContent = `${crop.width} × ${crop.height} of ${size.width} × ${size.height} at ${percent} %`;
  }

  write(crop) {
    this.shown = crop;
    for (const side of SIDES) this.fields[side].value = crop[side];
    this.draw();
    this.form.dispatchEvent(new CustomEvent("crop"));
  }

  listen() {
    this.frame.addEventListener("pointerdown", (event) => this.press(event));
    this.frame.addEventListener("pointermove", (event) => this.pull(event));
    const letGo = (event) => {
      if (event.pointerId === this.drag?.id) this.drag = null;
    };
    this.frame.addEventListener("pointerup", letGo);
    this.frame.addEventListener("pointercancel", letGo);
    this.box.addEventListener("keydown", (event) => this.key(event));
    for (const side of SIDES) {
      this.fields[side].addEventListener("input", () => {
        const typed = this.read();
        if (!typed) return;
        this.shown = fitted(typed, side, this.size);
        this.draw();
        // What does not fit yet is told when it has been made to, once the field is left.
        if (SIDES.every((each) => typed[each] === this.shown[each])) this.form.dispatchEvent(new CustomEvent("crop"));
      });
      this.fields[side].addEventListener("change", () => this.write(this.shown));
    }
    this.tools.addEventListener("click", (event) => {
      const wanted = event.target.dataset.crop;
      if (!wanted) return;
      const { width: wide, height: high } = this.size;
      const [x, y, width, height] = wanted === "all" ? [0, 0, wide, high] : wanted.split(",").map(Number);
      this.write({ x, y, width, height });
    });
    // Browsers put back what was in the fields when one returns to the page; the box follows.
    window.addEventListener("pageshow", () => {
      this.follow();
      this.form.dispatchEvent(new CustomEvent("crop"));
    });
  }

  at(event) {
    const bounds = this.frame.getBoundingClientRect();
    return { x: (event.clientX - bounds.left) / this.scale, y: (event.clientY - bounds.top) / this.scale };
  }

  press(event) {
    if (event.button !== 0 || this.drag) return;
    event.preventDefault();
    const { size, shown } = this;
    const { edge } = event.target.dataset ?? {};
    const everything = shown.width === size.width && shown.height === size.height; // cannot be moved: a drag draws anew
    const kind = edge ? "resize" : event.target === this.box && !everything ? "move" : "draw";
    const screen = [event.clientX, event.clientY];
    this.drag = { kind, edge, id: event.pointerId, from: this.at(event), screen, before: shown, under: false };
    this.frame.setPointerCapture(event.pointerId);
    this.box.focus({ preventScroll: true });
  }

  pull(event) {
    const { drag, size } = this;
    if (event.pointerId !== drag?.id) return;
    const slipped = Math.hypot(event.clientX - drag.screen[0], event.clientY - drag.screen[1]);
    drag.under ||= slipped >= SLOP;
    if (!drag.under) return;
    const to = this.at(event);
    const [dx, dy] = [to.x - drag.from.x, to.y - drag.from.y];
    if (drag.kind === "draw") this.write(spanned(drag.from, to, size));
    else if (drag.kind === "move") this.write(moved(drag.before, dx, dy, size));
    else this.write(resized(drag.before, drag.edge, dx, dy, size));
  }

  key(event) {
    if (event.key === "Escape" && this.drag) {
      const { before } = this.drag;
      this.drag = null;
      this.write(before);
    }
    const arrow = ARROWS[event.key];
    if (!arrow || event.altKey || event.metaKey) return;
    event.preventDefault();
    const [dx, dy] = arrow.map((step) => step * (event.ctrlKey ? 10 : 1));
    this.write(event.shiftKey ? resized(this.shown, "se", dx, dy, this.size) : moved(this.shown, dx, dy, this.size));
  }
}
