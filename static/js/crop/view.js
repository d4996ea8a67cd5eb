// The view of a photograph or a clip in its frame: as large as the page has room for, and what of it is seen.

import { find, seek } from "../lib/dom.js";
import { Zoom } from "./zoom.js";

/** @import { Place } from "../lib/pinch.js" */
/** @import { Point, Size } from "./rectangle.js" */
/** @typedef {Size & { address: string, video: string, title: string }} Picture `video` is empty, or a clip's own address */

const LARGEST = 3; // times that a small photograph is enlarged on the screen
const WHOLE_AGAIN = 1.02; // an enlargement that is none
const MEDIA = "img, video";

export class View {
  zoom = new Zoom();

  /** @param {HTMLElement} frame */
  constructor(frame) {
    this.frame = frame;
    this.ground = /** @type {HTMLElement} */ (frame.parentElement);
    this.size = this.readSize();
  }

  /** @returns {Size} of the photograph; 0 × 0 where there is none yet */
  readSize() {
    const { width, height } = this.frame.dataset;
    return { width: Number(width ?? 0), height: Number(height ?? 0) };
  }

  /**
   * Show another photograph, or a clip if it has an address as such.
   *
   * @param {Picture} picture
   */
  show({ address, video, title, width, height }) {
    seek(this.frame, MEDIA)?.remove();
    const shown = document.createElement(video ? "video" : "img");
    const playing = { src: video, poster: address, loop: true, muted: true, playsInline: true, ariaLabel: title };
    Object.assign(shown, video ? playing : { src: address, alt: title }, { width, height });
    this.frame.prepend(shown);
    Object.assign(this.frame.dataset, { width, height });
    this.size = this.readSize();
    this.zoom.whole();
  }

  /** Make the frame as large as there is room for; says whether it is on the screen at all. */
  layOut() {
    const { width, height } = this.size;
    const style = getComputedStyle(this.ground);
    const room = this.ground.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    if (room <= 0 || !width) return false;
    const narrow = window.matchMedia("(max-width: 960px)").matches;
    const tall = Math.max(240, narrow ? window.innerHeight * 0.6 : window.innerHeight - 360);
    const scale = Math.min(room / width, tall / height, LARGEST);
    this.frame.style.width = `${width * scale}px`;
    this.frame.style.height = `${height * scale}px`;
    this.frame.classList.add("ready");
    this.zoom.layOut(this.size, scale);
    return true;
  }

  draw() {
    const { x, y, scale, times, zoomed } = this.zoom;
    const at = `translate(${-x * scale}px, ${-y * scale}px) scale(${times})`;
    find(this.frame, MEDIA).style.transform = zoomed ? at : "";
    this.frame.classList.toggle("zoomed", zoomed);
  }

  /**
   * Where in the original a place on the screen is.
   *
   * @param {Place} at
   * @returns {Point}
   */
  pointAt([left, top]) {
    const { x, y, scale } = this.zoom;
    const bounds = this.frame.getBoundingClientRect();
    return { x: x + (left - bounds.left) / scale, y: y + (top - bounds.top) / scale };
  }

  /**
   * Bring a point of the original to a place on the screen.
   *
   * @param {Point} point
   * @param {Place} at
   * @param {number} [times] of enlargement, as it is where there is none
   */
  bring(point, [left, top], times) {
    const bounds = this.frame.getBoundingClientRect();
    this.zoom.hold(point, left - bounds.left, top - bounds.top, times);
  }

  /** Show all of it again after a zoom that left next to nothing out. */
  settle() {
    if (this.zoom.times < WHOLE_AGAIN) this.zoom.whole();
  }
}
