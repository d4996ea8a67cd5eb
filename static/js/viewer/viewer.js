// The viewer: the same pictures side by side, one upon the other (flip, slider), or tiled, always at the same scale and place.

import { divide } from "./dividers.js";
import { listen, listenToKeys } from "./pan_zoom.js";
import { fitting, picture, place } from "./stage.js";

const [SMALLEST, LARGEST] = [0.25, 16];
const KEYS = "Arrow keys move the pictures, plus and minus zoom, 0 fits them, 1 shows every pixel once, F flips.";

export class Viewer {
  constructor(root) {
    this.root = root;
    this.panes = root.querySelector(".panes");
    this.figures = [...this.panes.children];
    this.stages = this.figures.map((figure) => figure.querySelector(".stage"));
    this.pictures = this.stages.map((stage, index) => {
      const found = picture(stage, this.figures[index].querySelector("figcaption").firstElementChild?.textContent ?? "");
      stage.replaceChildren(found.image, found.tile);
      return found;
    });
    this.titles = [...root.querySelectorAll("[data-flip]")].map((button) => button.textContent);
    this.pictures.forEach((shown, index) => (shown.title = this.titles[index]));
    this.mode = root.dataset.view;
    this.tiles = Number(root.dataset.tiles);
    this.front = this.pictures.length - 1;
    this.dividers = null;
    this.at = { scale: 1, x: 0, y: 0 };
    this.fitted = true;
    this.build();
    this.listen();
    this.show(this.mode);
  }

  /** The stage on which pictures lie upon each other, and the steps; the other stages are the page's own. */
  build() {
    this.root.classList.add("live");
    this.panes.style.setProperty("--columns", this.figures.length);
    this.over = document.createElement("figure");
    this.over.className = "pane";
    this.overStage = document.createElement("div");
    this.overStage.className = "stage";
    this.overCaption = document.createElement("figcaption");
    this.over.append(this.overStage, this.overCaption);
    this.panes.append(this.over);
    this.panes.tabIndex = 0;
    this.panes.setAttribute("role", "group");
    this.panes.setAttribute("aria-label", `Pictures. ${KEYS}`);
    const template = this.root.querySelector(".steps-template");
    template?.replaceWith(template.content);
    this.steps = this.root.querySelector(".steps");
    this.root.querySelector(".tools").hidden = false;
    for (const link of this.root.querySelectorAll(".views a")) link.hidden = false;
  }

  listen() {
    const on = {
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (factor, x, y) => this.zoom(factor, x, y),
      one: () => this.zoom(1 / this.at.scale, 0, 0),
      fit: () => this.fit(),
      flip: () => this.flip(),
      focused: () => this.panes.contains(document.activeElement),
    };
    for (const stage of [...this.stages, this.overStage]) listen(stage, on);
    listenToKeys(this.panes, on);
    const zooms = { in: () => on.zoom(Math.SQRT2, 0, 0), out: () => on.zoom(Math.SQRT1_2, 0, 0), one: on.one, fit: on.fit };
    this.root.addEventListener("click", (event) => {
      const { view, zoom, tiles, flip } = event.target.dataset;
      if (event.target.matches("a[data-view]") && !event.ctrlKey && !event.metaKey && !event.shiftKey) {
        event.preventDefault();
        history.replaceState(history.state, "", event.target.href);
        this.show(view);
      } else if (zoom) zooms[zoom]();
      else if (tiles) this.show("tiled", Number(tiles));
      else if (flip) this.bring(Number(flip));
    });
    const hold = this.root.querySelector("[data-hold]");
    const press = () => this.draw(0);
    const release = () => this.draw();
    hold.addEventListener("pointerdown", press);
    for (const name of ["pointerup", "pointercancel", "pointerleave", "blur", "keyup"]) hold.addEventListener(name, release);
    hold.addEventListener("keydown", (event) => (event.key === " " || event.key === "Enter") && press());
    new ResizeObserver(() => (this.fitted ? this.fit() : this.draw())).observe(this.panes);
  }

  show(mode, tiles = this.tiles) {
    this.mode = mode;
    this.tiles = tiles;
    const over = mode === "flip" || mode === "slider";
    this.root.dataset.view = mode;
    this.root.classList.toggle("over", over);
    this.figures.forEach((figure) => (figure.hidden = over));
    this.over.hidden = !over;
    this.panes.hidden = mode === "steps";
    this.panes.classList.remove("tiled");
    if (this.steps) this.steps.hidden = mode !== "steps";
    this.pictures.forEach((shown, index) => {
      if (over) this.overStage.append(shown.image);
      else this.stages[index].append(shown.image, shown.tile);
      shown.image.style.visibility = "";
    });
    this.dividers?.remove();
    this.dividers = mode === "slider" ? divide(this.overStage, this.titles, () => this.draw()) : null;
    for (const link of this.root.querySelectorAll(".views a")) {
      if (link.dataset.view === mode) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
    for (const group of this.root.querySelectorAll("[data-for]")) group.hidden = !group.dataset.for.split(" ").includes(mode);
    for (const button of this.root.querySelectorAll("button[data-tiles]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.tiles) === tiles));
    }
    this.fit();
  }

  get room() {
    const stage = this.over.hidden ? this.stages[0] : this.overStage;
    return { width: stage.clientWidth, height: stage.clientHeight };
  }

  get times() {
    return this.mode === "tiled" ? this.tiles : 1;
  }

  fit() {
    this.fitted = true;
    this.at = { scale: fitting(this.pictures, this.room, this.times) || 1, x: 0, y: 0 };
    this.draw();
  }

  zoom(factor, x, y) {
    const smallest = Math.min(SMALLEST, fitting(this.pictures, this.room, this.times));
    const scale = Math.min(Math.max(this.at.scale * factor, smallest), LARGEST);
    // What lies under (x, y) stays there.
    this.at.x += x / this.at.scale - x / scale;
    this.at.y += y / this.at.scale - y / scale;
    this.at.scale = scale;
    this.pan(0, 0);
  }

  pan(dx, dy) {
    const wide = (Math.max(...this.pictures.map(({ width }) => width)) * this.times) / 2;
    const high = (Math.max(...this.pictures.map(({ height }) => height)) * this.times) / 2;
    this.at.x = Math.min(Math.max(this.at.x - dx / this.at.scale, -wide), wide);
    this.at.y = Math.min(Math.max(this.at.y - dy / this.at.scale, -high), high);
    this.fitted = false;
    this.draw();
  }

  bring(index) {
    this.front = index;
    this.draw();
  }

  flip() {
    if (this.mode !== "flip") this.show("flip");
    this.bring((this.front + 1) % this.pictures.length);
  }

  draw(front = this.front) {
    const { room } = this;
    const splits = [0, ...(this.dividers?.splits ?? []), 1];
    this.pictures.forEach((shown, index) => {
      const [from, to] = this.mode === "slider" ? [splits[index], splits[index + 1]] : [0, 1];
      place(shown, room, this.at, this.times, from, to);
      if (this.mode === "flip") shown.image.style.visibility = index === front ? "" : "hidden";
    });
    for (const button of this.root.querySelectorAll("[data-flip]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.flip) === front));
    }
    this.overCaption.textContent = this.mode === "slider" ? this.titles.join(" | ") : this.titles[front];
    this.root.querySelector(".scale").textContent = `${Math.round(this.at.scale * 100)} %`;
    // At rest one finger scrolls the page; once zoomed or moved it pans the pictures.
    for (const stage of [...this.stages, this.overStage]) stage.style.touchAction = this.fitted ? "pan-y" : "none";
  }
}
