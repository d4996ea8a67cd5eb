// The parameters beside the photograph: sizes that follow the crop, new seeds, and an address that keeps all of it, so that
// Back, reload and a bookmark find the form as it was.

const SEEDS = 1_000_000;
const form = document.querySelector("#experiment");
const { size, width, height, seed, frames } = form.elements;
const total = document.querySelector("#run-size");
const ORDINALS = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"];
let pending = 0;

/** The crop of an input as its box shows it: what is being typed may be no crop yet. */
const cropOf = (prefix) => document.querySelector(`#${prefix.replace(".", "-")}frame`).dataset.crop ?? "";

const chosen = () => form.elements.method.value;
const radio = () => document.querySelector(`#method-${chosen()}`);
const range = (prefix) => ["first", "count"].map((part) => form.elements[`${prefix}time.${part}`].value);
const asks = (entry) => radio().classList.contains(`asks-${entry.name}`); // of those shared by moving methods
const own = (method) => [...form.elements].filter((entry) => entry.name.startsWith(`${method}.`));

/** An input's time range as the address says it: nothing of a photograph, or where it is all of the clip. */
function time(prefix) {
  const block = form.elements[`${prefix}time.first`].closest(".time");
  const said = range(prefix).join(",");
  return block.hidden || [",", `0,${block.dataset.frames}`].includes(said) ? "" : said;
}

function followCrop() {
  const follows = "follows" in radio().dataset; // else the method itself finds how large its texture is to be
  size.options[0].textContent = follows ? "the crop’s" : "the method’s";
  const sides = cropOf("").split(",").slice(2);
  const grown = sides.map((side) => Math.floor(Number(side) * Number(size.value) + 0.5));
  if (size.value !== "free") [width.value, height.value] = follows || size.value !== "1" ? grown : ["", ""];
  const [w, h] = [width, height].map((field, axis) => field.value || (follows && sides[axis]));
  frames.placeholder = range("")[1];
  const many = asks(frames) && (frames.value || frames.placeholder);
  const long = many ? `, ${many} frames` : "";
  const name = document.querySelector(`[for=method-${chosen()}]`).firstChild.textContent;
  total.textContent = w && h ? `${name}, ${w} × ${h} pixels${long}` : name;
  clearTimeout(pending);
  pending = setTimeout(keepInAddress, 250);
}

function keepInAddress() {
  const query = new URLSearchParams();
  query.set("method", chosen());
  query.set("crop", cropOf(""));
  if (time("")) query.set("time", time(""));
  for (let number = 2; radio().classList.contains(`takes-${number}`); number += 1) {
    const prefix = `input-${number}.`;
    const sample = form.elements[`${prefix}sample`].value;
    const when = time(prefix) && `@${time(prefix)}`;
    if (sample) query.set(ORDINALS[number - 1], `${sample}:${cropOf(prefix)}${when}`);
  }
  if (size.value !== "1") query.set("size", size.value);
  if (size.value === "free") {
    if (width.value) query.set("width", width.value);
    if (height.value) query.set("height", height.value);
  }
  if (seed.value) query.set("seed", seed.value);
  for (const entry of [...[...form.elements].filter(asks), ...own(chosen())]) {
    const value = entry.type === "checkbox" ? (entry.checked ? "on" : "") : entry.value;
    if (value !== entry.dataset.default) query.set(entry.name.split(".").at(-1), value);
  }
  const path = `/samples/${encodeURIComponent(form.elements.sample.value)}`;
  const said = query.toString().replace(/%2C|%3A|%40/g, decodeURIComponent);
  history.replaceState(history.state, "", `${path}?${said}`);
}

let before = chosen();
function carryOver() {
  // What two methods both have keeps its value when one switches between them.
  for (const old of own(before)) {
    const same = form.elements[`${chosen()}.${old.name.slice(before.length + 1)}`];
    if (!same || same.type !== old.type) continue;
    if (same.type === "checkbox") same.checked = old.checked;
    else same.value = old.value;
  }
  const open = document.querySelector(`#method-${before} ~ .own details`)?.open;
  const details = document.querySelector(`#method-${chosen()} ~ .own details`);
  if (details && open) details.open = true;
  before = chosen();
}

for (const entry of [width, height]) {
  entry.addEventListener("input", () => {
    size.value = "free";
  });
}
form.addEventListener("crop", followCrop);
form.addEventListener("input", followCrop);
form.addEventListener("change", (event) => {
  if (event.target.name === "method") carryOver();
  followCrop();
});

const reroll = document.querySelector("#reroll");
reroll.hidden = false;
reroll.addEventListener("click", () => {
  seed.value = crypto.getRandomValues(new Uint32Array(1))[0] % SEEDS;
  followCrop();
});

form.addEventListener("submit", () => {
  clearTimeout(pending);
  keepInAddress();
});
window.addEventListener("pageshow", () => {
  before = chosen();
});
followCrop();
