// Number fields that have to fit each other, such as a crop's or a time range's. What does not fit is left alone while it is
// typed; once its field is left, the numbers are made to fit.

import { numberIn } from "./numbers.js";

export class NumberGroup {
  /**
   * `fields` by name, and `note`, where it is said what had to give way. `on` has
   *
   * - `fitted(numbers)`, the nearest numbers that fit, and `words(name, wanted, fitted)`, which says what gave way to a field;
   * - `read()`, the numbers that are meant, null where one is missing;
   * - `typed(numbers)`, told of numbers that fit, while they are typed, or null of others, which leave all as it was before;
   * - `left(numbers)`, told of what they are once they are made to fit.
   */
  constructor(fields, note, on) {
    Object.assign(this, { fields, note, on });
    this.meant = {}; // typed, and for now in the way of another number: of those typed one after the other, all count
    for (const [name, field] of Object.entries(fields)) {
      field.addEventListener("input", () => {
        const typed = on.read();
        on.typed(typed && this.alike(typed, on.fitted(typed)) ? typed : null);
      });
      field.addEventListener("change", () => this.leave(name));
      field.addEventListener("blur", ({ relatedTarget }) => {
        if (!Object.values(fields).includes(relatedTarget)) this.meant = {};
      });
    }
  }

  alike(one, other) {
    return Object.keys(this.fields).every((name) => one[name] === other[name]);
  }

  get empty() {
    return Object.values(this.fields).every((field) => field.value === "");
  }

  /** The numbers as they are written, null where one is missing; `empty(name, before)` says what an empty field stands for. */
  read(empty = () => NaN) {
    const numbers = {};
    for (const [name, field] of Object.entries(this.fields)) {
      numbers[name] = field.value.trim() === "" ? empty(name, numbers) : numberIn(field);
    }
    return Object.values(numbers).every(Number.isInteger) ? numbers : null;
  }

  write(numbers) {
    this.meant = {};
    this.say("");
    for (const [name, field] of Object.entries(this.fields)) field.value = numbers[name];
  }

  leave(name) {
    const typed = this.on.read();
    if (!typed) return; // the form says what is wrong with it
    const { min, max } = this.fields[name].dataset;
    const meant = { ...this.meant, [name]: typed[name] };
    if (typed[name] < Number(min) || typed[name] > Number(max)) delete meant[name];
    const wanted = { ...typed, ...meant };
    const fitted = this.on.fitted(wanted);
    this.on.left(fitted);
    this.meant = meant;
    this.say(this.alike(wanted, fitted) ? "" : this.on.words(name, wanted, fitted));
  }

  say(words) {
    if (this.note.textContent !== words) this.note.textContent = words;
  }
}
