// The time range of a clip. The two numeric fields are the truth: the reel shows them, and dragging its ends writes to
// them and shows their frames. Of a clip, a still method takes the one frame at the first end. Changes are "crop"
// events.

import { clamp } from "../lib/clamp.js";
import { find, findAll, seek } from "../lib/dom.js";
import { NumberGroup } from "../lib/number_group.js";
import { explain, fit, move } from "./frame_range.js";
import { RangePlayback, REDUCED } from "./range_playback.js";
import { Reel } from "./reel.js";

/** @import { Extent, FrameRange, Part } from "./frame_range.js" */

/** @type {Record<string, number>} */
const KEYS = {
  ArrowLeft: -1,
  ArrowDown: -1,
  ArrowRight: 1,
  ArrowUp: 1,
  PageDown: -10,
  PageUp: 10,
  Home: -Infinity,
  End: Infinity,
};

/** The editor of one input's time range. */
export class TimeRange {
  plays = !REDUCED.matches;
  /** @type {{ part: Part, id: number, from: number, first: number, end: number, playing: boolean } | null} */
  drag = null;
  /** @type {RangePlayback | null} */
  playback = null;
  /** @type {FrameRange | null} */
  shown = null;
  /** @type {FrameRange | null} */
  kept = null;

  /**
   * @param {HTMLElement} root holds the picture's frame and the fields
   * @param {AbortSignal} signal
   */
  constructor(root, signal) {
    this.root = root;
    this.form = /** @type {HTMLElement} */ (root.closest("form"));
    this.block = find(root, ".time");
    const field = (/** @type {string} */ part) => find(root, `[data-time=${part}]`, HTMLInputElement);
    this.fields = { first: field("first"), count: field("count") };
    /** @type {NumberGroup<keyof FrameRange>} */
    this.group = new NumberGroup(this.fields, find(root, "[data-fit=time]"), {
      read: () => this.read(),
      fit: (range) => fit(range, this.extent),
      explain: (_part, meant, range) => explain(meant, range, this.extent),
      preview: (range) => this.take(range ?? this.kept),
      keep: (range) => {
        this.take(range);
        this.keep(range);
        this.form.dispatchEvent(new CustomEvent("crop"));
      },
    });
    this.reel = new Reel(this.block);
    this.listen(signal);
    this.follow();
  }

  get total() {
    return Number(this.block.dataset.frames);
  }

  get rate() {
    return Number(this.block.dataset.rate);
  }

  /** Whether the chosen method takes a video here. */
  get video() {
    return find(this.form, "[name=method]:checked").classList.contains(`video-${this.root.dataset.input}`);
  }

  /** @returns {Extent} */
  get extent() {
    return { total: this.total, video: this.video };
  }

  /**
   * Show another sample, with the range it had, or all of it.
   *
   * @param {{ frames: number, rate: number }} sample
   * @param {FrameRange | null} range
   */
  show({ frames, rate }, range = null) {
    Object.assign(this.block.dataset, { frames, rate });
    this.block.hidden = this.total < 2;
    for (const last of findAll(this.block, ".last")) last.textContent = String(this.total - 1);
    for (const total of findAll(this.block, ".total")) total.textContent = String(this.total);
    this.fields.first.dataset.max = String(this.total - 1);
    this.fields.count.dataset.max = String(this.total);
    this.fields.first.value = range ? String(range.first) : "";
    this.fields.count.value = range ? String(range.count) : "";
    this.follow();
  }

  /** The range as it is written, null where it is none; left empty, and of a still method, it goes on to the end. */
  read() {
    const range = this.group.read((part, { first }) => (part === "first" ? 0 : this.total - first));
    return range && !this.video ? { first: range.first, count: this.total - range.first } : range;
  }

  /** Take what the fields, the method and the sample say. */
  follow() {
    const video = seek(this.root, "video", HTMLVideoElement);
    if (this.playback?.video !== video) {
      this.playback = video && new RangePlayback(video, this.rate, (frame) => this.reel.mark(frame, this.total));
    }
    if (!video) return;
    const { empty } = this.group;
    const range = fit(this.read() ?? this.shown ?? { first: 0, count: this.total }, this.extent);
    this.take(range);
    this.kept = range;
    if (empty) this.keep(range);
  }

