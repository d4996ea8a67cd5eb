// Numbers as people write them: with a decimal point or a decimal comma, never with both, and never with marks for
// thousands. The service reads them in the same way (app/numbers.py).

const WHOLE = /^([+-]?)(\d+)(?:[.,](?!000$)0+)?$/; // three noughts after a sign may be thousands
const DECIMAL = /^([+-]?)(\d*)(?:[.,](\d*))?(e[+-]?\d+)?$/i;
const FILLING = /^0+(?=\d)/;

/**
 * A text's number as programs write it, or null where it says none, or more than one could be meant.
 *
 * @param {string} text
 * @param {boolean} whole
 */
export function plain(text, whole) {
  const written = text.normalize("NFKC").replaceAll("−", "-").trim();
  const [, sign, digits = "", rest = "", power = ""] = written.match(whole ? WHOLE : DECIMAL) ?? [];
  if (!digits && !rest) return null;
  const minus = sign === "-" ? sign : "";
  return `${minus}${(digits || "0").replace(FILLING, "")}${whole || !rest ? "" : `.${rest}`}${power.toLowerCase()}`;
}

/** @param {HTMLInputElement} field */
export const isWhole = (field) => field.inputMode === "numeric";

/**
 * The number in a field, NaN where there is none.
 *
 * @param {HTMLInputElement} field
 */
export function numberIn(field) {
  const text = plain(field.value, isWhole(field));
  return text === null ? NaN : Number(text);
}
