// The reel of a clip: a track as long as the clip, with the range that is taken of it, handles at its ends, and a mark
// at the frame that is on the screen.

import { append } from "../lib/dom.js";

/** @import { Extent, FrameRange, Part } from "./frame_range.js" */

/** @type {Record<Part, string>} */
const LABELS = { range: "Time range", first: "First frame", last: "Last frame" };

export class Reel {
  /** @param {HTMLElement} block of the time range */
  constructor(block) {
    const reel = append("div", { class: "reel" }, block);
    block.prepend(reel);
    this.button = append("button", { type: "button" }, reel);
    this.track = append("div", { class: "track", role: "group", "aria-label": LABELS.range }, reel);
    const handle = (/** @type {Part} */ part) => {
      const role = { role: "slider", tabindex: "0", "aria-label": LABELS[part], "aria-valuemin": "0" };
      return append("span", { class: part === "range" ? "range" : "end", "data-part": part, ...role }, this.track);
    };
    /** @type {Record<Part, HTMLElement>} */
    this.handles = { range: handle("range"), first: handle("first"), last: handle("last") };
    this.now = append("span", { class: "now", "aria-hidden": "true" }, this.track);
    this.readout = append("output", { class: "hint" }, reel);
  }

  /**
   * The part whose handle an event is about, if any.
   *
   * @param {Event} event
   * @returns {Part | undefined}
   */
  partOf({ target }) {
    const part = target instanceof HTMLElement ? target.dataset.part : undefined;
    return part === "range" || part === "first" || part === "last" ? part : undefined;
  }

  /**
   * Where on the clip a pointer is, in frames.
   *
   * @param {PointerEvent} event
   * @param {number} total
   */
  frameAt(event, total) {
    const { left, width } = this.track.getBoundingClientRect();
    return ((event.clientX - left) / width) * total;
  }

  /**
   * @param {FrameRange} range
   * @param {Extent} extent
   * @param {number} rate
   */
  draw({ first, count }, { total, video }, rate) {
    const last = first + count - 1;
    const place = (/** @type {number} */ frame) => `${(100 * frame) / total}%`;
    const seconds = (/** @type {number} */ frames) => `${(frames / rate).toFixed(2)} s`;
    const describe = (/** @type {Part} */ part, /** @type {number} */ value, /** @type {number} */ most) => {
      const handle = this.handles[part];
      handle.setAttribute("aria-valuemax", String(most));
      handle.setAttribute("aria-valuenow", String(value));
      handle.setAttribute("aria-valuetext", `${value}, at ${seconds(value)}`);
    };
    describe("range", first, total - count);
    describe("first", first, total - 1);
    describe("last", last, total - 1);
    this.handles.range.style.left = place(first);
    this.handles.range.style.width = place(count);
    this.handles.first.style.left = place(video ? first : first + 0.5);
    this.handles.last.style.left = place(first + count);
    this.handles.first.setAttribute("aria-label", video ? LABELS.first : "Frame");
    this.readout.textContent = video
      ? `${first}–${last} of ${total} frames, ${seconds(count)}`
      : `frame ${first} of ${total}, at ${seconds(first)}`;
  }

  /**
   * @param {boolean} playing
   * @param {boolean} video whether what is taken is one
   */
  name(playing, video) {
    this.button.textContent = playing ? "Pause" : "Play";
    this.button.hidden = !video;
    this.track.classList.toggle("still", !video);
  }

  /**
   * Mark the frame that is on the screen.
   *
   * @param {number} frame
   * @param {number} total
   */
  mark(frame, total) {
    this.now.style.left = `${(100 * (frame + 0.5)) / total}%`;
  }
}
