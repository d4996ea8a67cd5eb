// A crop in pixels of the original: whole numbers, within the photograph, at least 1 × 1.

import { clamp } from "../lib/clamp.js";

/** @typedef {{ x: number, y: number }} Point */
/** @typedef {{ width: number, height: number }} Size */
/** @typedef {Point & Size} Rectangle */
/** @typedef {keyof Rectangle} Side */

/** @type {Side[]} */
export const SIDES = ["x", "y", "width", "height"];

/**
 * The rectangle between two corners, given in pixels with fractions; edges snap to whole pixels.
 *
 * @param {Point} a
 * @param {Point} b
 * @param {Size} size of the photograph
 * @returns {Rectangle}
 */
export function span(a, b, size) {
  const [x, width] = spanAxis(a.x, b.x, size.width);
  const [y, height] = spanAxis(a.y, b.y, size.height);
  return { x, y, width, height };
}

/**
 * @param {number} a
 * @param {number} b
 * @param {number} long how long the photograph is
 * @returns {[start: number, length: number]}
 */
function spanAxis(a, b, long) {
  const [one, other] = [clamp(Math.round(a), 0, long), clamp(Math.round(b), 0, long)];
  const start = Math.min(one, other, long - 1);
  return [start, Math.max(1, Math.max(one, other) - start)];
}

/**
 * Move a crop; it stops at the photograph's border.
 *
 * @param {Rectangle} crop
 * @param {number} dx
 * @param {number} dy
 * @param {Size} size of the photograph
 * @returns {Rectangle}
 */
export function move(crop, dx, dy, size) {
  return {
    ...crop,
    x: clamp(Math.round(crop.x + dx), 0, size.width - crop.width),
    y: clamp(Math.round(crop.y + dy), 0, size.height - crop.height),
  };
}

/**
 * Drag some of a crop's edges; they stop at the photograph's border, and a pixel before the edge opposite.
 *
 * @param {Rectangle} crop
 * @param {string} edges such as "n" or "se"
 * @param {number} dx
 * @param {number} dy
 * @param {Size} size of the photograph
 * @returns {Rectangle}
 */
export function resize(crop, edges, dx, dy, size) {
  let { x: left, y: top } = crop;
  let right = left + crop.width;
  let bottom = top + crop.height;
  if (edges.includes("w")) left = clamp(Math.round(left + dx), 0, right - 1);
  if (edges.includes("e")) right = clamp(Math.round(right + dx), left + 1, size.width);
  if (edges.includes("n")) top = clamp(Math.round(top + dy), 0, bottom - 1);
  if (edges.includes("s")) bottom = clamp(Math.round(bottom + dy), top + 1, size.height);
  return { x: left, y: top, width: right - left, height: bottom - top };
}

/**
 * Make numbers that were typed fit: what is too long shrinks to the photograph, and then moves to where it fits.
 *
 * @param {Rectangle} crop
 * @param {Size} size of the photograph
 * @returns {Rectangle}
 */
export function fit({ x, y, width, height }, size) {
  const [wide, high] = [clamp(width, 1, size.width), clamp(height, 1, size.height)];
  return { x: clamp(x, 0, size.width - wide), y: clamp(y, 0, size.height - high), width: wide, height: high };
}

/**
 * Say what had to give way to the side that was typed.
 *
 * @param {Side} side
 * @param {Rectangle} meant
 * @param {Rectangle} crop what of it fits
 */
export function explain(side, meant, crop) {
  const long = side === "x" || side === "width" ? "width" : "height";
  const start = long === "width" ? "x" : "y";
  if (crop[long] !== meant[long]) return `The ${long} is ${crop[long]} now: there is no more.`;
  return `${start} is ${crop[start]} now: from ${meant[start]} on, a ${long} of ${meant[long]} does not fit.`;
}

/**
 * Whether two crops are the same.
 *
 * @param {Rectangle} one
 * @param {Rectangle} other
 */
export const same = (one, other) => SIDES.every((side) => one[side] === other[side]);

/**
 * A crop as attributes and addresses write it, x,y,width,height; null where it is none.
 *
 * @param {string} text
 * @returns {Rectangle | null}
 */
export function parse(text) {
  const [x, y, width, height] = text.split(",").map(Number);
  if (x === undefined || y === undefined || width === undefined || height === undefined) return null;
  return { x, y, width, height };
}
