// The parameters beside the photograph: sizes that follow the crop, new seeds, and an address that keeps all of it.

import { parse } from "../crop/rectangle.js";
import { addressOf, timeOf } from "../lib/address.js";
import { find, seek } from "../lib/dom.js";

/** @import { Input } from "../lib/address.js" */
/** @typedef {HTMLInputElement | HTMLSelectElement} Control */

const SEEDS = 1_000_000;
const PAUSE = 250; // milliseconds without a change
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

/**
 * The crop of an input as its box shows it: what is being typed may be no crop yet.
 *
 * @param {string} prefix of the input's names
 */
const cropOf = (prefix) => find(document, `#${prefix.replace(".", "-")}frame`).dataset.crop ?? "";

/**
 * An input's time range as the address has it; nothing of a photograph.
 *
 * @param {string} prefix
 */
function rangeOf(prefix) {
  const first = field(`${prefix}time.first`);
  const block = /** @type {HTMLElement} */ (first.closest(".time"));
  return block.hidden ? "" : timeOf(first.value, field(`${prefix}time.count`).value, block.dataset.frames ?? "");
}

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
  const crop = parse(cropOf(""));
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

/** @returns {Input[]} */
function readInputs() {
  const inputs = [{ sample: field("sample").value, crop: cropOf(""), time: rangeOf("") }];
  for (let number = 2; method().classList.contains(`takes-${number}`); number += 1) {
    const prefix = `input-${number}.`;
    const sample = find(form, `[name="${prefix}sample"]`, HTMLSelectElement).value;
    inputs.push({ sample, crop: cropOf(prefix), time: rangeOf(prefix) });
  }
  return inputs;
}

function keepInAddress() {
  const name = method().value;
  const changed = [...controls().filter(asks), ...ownOf(name)].filter((each) => valueOf(each) !== each.dataset.default);
  const address = addressOf({
    method: name,
    inputs: readInputs(),
    size: size.value,
    width: width.value,
    height: height.value,
    seed: seed.value,
    parameters: changed.map((each) => [each.name.split(".").at(-1) ?? "", valueOf(each)]),
  });
  history.replaceState(history.state, "", address);
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
