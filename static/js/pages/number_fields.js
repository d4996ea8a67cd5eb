// Fields for numbers: the arrow keys step them, and when a field is left it says the number as it was understood. What is
// no number stays as it was typed, for the form says at the field what is wrong with it.

import { isWhole, numberIn, plain } from "../lib/numbers.js";

const STEPS = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
const SELECTOR = "input[inputmode=numeric], input[inputmode=decimal]";
const bound = (text, otherwise) => (text ? Number(text) : otherwise);

/** Tell assistive technology what the field holds and may hold. */
function tell(field) {
  const value = numberIn(field);
  const told = { valuenow: Number.isNaN(value) ? "" : value, valuemin: field.dataset.min, valuemax: field.dataset.max };
  for (const [name, text] of Object.entries(told)) {
    if (text === "" || text === undefined) field.removeAttribute(`aria-${name}`);
    else field.setAttribute(`aria-${name}`, text);
  }
}

function step(field, times) {
  const { min, max, step: each } = field.dataset;
  const [least, most] = [bound(min, -Infinity), bound(max, Infinity)];
  const from = [field.value, field.placeholder, field.dataset.default ?? ""].map((text) => plain(text, isWhole(field)));
  const start = from.find((text) => text !== null);
  const to = start === undefined ? Math.max(0, least) : Number(start) + times * Number(each);
  const digits = each.split(".")[1]?.length ?? 0; // sums of tenths are no tenths in floating point
  const value = Math.min(Math.max(Number(to.toFixed(digits)), least), most);
  if (String(value) === field.value) return;
  field.value = value;
  for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind, { bubbles: true }));
}

document.addEventListener("keydown", (event) => {
  const times = STEPS[event.key];
  if (!times || !event.target.matches(SELECTOR) || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  step(event.target, times);
});

// Before any other listener reads the field.
document.addEventListener("change", ({ target }) => {
  if (!target.matches(SELECTOR)) return;
  const said = plain(target.value, isWhole(target));
  if (said !== null && said !== target.value) target.value = said;
}, true);

for (const kind of ["focusin", "input", "change"]) {
  document.addEventListener(kind, ({ target }) => target.matches(SELECTOR) && tell(target));
}
for (const field of document.querySelectorAll(SELECTOR)) {
  field.setAttribute("role", "spinbutton");
  tell(field);
}
