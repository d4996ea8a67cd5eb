// Playback of videos in step: one clock, in frames, for all of them. Each loops by itself; those ahead wait for the
// slowest.

import { find, findAll } from "../lib/dom.js";
import { observe } from "../lib/lifetime.js";
import { LoopingVideo } from "./looping_video.js";
import { pace } from "./pacing.js";

const KEYS = "Space plays and pauses, comma and full stop step by a frame.";

export class Player {
  on = false; // whether the videos are to play, seen or not
  seen = true;
  ticking = 0;
  shown = 0; // number of the frame that is on the screen

  /**
   * @param {HTMLElement} root a viewer that holds videos and a `.player` with the controls
   * @param {AbortSignal} signal
   */
  constructor(root, signal) {
    this.root = root;
    this.bar = find(root, ".player");
    this.scrubber = find(this.bar, "input", HTMLInputElement);
    this.panes = find(root, ".panes");
    this.videos = findAll(root, "video", HTMLVideoElement).map((video) => new LoopingVideo(video));
    this.clock = /** @type {LoopingVideo} */ (this.videos.at(-1));
    this.panes.setAttribute("aria-label", `${this.panes.getAttribute("aria-label") ?? ""} ${KEYS}`.trim());
    this.listen();
    this.follow(signal);
    this.show();
    const calm = matchMedia("(prefers-reduced-motion: reduce)");
    calm.addEventListener("change", () => calm.matches && this.pause(), { signal });
    if (!calm.matches) this.play();
  }

  listen() {
    this.bar.addEventListener("click", ({ target }) => {
      const button = target instanceof Element ? target.closest("button") : null;
      const { step, play } = button?.dataset ?? {};
      if (step) this.step(Number(step));
      else if (play !== undefined) this.toggle();
    });
    this.scrubber.addEventListener("input", () => this.go(this.scrubber.valueAsNumber - 1));
    this.root.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || this.bar.hidden) return;
      if (event.key === ",") this.step(-1);
      else if (event.key === ".") this.step(1);
      else if (event.key === " " && (event.target === this.panes || event.target === this.scrubber)) this.toggle();
      else return;
      event.preventDefault();
    });
  }

  /**
   * Follow whether the videos are seen, and whether they can be played.
   *
   * @param {AbortSignal} signal
   */
  follow(signal) {
    const notice = (/** @type {IntersectionObserverEntry[]} */ [entry]) => {
      this.seen = entry?.isIntersecting ?? this.seen;
      this.run();
    };
    observe(new IntersectionObserver(notice), this.panes, signal);
    // What plays on in the background is not counted.
    const comeBack = () => !document.hidden && this.running && this.place(this.position);
    document.addEventListener("visibilitychange", comeBack, { signal });
    signal.addEventListener("abort", () => cancelAnimationFrame(this.ticking), { once: true });
    for (const each of this.videos) {
      each.video.addEventListener("error", () => this.leave(each));
      each.video.lastElementChild?.addEventListener("error", () => this.leave(each));
    }
  }

  /**
   * Go on without a video that cannot be played, which keeps no others waiting.
   *
   * @param {LoopingVideo} video
   */
  leave(video) {
    this.videos = this.videos.filter((other) => other !== video);
    this.clock = this.videos.at(-1) ?? this.clock;
    find(this.root, ".unplayable").hidden = false;
  }

  get running() {
    return this.on && this.seen;
  }

  /** The whole frames that the clock's video has shown. */
  get position() {
    return Math.floor(this.clock.position);
  }

  toggle() {
    if (this.on) this.pause();
    else this.play();
  }

  play() {
    this.on = true;
    this.run();
  }

  pause() {
    this.on = false;
    this.run();
    this.place(this.position);
  }

  /** @param {number} by frames */
  step(by) {
    this.go(this.position + by);
  }

  /**
   * Stand still at a position.
   *
   * @param {number} position
   */
  go(position) {
    this.on = false;
    this.run();
    this.place(position);
  }

  /** @param {number} position */
  place(position) {
    for (const video of this.videos) video.go(position);
    this.show();
  }

  /** Let the videos play, or not. */
  run() {
    cancelAnimationFrame(this.ticking);
    for (const { video } of this.videos) {
      if (!this.running) video.pause();
      else {
        video.play().catch((error) => {
          if (error instanceof DOMException && error.name === "NotAllowedError") this.pause();
        });
      }
    }
    if (this.running) this.tick();
    this.bar.classList.toggle("playing", this.on);
    find(this.bar, "[data-play]").setAttribute("aria-label", this.on ? "Pause" : "Play");
  }

  tick() {
    const { rate } = this.clock;
    const positions = this.videos.map((video) => video.position);
    const paces = pace(positions, rate);
    this.videos.forEach((video, index) => video.pace(paces[index] ?? rate));
    this.show();
    this.ticking = requestAnimationFrame(() => this.tick());
  }

  show() {
    const number = this.clock.frame(this.position) + 1;
    if (this.shown === number) return;
    this.shown = number;
    this.scrubber.value = String(number);
    this.scrubber.setAttribute("aria-valuetext", `${number} of ${this.clock.count}`);
    find(this.bar, "output").textContent = `${number} / ${this.clock.count}`;
  }
}
