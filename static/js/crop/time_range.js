// The time range of a clip. The two numeric fields are the truth: the reel shows them, and dragging its ends writes to them
// and shows their frames. Of a clip, a still method takes the one frame at the first end. Changes are "crop" events.

import { RangePlayback, REDUCED } from "./range_playback.js";
import { NumberGroup } from "../lib/number_group.js";

const KEYS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -Infinity, End: Infinity };
const PARTS = { range: "Time range", first: "First frame", last: "Last frame" };
const between = (value, low, high) => Math.min(Math.max(value, low), high);

function element(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

/** Say what had to give way to the number that was typed. */
function gaveWay(wanted, range) {
  if (range.count > wanted.count) return "A video has 2 frames or more.";
  if (range.count < wanted.count) return `It is ${range.count} frames now: the clip has no more.`;
  return `It begins with frame ${range.first} now: from ${wanted.first} on, ${wanted.count} frames do not fit.`;
}

/** The editor of one input's time range; `root` holds the picture's frame and the fields. */
export class TimeRange {
  constructor(root) {
    this.root = root;
    this.form = root.closest("form");
    this.block = root.querySelector(".time");
    const fields = ["first", "count"].map((part) => [part, root.querySelector(`[data-time=${part}]`)]);
    this.fields = Object.fromEntries(fields);
    this.group = new NumberGroup(this.fields, root.querySelector("[data-fit=time]"), {
      read: () => this.read(),
      fitted: (range) => this.fitted(range),
      words: (part, wanted, range) => (this.moving ? gaveWay(wanted, range) : `The last frame of the clip is ${range.first}.`),
      typed: (range) => this.take(range ?? this.kept),
      left: (range) => {
        this.take(range);
        this.keep();
        this.form.dispatchEvent(new CustomEvent("crop"));
      },
    });
    this.plays = !REDUCED.matches;
    this.drag = null;
    /** @type {RangePlayback | undefined} */
    this.clip = undefined;
    this.build();
    this.listen();
    this.follow();
  }

  build() {
    const reel = element("div", { class: "reel" }, this.block);
    this.block.prepend(reel);
    this.button = element("button", { type: "button" }, reel);
    this.track = element("div", { class: "track", role: "group", "aria-label": "Time range" }, reel);
    this.handles = {};
    for (const [part, label] of Object.entries(PARTS)) {
      const kind = part === "range" ? "range" : "end";
      const names = { class: kind, "data-part": part, role: "slider", tabindex: "0", "aria-label": label, "aria-valuemin": "0" };
      this.handles[part] = element("span", names, this.track);
    }
    this.now = element("span", { class: "now", "aria-hidden": "true" }, this.track);
    this.readout = element("output", { class: "hint" }, reel);
  }

  get total() {
    return Number(this.block.dataset.frames);
  }

  get rate() {
    return Number(this.block.dataset.rate);
  }

  /** Whether the chosen method takes a video here. */
  get moving() {
    return this.form.querySelector("[name=method]:checked").classList.contains(`moves-${this.root.dataset.input}`);
  }

  /** Show another sample, with the range it had, or all of it. */
  show({ frames, rate }, range = null) {
    Object.assign(this.block.dataset, { frames, rate });
    this.block.hidden = this.total < 2;
    for (const last of this.block.querySelectorAll(".last")) last.textContent = this.total - 1;
    for (const total of this.block.querySelectorAll(".total")) total.textContent = this.total;
    this.fields.first.dataset.max = this.total - 1;
    this.fields.count.dataset.max = this.total;
    for (const part of ["first", "count"]) this.fields[part].value = range?.[part] ?? "";
    this.follow();
  }

  /** The range as it is written, null where it is none; left empty, and of a still method, it goes on to the end. */
  read() {
    const read = this.group.read((part, { first }) => (part === "first" ? 0 : this.total - first));
    return read && !this.moving ? { first: read.first, count: this.total - read.first } : read;
  }

  /** Make a range fit: what is too long shrinks, and then begins where it fits. Of one frame the first one counts. */
  fitted({ first, count }) {
    if (!this.moving) {
      const only = between(first, 0, this.total - 1);
      return { first: only, count: between(count, 1, this.total - only) };
    }
    const long = between(count, 2, this.total);
    return { first: between(first, 0, this.total - long), count: long };
  }

  /** Take what the fields, the method and the sample say. */
  follow() {
    const video = this.root.querySelector("video");
    if (this.clip?.video !== video) this.clip = video && new RangePlayback(video, this.rate, (frame) => this.point(frame));
    if (!video) return;
    const empty = this.fields.first.value === "" && this.fields.count.value === "";
    this.take(this.fitted(this.read() ?? this.shown ?? { first: 0, count: this.total }));
    this.kept = this.shown;
    if (empty) this.keep();
  }

  /** Show a range. */
  take(range) {
    this.shown = range;
    this.block.dataset.first = range.first;
    this.draw();
    this.clip.range = this.shown;
    const visible = this.block.checkVisibility?.() ?? true;
    if (this.moving && this.plays && visible) this.clip.play();
    else this.clip.pause();
    if (!this.clip.playing) this.clip.seek(this.shown.first);
    this.name();
  }

  keep() {
    this.kept = this.shown;
    this.group.write(this.shown);
  }

  name() {
    this.button.textContent = this.clip.playing ? "Pause" : "Play";
    this.button.hidden = !this.moving;
    this.track.classList.toggle("still", !this.moving);
  }

  draw() {
    const { first, count } = this.shown;
    const [total, last] = [this.total, first + count - 1];
    const place = (frame) => `${(100 * frame) / total}%`;
    const { range, first: begin, last: end } = this.handles;
    Object.assign(range.style, { left: place(first), width: place(count) });
    begin.style.left = place(this.moving ? first : first + 0.5);
    end.style.left = place(first + count);
    const seconds = (frames) => `${(frames / this.rate).toFixed(2)} s`;
    for (const [handle, value, most] of [[range, first, total - count], [begin, first, total - 1], [end, last, total - 1]]) {
      handle.setAttribute("aria-valuemax", most);
      handle.setAttribute("aria-valuenow", value);
      handle.setAttribute("aria-valuetext", `${value}, at ${seconds(value)}`);
    }
    begin.setAttribute("aria-label", this.moving ? PARTS.first : "Frame");
    this.readout.textContent = this.moving
      ? `${first}–${last} of ${total} frames, ${seconds(count)}`
      : `frame ${first} of ${total}, at ${seconds(first)}`;
  }

  /** Mark the frame that is on the screen. */
  point(frame) {
    this.now.style.left = `${(100 * (frame + 0.5)) / this.total}%`;
  }

  /** Move the range or one of its ends to begin or end with a frame, and show that one. */
  move(part, frame) {
    const { first, count } = this.shown;
    const end = first + count;
    if (part === "range") this.shown = { first: between(frame, 0, this.total - count), count };
    else if (part === "last") this.shown = this.fitted({ first, count: Math.max(frame, first) + 1 - first });
    else if (!this.moving) this.shown = this.fitted({ first: frame, count: this.total }); // a moving one then takes the rest
    else {
      const begin = between(frame, 0, end - 2);
      this.shown = { first: begin, count: end - begin };
    }
    this.keep();
    this.draw();
    this.clip.range = this.shown;
    this.clip.pause();
    this.clip.seek(part === "last" ? this.shown.first + this.shown.count - 1 : this.shown.first);
    this.form.dispatchEvent(new CustomEvent("crop"));
  }

  listen() {
    this.button.addEventListener("click", () => {
      this.plays = !this.clip.playing;
      if (this.plays) this.clip.play();
      else this.clip.pause();
    });
    for (const kind of ["play", "pause"]) {
      // These do not bubble, and the video may be another one later.
      this.root.addEventListener(kind, () => this.clip && this.name(), true);
    }
    this.track.addEventListener("pointerdown", (event) => this.press(event));
    this.track.addEventListener("pointermove", (event) => this.pull(event));
    for (const kind of ["pointerup", "pointercancel"]) this.track.addEventListener(kind, (event) => this.letGo(event));
    this.track.addEventListener("keydown", (event) => this.key(event));
    this.form.addEventListener("change", (event) => event.target.name === "method" && this.follow());
    window.addEventListener("pageshow", () => this.follow());
  }

  at(event) {
    const { left, width } = this.track.getBoundingClientRect();
    return ((event.clientX - left) / width) * this.total;
  }

  press(event) {
    if (event.button !== 0 || this.drag || !this.clip) return;
    event.preventDefault();
    const at = this.at(event);
    const { first, count } = this.shown;
    const near = this.moving && Math.abs(at - first - count) < Math.abs(at - first) ? "last" : "first";
    const part = event.target.dataset.part ?? near; // beside the range: the end that is nearer comes here
    this.drag = { part, id: event.pointerId, from: at, first, end: first + count, playing: this.clip.playing };
    this.track.setPointerCapture(event.pointerId);
    this.handles[part].focus({ preventScroll: true });
    if (!event.target.dataset.part) this.move(part, Math.floor(at));
  }

  pull(event) {
    if (event.pointerId !== this.drag?.id) return;
    const { part, from, first, end } = this.drag;
    const at = this.at(event);
    if (part === "last") this.move(part, Math.round(end + at - from) - 1);
    else this.move(part, Math.round(first + at - from));
  }

  letGo(event) {
    if (event.pointerId !== this.drag?.id) return;
    if (this.drag.playing) this.clip.play();
    this.drag = null;
  }

  key(event) {
    const { part } = event.target.dataset;
    let step = KEYS[event.key];
    if (!part || !step || event.altKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    if (event.ctrlKey) step *= 10;
    this.plays = false;
    const { first, count } = this.shown;
    this.move(part, between((part === "last" ? first + count - 1 : first) + step, 0, this.total - 1));
  }
}
