// Number fields that have to fit each other, such as a crop's or a time range's. What does not fit is left alone while
// it is typed; once its field is left, the numbers are made to fit.

import { numberIn } from "./numbers.js";

/**
 * Whose numbers they are.
 *
 * @template {string} Name
 * @typedef {object} Owner
 * @property {(numbers: Record<Name, number>) => Record<Name, number>} fit the nearest numbers that fit
 * @property {(name: Name, meant: Record<Name, number>, fit: Record<Name, number>) => string} explain what gave way to a field
 * @property {() => Record<Name, number> | null} read the numbers that are meant, null where one is missing
 * @property {(numbers: Record<Name, number> | null) => void} preview takes numbers that fit, while they are typed, or null for
 *   others, which leave all as it was before
 * @property {(numbers: Record<Name, number>) => void} keep takes what they are once they are made to fit
 */

/** @template {string} Name */
export class NumberGroup {
  /**
   * @param {Record<Name, HTMLInputElement>} fields
   * @param {Element} note where it is said what had to give way
   * @param {Owner<Name>} on
   */
  constructor(fields, note, on) {
    this.fields = fields;
    this.names = /** @type {Name[]} */ (Object.keys(fields));
    this.note = note;
    this.on = on;
    /** @type {Partial<Record<Name, number>>} */
    this.meant = {}; // typed, and for now in the way of another number: of those typed one after the other, all count
    for (const name of this.names) {
      const field = fields[name];
      field.addEventListener("input", () => {
        const typed = on.read();
        on.preview(typed && this.alike(typed, on.fit(typed)) ? typed : null);
      });
      field.addEventListener("change", () => this.leave(name));
      field.addEventListener("blur", ({ relatedTarget }) => {
        if (!this.names.some((other) => fields[other] === relatedTarget)) this.meant = {};
      });
    }
  }

  /**
   * @param {Record<Name, number>} one
   * @param {Record<Name, number>} other
   */
  alike(one, other) {
    return this.names.every((name) => one[name] === other[name]);
  }

  get empty() {
    return this.names.every((name) => this.fields[name].value === "");
  }

  /**
   * The numbers as they are written, null where one is missing.
   *
   * @param {(name: Name, before: Record<Name, number>) => number} empty what an empty field stands for
   */
  read(empty = () => NaN) {
    const numbers = /** @type {Record<Name, number>} */ ({});
    for (const name of this.names) {
      const field = this.fields[name];
      numbers[name] = field.value.trim() === "" ? empty(name, numbers) : numberIn(field);
    }
    return this.names.every((name) => Number.isInteger(numbers[name])) ? numbers : null;
  }

  /** @param {Record<Name, number>} numbers */
  write(numbers) {
    this.meant = {};
    this.say("");
    for (const name of this.names) this.fields[name].value = String(numbers[name]);
  }

  /** @param {Name} name */
  leave(name) {
    const typed = this.on.read();
    if (!typed) return; // the form says what is wrong with it
    const { min, max } = this.fields[name].dataset;
    const meant = { ...this.meant, [name]: typed[name] };
    if (typed[name] < Number(min) || typed[name] > Number(max)) delete meant[name];
    const all = { ...typed, ...meant };
    const fit = this.on.fit(all);
    this.on.keep(fit);
    this.meant = meant;
    this.say(this.alike(all, fit) ? "" : this.on.explain(name, all, fit));
  }

  /** @param {string} words */
  say(words) {
    if (this.note.textContent !== words) this.note.textContent = words;
  }
}
