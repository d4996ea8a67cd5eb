// The inputs of a sample's page: editors of each one's crop and time range, and for further ones what is chosen or uploaded.

import { ask } from "../lib/answers.js";
import { Crop } from "../crop/crop.js";
import { start } from "../lib/start.js";
import { TimeRange } from "../crop/time_range.js";

const SMALL = 256; // pixels of a thumbnail's longer side, as on the home page
const record = (sample) => `/api/v1/samples/${encodeURIComponent(sample)}`;
const address = (sample, size) => `${record(sample)}/image?size=${size}`;

let uploads = 0;

/** Nothing is run while a photograph is on its way: it would be run without that one. */
function count(change) {
  uploads += change;
  document.querySelector("button.main").disabled = uploads > 0;
}

class Further {
  constructor(root) {
    this.root = root;
    this.crop = new Crop(root);
    this.time = new TimeRange(root);
    this.select = root.querySelector("select");
    this.status = root.querySelector(".sending");
    this.status.tabIndex = -1;
    this.shown = this.select.value;
    root.querySelector("[name=show]").remove();
    this.offerThumbnails();
    this.offerUpload(root.querySelector("input[type=file]"), root.querySelector(".upload"));
    this.select.addEventListener("change", () => this.follow());
    window.addEventListener("pageshow", () => this.follow(true));
    // Closed, an optional one is not taken.
    const details = root.closest("details");
    details?.addEventListener("toggle", () => {
      if (!details.open) this.choose("");
      this.offerToLeave(details);
    });
    if (details) this.offerToLeave(details);
  }

  /** Show what is chosen; `kept` says that the numbers of crop and time range are its own already. */
  follow(kept = false) {
    const sample = this.select.value;
    if (sample !== this.shown) {
      this.shown = sample;
      const { width, height, frames, rate, crop, ...thanks } = this.select.selectedOptions[0].dataset;
      const video = Number(frames) > 1 ? `${record(sample)}/video` : "";
      this.thank({ ...thanks, kind: video ? "Clip" : "Photograph" });
      for (const part of this.root.querySelectorAll(".ground, .numbers")) part.hidden = !sample;
      const before = this.crop.read();
      const shown = { address: address(sample, 2048), video, width: Number(width), height: Number(height), crop };
      if (sample) this.crop.show({ ...shown, title: this.root.querySelector("legend").textContent });
      this.time.show({ frames: frames ?? 1, rate: rate ?? 0 }, kept ? this.time.read() : null);
      if (kept && sample && before) this.crop.write(before);
    }
    for (const image of this.thumbnails) image.classList.toggle("current", image.dataset.sample === sample);
  }

  offerToLeave(details) {
    const name = this.root.querySelector("legend").textContent.toLowerCase();
    details.querySelector("summary").textContent = details.open ? `Leave the ${name} out` : "Add another sample";
  }

  thank({ kind, credit, licence, url }) {
    const line = this.root.querySelector(".credit");
    line.hidden = !credit;
    if (!credit) return;
    const link = Object.assign(document.createElement("a"), { href: url, rel: "license", textContent: licence });
    line.replaceChildren(`${kind}: ${credit}, `, link);
  }

  choose(sample) {
    if (this.select.value === sample) return;
    this.select.value = sample;
    this.select.dispatchEvent(new Event("input", { bubbles: true }));
    this.select.dispatchEvent(new Event("change", { bubbles: true }));
  }

  /** The same choice for the pointer; keyboards and screen readers have the select. */
  offerThumbnails() {
    this.wall = document.createElement("div");
    this.wall.className = "thumbnails";
    this.wall.setAttribute("aria-hidden", "true");
    this.thumbnails = [];
    for (const option of this.select.options) if (option.value) this.addThumbnail(option);
    this.wall.addEventListener("click", ({ target }) => target.dataset.sample && this.choose(target.dataset.sample));
    this.root.querySelector(".chosen").after(this.wall);
    this.follow();
  }

  addThumbnail({ value, textContent }) {
    const image = document.createElement("img");
    Object.assign(image, { loading: "lazy", alt: "", title: textContent, src: address(value, SMALL) });
    image.dataset.sample = value;
    this.thumbnails.push(image);
    this.wall.append(image);
  }

  offerUpload(input, button) {
    input.closest(".file").hidden = true;
    button.hidden = false;
    button.addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
      if (input.files.length) start(() => this.send(input, button));
    });
  }

  async send(input, button) {
    const body = new FormData();
    body.append("file", input.files[0]);
    input.value = "";
    button.disabled = true;
    count(1);
    this.tell("Sending …");
    try {
      this.offer(await ask("/api/v1/samples", { method: "POST", body }));
      this.tell("");
    } catch (refusal) {
      this.tell(refusal.message, true);
    }
    button.disabled = false;
    count(-1);
  }

  /** Say how the upload goes; who waits for it is led to a refusal, who has gone on to other things is not. */
  tell(text, refused = false) {
    this.status.textContent = text;
    this.status.classList.toggle("error", refused);
    this.status.classList.toggle("hint", !refused);
    const { activeElement } = document;
    if (refused && (activeElement === document.body || this.root.contains(activeElement))) this.status.focus();
  }

  offer({ id, width, height, frames, rate }) {
    const option = new Option(frames > 1 ? "Your clip" : "Your photograph", id);
    const [wide, high] = [Math.min(width, 512), Math.min(height, 512)];
    const crop = [Math.floor((width - wide) / 2), Math.floor((height - high) / 2), wide, high].join(",");
    Object.assign(option.dataset, { width, height, frames, rate, crop });
    this.select.add(option);
    this.addThumbnail(option);
    this.choose(id);
  }
}

/** Call the inputs as the chosen method does, where it has a name for each. */
function nameInputs() {
  const { titles } = document.querySelector("[name=method]:checked").dataset;
  for (const [index, legend] of legends.entries()) {
    legend.dataset.title ??= legend.textContent;
    legend.textContent = titles?.split("|")[index] ?? legend.dataset.title;
  }
}

const legends = [...document.querySelectorAll("[data-input]")].map((root) => root.querySelector(".several, legend:not(:has(*))"));
for (const radio of document.querySelectorAll("[name=method]")) radio.addEventListener("change", nameInputs);
window.addEventListener("pageshow", nameInputs);
nameInputs();

for (const root of document.querySelectorAll("[data-input]")) {
  if (root.dataset.input !== "1") {
    new Further(root);
    continue;
  }
  new Crop(root);
  new TimeRange(root);
}
document.querySelector("#experiment > .visually-hidden").remove(); // stood in for the main button before those that show samples
