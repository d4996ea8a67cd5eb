// Films in step: one clock, in frames, for all of them. Each loops by itself; those ahead wait for the slowest.

import { LoopingVideo } from "./looping_video.js";

const [AHEAD, FAR] = [0.5, 2]; // frames
const SLOWED = 0.8; // speed of a film that is a little ahead
const KEYS = "Space plays and pauses, comma and full stop step by a frame.";

export class Player {
  /** `root` is a viewer that holds videos and a `.player` with the controls. */
  constructor(root) {
    this.root = root;
    this.bar = root.querySelector(".player");
    this.scrubber = this.bar.querySelector("input");
    this.panes = root.querySelector(".panes");
    this.films = [...root.querySelectorAll("video")].map((video) => new LoopingVideo(video));
    this.clock = this.films.at(-1);
    this.wanted = false;
    this.seen = true;
    this.ticking = 0;
    this.panes.setAttribute("aria-label", `${this.panes.getAttribute("aria-label") ?? ""} ${KEYS}`.trim());
    this.listen();
    this.show();
    const calm = matchMedia("(prefers-reduced-motion: reduce)");
    calm.addEventListener("change", () => calm.matches && this.pause());
    if (!calm.matches) this.play();
  }

  listen() {
    this.bar.addEventListener("click", ({ target }) => {
      const { step, play } = target.closest("button")?.dataset ?? {};
      if (step) this.step(Number(step));
      else if (play !== undefined) this.toggle();
    });
    this.scrubber.addEventListener("input", () => this.go(this.scrubber.valueAsNumber - 1));
    this.root.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || this.bar.hidden) return;
      if (event.key === ",") this.step(-1);
      else if (event.key === ".") this.step(1);
      else if (event.key === " " && [this.panes, this.scrubber].includes(event.target)) this.toggle();
      else return;
      event.preventDefault();
    });
    new IntersectionObserver(([entry]) => {
      this.seen = entry.isIntersecting;
      this.run();
    }).observe(this.panes);
    // What plays on in the background is not counted; videos that cannot be played keep no others waiting.
    document.addEventListener("visibilitychange", () => !document.hidden && this.running && this.place(this.position));
    for (const film of this.films) {
      film.video.addEventListener("error", () => this.leave(film));
      film.video.lastElementChild.addEventListener("error", () => this.leave(film));
    }
  }

  leave(film) {
    this.films = this.films.filter((other) => other !== film);
    this.clock = this.films.at(-1) ?? this.clock;
    this.root.querySelector(".unplayable").hidden = false;
  }

  get running() {
    return this.wanted && this.seen;
  }

  /** The whole frames that the clock's film has shown. */
  get position() {
    return Math.floor(this.clock.position);
  }

  toggle() {
    if (this.wanted) this.pause();
    else this.play();
  }

  play() {
    this.wanted = true;
    this.run();
  }

  pause() {
    this.wanted = false;
    this.run();
    this.place(this.position);
  }

  step(by) {
    this.go(this.position + by);
  }

  /** Stand still at a position. */
  go(position) {
    this.wanted = false;
    this.run();
    this.place(position);
  }

  place(position) {
    for (const film of this.films) film.go(position);
    this.show();
  }

  /** Let the videos play, or not, as is wanted. */
  run() {
    cancelAnimationFrame(this.ticking);
    for (const { video } of this.films) {
      if (!this.running) video.pause();
      else video.play().catch((error) => error.name === "NotAllowedError" && this.pause());
    }
    if (this.running) this.tick();
    this.bar.classList.toggle("playing", this.wanted);
    this.bar.querySelector("[data-play]").setAttribute("aria-label", this.wanted ? "Pause" : "Play");
  }

  tick() {
    const positions = this.films.map((film) => film.position);
    const slowest = Math.min(...positions);
    this.films.forEach((film, index) => {
      const ahead = positions[index] - slowest;
      film.pace(ahead > FAR ? 0 : ahead > AHEAD ? this.clock.rate * SLOWED : this.clock.rate);
    });
    this.show();
    this.ticking = requestAnimationFrame(() => this.tick());
  }

  show() {
    const number = this.clock.frame(this.position) + 1;
    if (this.shown === number) return;
    this.shown = number;
    this.scrubber.value = number;
    this.scrubber.setAttribute("aria-valuetext", `${number} of ${this.clock.count}`);
    this.bar.querySelector("output").textContent = `${number} / ${this.clock.count}`;
  }
}
