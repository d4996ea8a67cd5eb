// The crop on the photograph. The four numeric fields are the truth: the box shows them, and dragging writes to them.
// Every change is told to the form as a "crop" event.

import { fitted, moved, resized, spanned } from "./rectangle.js";

const SIDES = ["x", "y", "width", "height"];
const EDGES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
const LARGEST = 3; // times that a small photograph is enlarged on the screen
const SLOP = 4; // screen pixels that a press may slip and still be no drag

const form = document.querySelector("#experiment");
const frame = document.querySelector("#frame");
const ground = frame.parentElement;
const size = { width: Number(frame.dataset.width), height: Number(frame.dataset.height) };
const inputs = Object.fromEntries(SIDES.map((side) => [side, document.querySelector(`#crop-${side}`)]));
const readout = document.querySelector("#crop-size");

function element(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

const shade = element("div", { class: "shade", "aria-hidden": "true" }, frame);
const dark = element("span", {}, shade);
const keys = "Arrow keys move the crop, with Shift they resize it, with Ctrl ten pixels at a time.";
const box = element("div", { class: "box", tabindex: "0", role: "application", "aria-label": `Crop. ${keys}` }, frame);
for (const edge of EDGES) element("span", { class: "handle", "data-edge": edge }, box);
const label = element("span", { class: "readout", "aria-hidden": "true" }, box);

let scale = 1; // screen pixels per pixel of the original
let shown = read();
let drag = null;

function read() {
  const values = Object.fromEntries(SIDES.map((side) => [side, Math.round(Number(inputs[side].value))]));
  return SIDES.every((side) => inputs[side].value.trim() !== "" && Number.isFinite(values[side])) ? values : null;
}

function layOut() {
  const style = getComputedStyle(ground);
  const room = ground.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
  const narrow = window.matchMedia("(max-width: 960px)").matches;
  const tall = Math.max(200, narrow ? window.innerHeight * 0.6 : window.innerHeight - 180);
  scale = Math.min(room / size.width, tall / size.height, LARGEST);
  frame.style.width = `${size.width * scale}px`;
  frame.style.height = `${size.height * scale}px`;
  frame.classList.add("ready");
  draw();
}

function draw() {
  const crop = fitted(shown, "width", size);
  const [left, top, width, height] = SIDES.map((side) => crop[side] * scale);
  Object.assign(box.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
  const hole = [[left, top], [left, top + height], [left + width, top + height], [left + width, top], [left, top]];
  const outer = [[0, 0], [size.width * scale, 0], [size.width * scale, size.height * scale], [0, size.height * scale], [0, 0]];
  dark.style.clipPath = `polygon(evenodd, ${[...outer, ...hole].map(([x, y]) => `${x}px ${y}px`).join(", ")})`;
  label.textContent = `${crop.width} × ${crop.height}`;
  box.classList.toggle("small", width < 120 || height < 64);
  box.classList.toggle("tiny", width < 88 || height < 88);
  box.classList.toggle("low", top + height + 52 > size.height * scale);
  const percent = Math.round(scale * 100);
  readout.textContent = `${crop.width} × ${crop.height} of ${size.width} × ${size.height}, shown at ${percent} %`;
}

function write(crop) {
  shown = crop;
  for (const side of SIDES) inputs[side].value = crop[side];
  draw();
  form.dispatchEvent(new CustomEvent("crop"));
}

const at = (event) => {
  const bounds = frame.getBoundingClientRect();
  return { x: (event.clientX - bounds.left) / scale, y: (event.clientY - bounds.top) / scale };
};

frame.addEventListener("pointerdown", (event) => {
  if (event.button !== 0 || drag) return;
  event.preventDefault();
  const edge = event.target.dataset?.edge;
  const everything = shown.width === size.width && shown.height === size.height; // cannot be moved: a drag draws anew
  const kind = edge ? "resize" : event.target === box && !everything ? "move" : "draw";
  drag = { kind, edge, id: event.pointerId, from: at(event), screen: [event.clientX, event.clientY], before: shown, under: false };
  frame.setPointerCapture(event.pointerId);
  box.focus({ preventScroll: true });
});

frame.addEventListener("pointermove", (event) => {
  if (!drag || event.pointerId !== drag.id) return;
  const slipped = Math.hypot(event.clientX - drag.screen[0], event.clientY - drag.screen[1]);
  drag.under ||= slipped >= SLOP;
  if (!drag.under) return;
  const to = at(event);
  const [dx, dy] = [to.x - drag.from.x, to.y - drag.from.y];
  if (drag.kind === "draw") write(spanned(drag.from, to, size));
  else if (drag.kind === "move") write(moved(drag.before, dx, dy, size));
  else write(resized(drag.before, drag.edge, dx, dy, size));
});

const letGo = (event) => {
  if (drag && event.pointerId === drag.id) drag = null;
};
frame.addEventListener("pointerup", letGo);
frame.addEventListener("pointercancel", letGo);

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
box.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && drag) {
    const { before } = drag;
    drag = null;
    write(before);
  }
  const arrow = ARROWS[event.key];
  if (!arrow || event.altKey || event.metaKey) return;
  event.preventDefault();
  const [dx, dy] = arrow.map((step) => step * (event.ctrlKey ? 10 : 1));
  write(event.shiftKey ? resized(shown, "se", dx, dy, size) : moved(shown, dx, dy, size));
});

for (const side of SIDES) {
  inputs[side].addEventListener("input", () => {
    const typed = read();
    if (!typed) return;
    shown = fitted(typed, side, size);
    draw();
    form.dispatchEvent(new CustomEvent("crop"));
  });
  inputs[side].addEventListener("change", () => write(shown));
}

const tools = document.querySelector("#crop-tools");
tools.hidden = false;
tools.addEventListener("click", (event) => {
  const wanted = event.target.dataset.crop;
  if (!wanted) return;
  const [x, y, width, height] = wanted === "all" ? [0, 0, size.width, size.height] : wanted.split(",").map(Number);
  write({ x, y, width, height });
});

shown = fitted(shown ?? { x: 0, y: 0, ...size }, "width", size);
layOut();
new ResizeObserver(layOut).observe(ground);
window.addEventListener("resize", layOut);

// Browsers put back what was in the fields when one returns to the page; the box follows.
window.addEventListener("pageshow", () => {
  shown = fitted(read() ?? shown, "width", size);
  draw();
  form.dispatchEvent(new CustomEvent("crop"));
});
