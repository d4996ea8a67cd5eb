// The parameters beside the photograph: sizes that follow the crop, new seeds, and an address that keeps all of it.

import { parse } from "../crop/rectangle.js";
import { queryOf, shorten } from "../lib/address.js";
import { find, findAll, seek } from "../lib/dom.js";

/** @import { Field } from "../lib/address.js" */
/** @typedef {HTMLInputElement | HTMLSelectElement} Control */

const SEEDS = 1_000_000;
const PAUSE = 250; // milliseconds without a change
const LEFT_OUT = ["sample", "press", "show"]; // the page's own sample is its address's path
const form = find(document, "#experiment", HTMLFormElement);
const size = find(form, "[name=size]", HTMLSelectElement);
const [width, height, seed, frames] = [field("width"), field("height"), field("seed"), field("frames")];
const total = find(document, "#run-size");
/** @type {ReturnType<typeof setTimeout> | undefined} */
let pending;

/** @param {string} name */
function field(name) {
  return find(form, `[name="${name}"]`, HTMLInputElement);
}

/** The chosen method's radio button. */
const method = () => find(form, "[name=method]:checked", HTMLInputElement);

const controls = () =>
  [...form.elements].filter(
    /** @returns {each is Control} */ (each) => each instanceof HTMLInputElement || each instanceof HTMLSelectElement,
  );

/** The first input's crop as its box shows it: what is being typed may be no crop yet. */
const cropOf = () => find(document, "#frame").dataset.crop ?? "";

/**
 * Whether the chosen method has one of the parameters that methods for videos share.
 *
 * @param {Control} control
 */
const asks = (control) => method().classList.contains(`asks-${control.name}`);

/**
 * The parameters of a method's own.
 *
 * @param {string} name
 */
const ownOf = (name) => controls().filter((each) => each.name.startsWith(`${name}.`));

/** @param {Control} control */
function valueOf(control) {
  if (!(control instanceof HTMLInputElement) || control.type !== "checkbox") return control.value;
  return control.checked ? "on" : "";
}

function followCrop() {
  const follows = "follows" in method().dataset; // else the method itself finds how large its texture is to be
  if (size.options[0]) size.options[0].textContent = follows ? "the crop’s" : "the method’s";
  const crop = parse(cropOf());
  const grow = (/** @type {number} */ side) => String(Math.floor(side * Number(size.value) + 0.5));
  if (size.value !== "free") {
    const known = follows || size.value !== "1" ? crop : null;
    width.value = known ? grow(known.width) : "";
    height.value = known ? grow(known.height) : "";
  }
  const wide = width.value || (follows && crop?.width);
  const high = height.value || (follows && crop?.height);
  frames.placeholder = field("time.count").value;
  const count = asks(frames) ? frames.value || frames.placeholder : "";
  const name = find(document, `[for=method-${method().value}]`).firstChild?.textContent ?? "";
  total.textContent = wide && high ? `${name}, ${wide} × ${high} pixels${count && `, ${count} frames`}` : name;
  clearTimeout(pending);
  pending = setTimeout(keepInAddress, PAUSE);
}

/** All fields of the form as they would be submitted, and with them the switches that are off. */
function readFields() {
  const fields = controls().filter(({ name, type }) => name && !LEFT_OUT.includes(name) && type !== "file");
  const chosen = fields.filter((each) => each.type !== "radio" || each === method());
  /** @type {Field[]} */
  const read = chosen.map((each) => ({ name: each.name, value: valueOf(each), initial: each.dataset.default }));
  for (const block of findAll(form, ".time")) shortenTime(block, read);
  return read;
}

/**
 * @param {HTMLElement} block of a time range's fields
 * @param {Field[]} read
 */
function shortenTime(block, read) {
  const names = findAll(block, "[data-time]", HTMLInputElement).map(({ name }) => name);
  const [first, count] = names.map((name) => read.find((each) => each.name === name));
  if (!first || !count) return;
  [first.value, count.value] = shorten(first.value, count.value, block.dataset.frames ?? "");
}

function keepInAddress() {
  const inputs = [...method().classList].filter((each) => each.startsWith("takes-")).length;
  const lacks = controls().filter((each) => each.closest(".asked") && !asks(each));
  const query = queryOf(readFields(), { inputs, lacks: lacks.map(({ name }) => name) });
  const path = `/samples/${encodeURIComponent(field("sample").value)}`; // also where a refused form is shown again
  history.replaceState(history.state, "", `${path}?${query}`);
}

let before = method().value;

/** What two methods both have keeps its value when one switches between them. */
function carryOver() {
  const now = method().value;
  for (const old of ownOf(before)) {
    const same = ownOf(now).find((each) => each.name === `${now}.${old.name.slice(before.length + 1)}`);
    if (!same || same.type !== old.type) continue;
    if (same instanceof HTMLInputElement && old instanceof HTMLInputElement && same.type === "checkbox") {
      same.checked = old.checked;
    } else same.value = old.value;
  }
  const details = (/** @type {string} */ name) => seek(form, `#method-${name} ~ .own details`, HTMLDetailsElement);
  const [shut, open] = [details(now), details(before)?.open];
  if (shut && open) shut.open = true;
  before = now;
}

for (const side of [width, height]) {
  side.addEventListener("input", () => {
    size.value = "free";
  });
}
form.addEventListener("crop", followCrop);
form.addEventListener("input", followCrop);
form.addEventListener("change", ({ target }) => {
  if (target instanceof HTMLInputElement && target.name === "method") carryOver();
  followCrop();
});

const reroll = find(document, "#reroll");
reroll.hidden = false;
reroll.addEventListener("click", () => {
  const [random = 0] = crypto.getRandomValues(new Uint32Array(1));
  seed.value = String(random % SEEDS);
  followCrop();
});

form.addEventListener("submit", () => {
  clearTimeout(pending);
  keepInAddress();
});
window.addEventListener("pageshow", () => {
  before = method().value;
});
followCrop();
