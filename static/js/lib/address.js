// The address of a form: a sample's page with what is filled in, so that Back, reload and a bookmark find it as it was.
// What is as the form begins with is left out.

/** @typedef {{ sample: string, crop: string, time: string }} Input crop as x,y,width,height, time as first,count */

/**
 * @typedef {object} Draft
 * @property {string} method
 * @property {Input[]} inputs of a method that takes several, all of them; an optional one has no sample
 * @property {string} size times the crop's, or "free"
 * @property {string} width if it is free
 * @property {string} height
 * @property {string} seed
 * @property {[name: string, value: string][]} parameters that are not what they begin with
 */

const ORDINALS = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"];

/**
 * A time range as the address has it: nothing of what is left empty, or is all of the clip.
 *
 * @param {string} first
 * @param {string} count
 * @param {string} frames of the clip
 */
export function timeOf(first, count, frames) {
  const range = `${first},${count}`;
  return range === "," || range === `0,${frames}` ? "" : range;
}

/** @param {Draft} draft */
export function addressOf({ method, inputs, size, width, height, seed, parameters }) {
  const [input, ...further] = inputs;
  if (!input) throw new RangeError("a form has an input");
  const query = new URLSearchParams({ method, crop: input.crop });
  if (input.time) query.set("time", input.time);
  further.forEach(({ sample, crop, time }, index) => {
    if (sample) query.set(ORDINALS[index + 1] ?? "", `${sample}:${crop}${time && `@${time}`}`);
  });
  if (size !== "1") query.set("size", size);
  if (size === "free") {
    if (width) query.set("width", width);
    if (height) query.set("height", height);
  }
  if (seed) query.set("seed", seed);
  for (const [name, value] of parameters) query.set(name, value);
  const text = query.toString().replace(/%2C|%3A|%40/g, decodeURIComponent);
  return `/samples/${encodeURIComponent(input.sample)}?${text}`;
}
