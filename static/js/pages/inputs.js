// The inputs of a sample's page: editors of each one's crop and time range, and for further ones what is chosen or
// uploaded.

import { Crop } from "../crop/crop.js";
import { TimeRange } from "../crop/time_range.js";
import { ask, refusalOf } from "../lib/answers.js";
import { append, find, findAll, seek } from "../lib/dom.js";
import { start } from "../lib/start.js";

/**
 * @typedef {object} Sample
 * @property {string} id
 * @property {string} version of its pictures
 * @property {number} width
 * @property {number} height
 * @property {number} frames
 * @property {number | null} rate
 */

const SMALL = 256; // pixels of a thumbnail's longer side, as on the home page
const LARGE = 2048; // and of the picture that is cropped
const SUGGESTED = 512; // pixels, at most, of the sides of an uploaded photograph's first crop

/** @param {string} sample */
const recordOf = (sample) => `/api/v1/samples/${encodeURIComponent(sample)}`;

/**
 * @param {string} sample
 * @param {number} size
 * @param {string} version of its pictures
 */
const imageOf = (sample, size, version) => `${recordOf(sample)}/image?size=${size}&v=${version}`;

let uploads = 0;

/**
 * Nothing is run while a photograph is on its way: it would be run without that one.
 *
 * @param {number} change
 */
function countUploads(change) {
  uploads += change;
  find(document, "button.main", HTMLButtonElement).disabled = uploads > 0;
}

class Further {
  /** @type {HTMLImageElement[]} */
  thumbnails = [];

  /**
   * @param {HTMLElement} root
   * @param {AbortSignal} signal
   */
  constructor(root, signal) {
    this.root = root;
    this.crop = new Crop(root, signal);
    this.time = new TimeRange(root, signal);
    this.legend = find(root, "legend");
    this.select = find(root, "select", HTMLSelectElement);
    this.status = find(root, ".sending");
    this.status.tabIndex = -1;
    this.shown = this.select.value;
    find(root, "[name=show]").remove();
    this.wall = document.createElement("div");
    this.offerThumbnails();
    this.offerUpload(find(root, "input[type=file]", HTMLInputElement), find(root, ".upload", HTMLButtonElement));
    this.select.addEventListener("change", () => this.follow());
    window.addEventListener("pageshow", () => this.follow(true), { signal });
    const details = root.closest("details");
    if (details) this.offerToLeave(details);
  }

  /**
   * Show what is chosen.
   *
   * @param {boolean} kept whether the numbers of crop and time range are its own already
   */
  follow(kept = false) {
    const sample = this.select.value;
    if (sample !== this.shown) {
      this.shown = sample;
      const {
        width,
        height,
        frames,
        rate,
        version = "",
        crop = "",
        ...thanks
      } = this.select.selectedOptions[0]?.dataset ?? {};
      const video = Number(frames) > 1 ? `${recordOf(sample)}/video?v=${version}` : "";
      this.thank(video ? "Clip" : "Photograph", thanks);
      for (const part of findAll(this.root, ".ground, .numbers")) part.hidden = !sample;
      const before = this.crop.read();
      const size = { width: Number(width), height: Number(height) };
      const picture = { address: imageOf(sample, LARGE, version), video, title: this.legend.textContent, ...size };
      if (sample) this.crop.show(picture, crop);
      this.time.show({ frames: Number(frames ?? 1), rate: Number(rate ?? 0) }, kept ? this.time.read() : null);
      if (kept && sample && before) this.crop.write(before);
    }
    for (const image of this.thumbnails) image.classList.toggle("current", image.dataset.sample === sample);
  }

  /**
   * Let an optional input be left out: closed, it is not taken.
   *
   * @param {HTMLDetailsElement} details
   */
  offerToLeave(details) {
    const summary = find(details, "summary");
    const name = () => {
      const leave = `Leave the ${this.legend.textContent.toLowerCase()} out`;
      summary.textContent = details.open ? leave : "Add another sample";
    };
    details.addEventListener("toggle", () => {
      if (!details.open) this.choose("");
      name();
    });
    name();
  }

  /**
   * @param {string} kind
   * @param {{ credit?: string, licence?: string, url?: string }} thanks
   */
  thank(kind, { credit, licence, url }) {
    const line = find(this.root, ".credit");
    line.hidden = !credit;
    if (!credit) return;
    const link = Object.assign(document.createElement("a"), { href: url, rel: "license", textContent: licence });
    line.replaceChildren(`${kind}: ${credit}, `, link);
  }

