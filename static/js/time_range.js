// The time range of a clip. The two numeric fields are the truth: the reel shows them, and dragging its ends writes to them
// and shows their frames. Of a clip, a still method takes the one frame at the first end. Changes are "crop" events.

import { Clip, REDUCED } from "./clip.js";

const KEYS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -Infinity, End: Infinity };
const PARTS = { range: "Time range", first: "First frame", last: "Last frame" };
const between = (value, low, high) => Math.min(Math.max(value, low), high);

function element(name, attributes, parent) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

/** The editor of one input's time range; `root` holds the picture's frame and the fields. */
export class TimeRange {
  constructor(root) {
    this.root = root;
    this.form = root.closest("form");
    this.block = root.querySelector(".time");
    this.fields = { first: root.querySelector("[data-time=first]"), count: root.querySelector("[data-time=count]") };
    this.plays = !REDUCED.matches;
    this.drag = null;
    /** @type {Clip | undefined} */
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
    Object.assign(this.fields.first, { max: this.total - 1, value: range?.first ?? "" });
    Object.assign(this.fields.count, { max: this.total, value: range?.count ?? "" });
    this.follow();
  }

  read() {
    const { first, count } = this.fields;
    const begin = first.value === "" ? 0 : Math.round(Number(first.value));
    return { first: begin, count: count.value === "" ? this.total - begin : Math.round(Number(count.value)) };
  }

  fitted({ first, count }) {
    const least = this.moving ? 2 : 1;
    const begin = between(first, 0, this.total - least);
    return { first: begin, count: between(count, least, this.total - begin) };
  }

  /** Take what the fields, the method and the sample say. */
  follow() {
    const video = this.root.querySelector("video");
    if (this.clip?.video !== video) this.clip = video && new Clip(video, this.rate, (frame) => this.point(frame));
    if (!video) return;
    const empty = this.fields.first.value === "" && this.fields.count.value === "";
    this.shown = this.fitted(this.read());
    if (empty) this.keep();
    this.draw();
    this.clip.range = this.shown;
    const visible = this.block.checkVisibility?.() ?? true;
    if (this.moving && this.plays && visible) this.clip.play();
    else this.clip.pause();
    if (!this.clip.playing) this.clip.seek(this.shown.first);
    this.name();
  }

  keep() {
    this.fields.first.value = this.shown.first;
    this.fields.count.value = this.shown.count;
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
    for (const field of Object.values(this.fields)) {
      field.addEventListener("input", () => this.follow());
      field.addEventListener("change", () => {
        this.keep();
        this.form.dispatchEvent(new CustomEvent("crop"));
      });
    }
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