  /**
   * Show a range.
   *
   * @param {FrameRange | null} range
   */
  take(range) {
    if (!range || !this.playback) return; // fields of no clip
    const { playback } = this;
    this.draw(range);
    playback.range = range;
    const visible = this.block.checkVisibility?.() ?? true;
    if (this.video && this.plays && visible) playback.play();
    else playback.pause();
    if (!playback.playing) playback.seek(range.first);
    this.name();
  }

  /** @param {FrameRange} range */
  keep(range) {
    this.kept = range;
    this.group.write(range);
  }

  name() {
    this.reel.name(this.playback?.playing ?? false, this.video);
  }

  /** @param {FrameRange} range */
  draw(range) {
    this.shown = range;
    this.block.dataset.first = String(range.first);
    this.reel.draw(range, this.extent, this.rate);
  }

  /**
   * Move the range or one of its ends to begin or end with a frame, and show that one.
   *
   * @param {Part} part
   * @param {number} frame
   */
  move(part, frame) {
    const { playback } = this;
    if (!this.shown || !playback) return;
    const range = move(part, frame, this.shown, this.extent);
    this.keep(range);
    this.draw(range);
    playback.range = range;
    playback.pause();
    playback.seek(part === "last" ? range.first + range.count - 1 : range.first);
    this.form.dispatchEvent(new CustomEvent("crop"));
  }

  /** @param {AbortSignal} signal */
  listen(signal) {
    const { button, track } = this.reel;
    button.addEventListener("click", () => {
      this.plays = !this.playback?.playing;
      if (this.plays) this.playback?.play();
      else this.playback?.pause();
    });
    for (const kind of ["play", "pause"]) {
      // These do not bubble, and the video may be another one later.
      this.root.addEventListener(kind, () => this.playback && this.name(), true);
    }
    track.addEventListener("pointerdown", (event) => this.press(event));
    track.addEventListener("pointermove", (event) => this.pull(event));
    track.addEventListener("pointerup", (event) => this.lift(event));
    track.addEventListener("pointercancel", (event) => this.lift(event));
    track.addEventListener("keydown", (event) => this.key(event));
    this.form.addEventListener("change", ({ target }) => {
      if (target instanceof HTMLInputElement && target.name === "method") this.follow();
    });
    window.addEventListener("pageshow", () => this.follow(), { signal });
  }

  /** @param {PointerEvent} event */
  press(event) {
    if (event.button !== 0 || this.drag || !this.playback || !this.shown) return;
    event.preventDefault();
    const at = this.reel.frameAt(event, this.total);
    const { first, count } = this.shown;
    const near = this.video && Math.abs(at - first - count) < Math.abs(at - first) ? "last" : "first";
    const held = this.reel.partOf(event);
    const part = held ?? near; // beside the range: the end that is nearer comes here
    const { playing } = this.playback;
    this.drag = { part, id: event.pointerId, from: at, first, end: first + count, playing };
    this.reel.track.setPointerCapture(event.pointerId);
    this.reel.handles[part].focus({ preventScroll: true });
    if (!held) this.move(part, Math.floor(at));
  }

  /** @param {PointerEvent} event */
  pull(event) {
    if (!this.drag || event.pointerId !== this.drag.id) return;
    const { part, from, first, end } = this.drag;
    const by = this.reel.frameAt(event, this.total) - from;
    if (part === "last") this.move(part, Math.round(end + by) - 1);
    else this.move(part, Math.round(first + by));
  }

  /** @param {PointerEvent} event */
  lift(event) {
    if (event.pointerId !== this.drag?.id) return;
    if (this.drag.playing) this.playback?.play();
    this.drag = null;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const part = this.reel.partOf(event);
    let step = KEYS[event.key];
    if (!part || !step || !this.shown || event.altKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    if (event.ctrlKey) step *= 10;
    this.plays = false;
    const { first, count } = this.shown;
    const from = part === "last" ? first + count - 1 : first;
    this.move(part, clamp(from + step, 0, this.total - 1));
  }
}
