// The box that shows a crop on its photograph, with eight handles, and the shade over what lies outside.

const EDGES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
const FINGER = 44; // screen pixels beside the box that a finger needs to miss it
const KEYS =
  "Arrow keys move the crop, with Shift they resize it, with Ctrl ten pixels at a time. Plus and minus zoom, 0 shows all. Ctrl and Z undo.";

function element(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

export class Box {
  constructor(frame, legend) {
    const shade = element("div", { class: "shade", "aria-hidden": "true" }, frame);
    this.dark = element("span", {}, shade);
    const keys = element("span", { id: `${legend.id}-keys`, hidden: "" }, frame);
    keys.textContent = `Crop. ${KEYS}`;
    const names = { tabindex: "0", role: "application", "aria-labelledby": `${legend.id} ${keys.id}` };
    this.element = element("div", { class: "box", ...names }, frame);
    for (const edge of EDGES) element("span", { class: "handle", "data-edge": edge }, this.element);
    this.label = element("span", { class: "readout", "aria-hidden": "true" }, this.element);
  }

  /** Whether it leaves no room beside it: one finger then does on it what it does beside it, or nothing could be reached. */
  get fills() {
    return this.element.classList.contains("full");
  }

  /** Draw a crop on a frame of `wide` × `high` screen pixels that shows the photograph from zoom.x, zoom.y on. */
  draw(crop, zoom, wide, high) {
    const { scale } = zoom;
    const [left, top] = [(crop.x - zoom.x) * scale, (crop.y - zoom.y) * scale];
    const [width, height] = [crop.width * scale, crop.height * scale];
    const [right, bottom] = [left + width, top + height];
    Object.assign(this.element.style, { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` });
    const hole = [[left, top], [left, bottom], [right, bottom], [right, top], [left, top]];
    const outer = [[0, 0], [wide, 0], [wide, high], [0, high], [0, 0]];
    this.dark.style.clipPath = `polygon(evenodd, ${[...outer, ...hole].map(([x, y]) => `${x}px ${y}px`).join(", ")})`;
    this.label.textContent = `${crop.width} × ${crop.height}`;
    const marks = {
      full: Math.max(left, top, wide - right, high - bottom) < FINGER,
      low: bottom + 52 > high,
      small: width < 120 || height < 64,
      tiny: width < 88 || height < 88,
    };
    for (const [mark, on] of Object.entries(marks)) this.element.classList.toggle(mark, on);
  }
}
