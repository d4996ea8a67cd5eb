// The query string of a form: its fields by their own names, as they are submitted, without those that are as the form begins
// with them. It opens the page as it is: Back, reload and a bookmark find it so. app/web/form/address.py reads it, and writes
// the same.

/**
 * A field of the form.
 *
 * @typedef {object} Field
 * @property {string} name
 * @property {string} value of a switch "on" or nothing
 * @property {string | undefined} [initial] what it begins with; without it the field is always written
 */

/**
 * What the form asks for the chosen method.
 *
 * @typedef {object} Asked
 * @property {number} inputs how many samples it takes at most
 * @property {string[]} lacks names of parameters that other methods share and this one has not
 */

const READABLE = /%2C|%3A|%40/g;
const INPUT = /^(input-(\d+)\.)(.+)$/;

/**
 * Write a form as the query that opens it again.
 *
 * @param {Field[]} fields in the order of the form, the chosen method among them
 * @param {Asked} asked
 */
export function queryOf(fields, { inputs, lacks }) {
  const values = new Map(fields.map(({ name, value }) => [name, value]));
  const method = values.get("method") ?? "";

  /** @param {string} name */
  function counts(name) {
    const [, prefix, number, part] = INPUT.exec(name) ?? [];
    if (prefix) return Number(number) <= inputs && (part === "sample" || Boolean(values.get(`${prefix}sample`)));
    if (/^(crop|time)\./.test(name)) return true;
    if (name.includes(".")) return name.startsWith(`${method}.`);
    if (name === "width" || name === "height") return values.get("size") === "free";
    return name !== "method" && !lacks.includes(name);
  }

  const query = new URLSearchParams({ method });
  for (const { name, value, initial } of fields) if (counts(name) && value !== initial) query.append(name, value);
  return query.toString().replace(READABLE, decodeURIComponent);
}

/**
 * A time range as the form submits it: nothing where it is all of the clip.
 *
 * @param {string} first
 * @param {string} count
 * @param {string} frames of the clip
 * @returns {[first: string, count: string]}
 */
export function shorten(first, count, frames) {
  return (first || "0") === "0" && count === frames ? ["", ""] : [first, count];
}
