// The box that shows a crop on its photograph, with eight handles, and the shade over what lies outside.

import { append } from "../lib/dom.js";

/** @import { Rectangle } from "./rectangle.js" */
/** @import { Zoom } from "./zoom.js" */

const EDGES = ["nw", "n", "ne", "e", "se", "s", "sw", "w"];
const FINGER = 44; // screen pixels beside the box that a finger needs to miss it
const KEYS =
  "Arrow keys move the crop, with Shift they resize it, with Ctrl ten pixels at a time. Plus and minus zoom, 0 shows all. Ctrl and Z undo.";

export class Box {
  /**
   * @param {HTMLElement} frame of the photograph
   * @param {HTMLElement} legend that names the input
   */
  constructor(frame, legend) {
    const shade = append("div", { class: "shade", "aria-hidden": "true" }, frame);
    this.dark = append("span", {}, shade);
    const keys = append("span", { id: `${legend.id}-keys`, hidden: "" }, frame);
    keys.textContent = `Crop. ${KEYS}`;
    const names = { tabindex: "0", role: "application", "aria-labelledby": `${legend.id} ${keys.id}` };
    this.element = append("div", { class: "box", ...names }, frame);
    for (const edge of EDGES) append("span", { class: "handle", "data-edge": edge }, this.element);
    this.label = append("span", { class: "readout", "aria-hidden": "true" }, this.element);
  }

  /** Whether it leaves no room beside it: one finger then does on it what it does beside it, or nothing could be reached. */
  get fills() {
    return this.element.classList.contains("full");
  }

  /**
   * Draw a crop on a frame of `wide` × `high` screen pixels that shows the photograph from zoom.x, zoom.y on.
   *
   * @param {Rectangle} crop
   * @param {Zoom} zoom
   * @param {number} wide
   * @param {number} high
   */
  draw(crop, zoom, wide, high) {
    const { scale } = zoom;
    const [left, top] = [(crop.x - zoom.x) * scale, (crop.y - zoom.y) * scale];
    const [width, height] = [crop.width * scale, crop.height * scale];
    const [right, bottom] = [left + width, top + height];
    Object.assign(this.element.style, {
      left: `${left}px`,
      top: `${top}px`,
      width: `${width}px`,
      height: `${height}px`,
    });
    this.dark.style.clipPath = `polygon(evenodd, ${outline(0, 0, wide, high)}, ${outline(left, top, right, bottom)})`;
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

/**
 * A closed way round a rectangle, as CSS writes polygons.
 *
 * @param {number} left
 * @param {number} top
 * @param {number} right
 * @param {number} bottom
 */
function outline(left, top, right, bottom) {
  const corner = `${left}px ${top}px`;
  return `${corner}, ${left}px ${bottom}px, ${right}px ${bottom}px, ${right}px ${top}px, ${corner}`;
}
