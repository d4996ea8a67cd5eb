// Spin buttons: number fields that the arrow keys step, and that say the number as it was understood once they are
// left. What is no number stays as it was typed, for the form says at the field what is wrong with it.

import { clamp } from "../lib/clamp.js";
import { findAll } from "../lib/dom.js";
import { isWhole, numberIn, plain } from "../lib/numbers.js";

/** @type {Record<string, number>} */
const STEPS = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
const SELECTOR = "input[inputmode=numeric], input[inputmode=decimal]";

/**
 * @param {string | undefined} text
 * @param {number} otherwise
 */
const bound = (text, otherwise) => (text ? Number(text) : otherwise);

/**
 * The number field that an event is about, if it is one.
 *
 * @param {Event} event
 */
const fieldOf = ({ target }) => (target instanceof HTMLInputElement && target.matches(SELECTOR) ? target : null);

/**
 * Tell assistive technology what the field holds and may hold.
 *
 * @param {HTMLInputElement} field
 */
function tell(field) {
  const value = numberIn(field);
  const { min = "", max = "" } = field.dataset;
  const numbers = { valuenow: Number.isNaN(value) ? "" : String(value), valuemin: min, valuemax: max };
  for (const [name, text] of Object.entries(numbers)) {
    if (text === "") field.removeAttribute(`aria-${name}`);
    else field.setAttribute(`aria-${name}`, text);
  }
}

/**
 * @param {HTMLInputElement} field
 * @param {number} times
 */
function step(field, times) {
  const { min, max, step: each = "1" } = field.dataset;
  const [least, most] = [bound(min, -Infinity), bound(max, Infinity)];
  const texts = [field.value, field.placeholder, field.dataset.default ?? ""];
  const start = texts.map((text) => plain(text, isWhole(field))).find((text) => text !== null);
  const to = start === undefined ? Math.max(0, least) : Number(start) + times * Number(each);
  const digits = each.split(".")[1]?.length ?? 0; // sums of tenths are no tenths in floating point
  const value = String(clamp(Number(to.toFixed(digits)), least, most));
  if (value === field.value) return;
  field.value = value;
  for (const kind of ["input", "change"]) field.dispatchEvent(new Event(kind, { bubbles: true }));
}

document.addEventListener("keydown", (event) => {
  const [times, field] = [STEPS[event.key], fieldOf(event)];
  if (!times || !field || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  step(field, times);
});

/**
 * Say the number as it was understood.
 *
 * @param {Event} event
 */
function rewrite(event) {
  const field = fieldOf(event);
  const number = field && plain(field.value, isWhole(field));
  if (field && number !== null && number !== field.value) field.value = number;
}
document.addEventListener("change", rewrite, true); // before any other listener reads the field

for (const kind of ["focusin", "input", "change"]) {
  document.addEventListener(kind, (event) => {
    const field = fieldOf(event);
    if (field) tell(field);
  });
}
for (const field of findAll(document, SELECTOR, HTMLInputElement)) {
  field.setAttribute("role", "spinbutton");
  tell(field);
}