  /** @param {string} sample */
  choose(sample) {
    if (this.select.value === sample) return;
    this.select.value = sample;
    this.select.dispatchEvent(new Event("input", { bubbles: true }));
    this.select.dispatchEvent(new Event("change", { bubbles: true }));
  }

  /** The same choice for the pointer; keyboards and screen readers have the select. */
  offerThumbnails() {
    this.wall.className = "thumbnails";
    this.wall.setAttribute("aria-hidden", "true");
    for (const option of this.select.options) if (option.value) this.addThumbnail(option);
    this.wall.addEventListener("click", ({ target }) => {
      const sample = target instanceof HTMLElement && target.dataset.sample;
      if (sample) this.choose(sample);
    });
    find(this.root, ".chosen").after(this.wall);
    this.follow();
  }

  /** @param {HTMLOptionElement} option */
  addThumbnail({ value, textContent, dataset }) {
    const attributes = { loading: "lazy", alt: "", title: textContent, "data-sample": value };
    const image = append("img", attributes, this.wall);
    image.src = imageOf(value, SMALL, dataset.version ?? "");
    this.thumbnails.push(image);
  }

  /**
   * @param {HTMLInputElement} input
   * @param {HTMLButtonElement} button
   */
  offerUpload(input, button) {
    const line = /** @type {HTMLElement} */ (input.closest(".file"));
    line.hidden = true;
    button.hidden = false;
    button.addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
      const file = input.files?.[0];
      if (!file) return;
      input.value = "";
      start(() => this.send(file, button));
    });
  }

  /**
   * @param {File} file
   * @param {HTMLButtonElement} button
   */
  async send(file, button) {
    const body = new FormData();
    body.append("file", file);
    button.disabled = true;
    countUploads(1);
    this.say("Sending …");
    try {
      this.offer(/** @type {Sample} */ (await ask("/api/v1/samples", { method: "POST", body })));
      this.say("");
    } catch (error) {
      this.say(refusalOf(error).message, true);
    } finally {
      button.disabled = false;
      countUploads(-1);
    }
  }

  /**
   * Say how the upload goes; who waits for it is led to a refusal, who has gone on to other things is not.
   *
   * @param {string} text
   * @param {boolean} refused
   */
  say(text, refused = false) {
    this.status.textContent = text;
    this.status.classList.toggle("error", refused);
    this.status.classList.toggle("hint", !refused);
    const { activeElement } = document;
    if (refused && (activeElement === document.body || this.root.contains(activeElement))) this.status.focus();
  }

  /** @param {Sample} sample */
  offer({ id, version, width, height, frames, rate }) {
    const option = new Option(frames > 1 ? "Your clip" : "Your photograph", id);
    const [wide, high] = [Math.min(width, SUGGESTED), Math.min(height, SUGGESTED)];
    const crop = [Math.floor((width - wide) / 2), Math.floor((height - high) / 2), wide, high].join(",");
    Object.assign(option.dataset, { width, height, frames, rate, version, crop });
    this.select.add(option);
    this.addThumbnail(option);
    this.choose(id);
  }
}

const roots = findAll(document, "[data-input]");
const legends = roots.map((root) => seek(root, ".several, legend:not(:has(*))"));

/** Call the inputs as the chosen method does, where it has a name for each. */
function nameInputs() {
  const { titles } = find(document, "[name=method]:checked").dataset;
  legends.forEach((legend, index) => {
    if (!legend) return;
    legend.dataset.title ??= legend.textContent;
    legend.textContent = titles?.split("|")[index] ?? legend.dataset.title;
  });
}

const { signal } = new AbortController(); // the inputs stay for as long as the page does
for (const radio of findAll(document, "[name=method]")) radio.addEventListener("change", nameInputs);
window.addEventListener("pageshow", nameInputs);
nameInputs();

for (const root of roots) {
  if (root.dataset.input !== "1") {
    new Further(root, signal);
    continue;
  }
  new Crop(root, signal);
  new TimeRange(root, signal);
}
find(document, "#experiment > .visually-hidden").remove(); // stood in for the main button before those that show samples
