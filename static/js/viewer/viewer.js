// The viewer: the same pictures side by side, one upon the other (flip, slider), or tiled, always at the same scale and
// place.

import { append, find, findAll, seek } from "../lib/dom.js";
import { observe } from "../lib/lifetime.js";
import { Dividers } from "./dividers.js";
import { fit, pan, zoom } from "./geometry.js";
import { listen, listenToKeys } from "./pan_zoom.js";
import { place, takePicture } from "./stage.js";

/** @import { Movable } from "./pan_zoom.js" */

const KEYS = "Arrow keys move the pictures, plus and minus zoom, 0 fits them, 1 shows every pixel once, F flips.";

export class Viewer {
  /** @type {Dividers | null} */
  dividers = null;
  at = { scale: 1, x: 0, y: 0 };
  fitted = true; // whether it follows the size of its stages

  /**
   * @param {HTMLElement} root
   * @param {AbortSignal} signal
   */
  constructor(root, signal) {
    this.root = root;
    this.panes = find(root, ".panes");
    this.figures = findAll(this.panes, ":scope > *");
    this.titles = findAll(root, "[data-flip]").map((button) => button.textContent);
    this.stages = this.figures.map((figure) => find(figure, ".stage"));
    this.pictures = this.stages.map((stage, index) => {
      const picture = takePicture(stage, this.titles[index] ?? "");
      stage.replaceChildren(picture.image, picture.tile);
      return picture;
    });
    this.mode = root.dataset.view ?? "side";
    this.tiles = Number(root.dataset.tiles);
    this.front = this.pictures.length - 1;
    /** The stage on which pictures lie upon each other; the others are the page's own. */
    this.over = document.createElement("figure");
    this.over.className = "pane";
    this.overStage = append("div", { class: "stage" }, this.over);
    this.overCaption = append("figcaption", {}, this.over);
    this.steps = this.build();
    this.listen();
    observe(new ResizeObserver(() => (this.fitted ? this.fit() : this.draw())), this.panes, signal);
    this.show(this.mode);
  }

  /** Make the page a live viewer, with the steps, if there are any. */
  build() {
    this.root.classList.add("live");
    this.panes.style.setProperty("--columns", String(this.figures.length));
    this.panes.append(this.over);
    this.panes.tabIndex = 0;
    this.panes.setAttribute("role", "group");
    this.panes.setAttribute("aria-label", `Pictures. ${KEYS}`);
    const template = seek(this.root, ".steps-template", HTMLTemplateElement);
    template?.replaceWith(template.content);
    find(this.root, ".tools").hidden = false;
    for (const link of findAll(this.root, ".views a")) link.hidden = false;
    return seek(this.root, ".steps");
  }

  listen() {
    /** @type {Movable} */
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
    /** @type {Record<string, () => void>} */
    const zooms = {
      in: () => on.zoom(Math.SQRT2, 0, 0),
      out: () => on.zoom(Math.SQRT1_2, 0, 0),
      one: on.one,
      fit: on.fit,
    };
    this.root.addEventListener("click", (event) => {
      if (!(event.target instanceof HTMLElement)) return;
      const link = event.target instanceof HTMLAnchorElement ? event.target : null;
      const { view, zoom: way, tiles, flip } = event.target.dataset;
      if (link && view !== undefined && !event.ctrlKey && !event.metaKey && !event.shiftKey) {
        event.preventDefault();
        history.replaceState(history.state, "", link.href);
        this.show(view);
      } else if (way) zooms[way]?.();
      else if (tiles) this.show("tiled", Number(tiles));
      else if (flip) this.bring(Number(flip));
    });
    this.offerToHold(find(this.root, "[data-hold]"));
  }

  /**
   * Show the sample for as long as a button is held.
   *
   * @param {HTMLElement} button
   */
  offerToHold(button) {
    const press = () => this.draw(0);
    const release = () => this.draw();
    button.addEventListener("pointerdown", press);
    for (const name of ["pointerup", "pointercancel", "pointerleave", "blur", "keyup"]) {
      button.addEventListener(name, release);
    }
    button.addEventListener("keydown", ({ key }) => (key === " " || key === "Enter") && press());
  }

  /** @param {string} mode */
  show(mode, tiles = this.tiles) {
    this.mode = mode;
    this.tiles = tiles;
    const over = mode === "flip" || mode === "slider";
    this.root.dataset.view = mode;
    this.root.classList.toggle("over", over);
    for (const figure of this.figures) figure.hidden = over;
    this.over.hidden = !over;
    this.panes.hidden = mode === "steps";
    this.panes.classList.remove("tiled");
    if (this.steps) this.steps.hidden = mode !== "steps";
    this.pictures.forEach((shown, index) => {
      if (over) this.overStage.append(shown.image);
      else this.stages[index]?.append(shown.image, shown.tile);
      shown.image.style.visibility = "";
    });
    this.dividers?.remove();
    this.dividers = mode === "slider" ? new Dividers(this.overStage, this.titles, () => this.draw()) : null;
    this.mark();
    this.fit();
  }

  /** Mark which view is on, and offer the tools that are of use in it. */
  mark() {
    const { mode, root, tiles } = this;
    for (const link of findAll(root, ".views a")) {
      if (link.dataset.view === mode) link.setAttribute("aria-current", "true");
      else link.removeAttribute("aria-current");
    }
    for (const group of findAll(root, "[data-for]")) group.hidden = !group.dataset.for?.split(" ").includes(mode);
    for (const button of findAll(root, "button[data-tiles]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.tiles) === tiles));
    }
  }

  get room() {
    const stage = (this.over.hidden ? this.stages[0] : null) ?? this.overStage;
    return { width: stage.clientWidth, height: stage.clientHeight };
  }

  get times() {
    return this.mode === "tiled" ? this.tiles : 1;
  }

  /** The scale at which all is seen. */
  get whole() {
    return fit(this.pictures, this.room, this.times);
  }

  fit() {
    this.fitted = true;
    this.at = { scale: this.whole || 1, x: 0, y: 0 };
    this.draw();
  }

  /**
   * @param {number} factor
   * @param {number} x from the stage's centre, in screen pixels
   * @param {number} y
   */
  zoom(factor, x, y) {
    this.at = zoom(this.at, factor, x, y, this.whole);
    this.pan(0, 0);
  }

  /**
   * @param {number} dx screen pixels
   * @param {number} dy
   */
  pan(dx, dy) {
    this.at = pan(this.at, dx, dy, this.pictures, this.times);
    this.fitted = false;
    this.draw();
  }

  /** @param {number} index */
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
    const borders = [0, ...(this.dividers?.splits ?? []), 1];
    this.pictures.forEach((shown, index) => {
      const [from, to] = this.mode === "slider" ? borders.slice(index, index + 2) : [0, 1];
      place(shown, room, this.at, this.times, from, to);
      if (this.mode === "flip") shown.image.style.visibility = index === front ? "" : "hidden";
    });
    for (const button of findAll(this.root, "[data-flip]")) {
      button.setAttribute("aria-pressed", String(Number(button.dataset.flip) === front));
    }
    this.overCaption.textContent = (this.mode === "slider" ? this.titles.join(" | ") : this.titles[front]) ?? "";
    find(this.root, ".scale").textContent = `${Math.round(this.at.scale * 100)} %`;
    // At rest one finger scrolls the page; once zoomed or moved it pans the pictures.
    for (const stage of [...this.stages, this.overStage]) stage.style.touchAction = this.fitted ? "pan-y" : "none";
  }
}
