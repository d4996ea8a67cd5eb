// Splits of a stage's width among pictures, one between each two, as parts of the width in ascending order.

import { clamp } from "../lib/clamp.js";

/**
 * The splits that give each of so many pictures the same width.
 *
 * @param {number} pictures
 */
export const share = (pictures) => Array.from({ length: pictures - 1 }, (_, index) => (index + 1) / pictures);

/**
 * Move one of the splits, as far as its neighbours or the stage's borders.
 *
 * @param {number[]} splits
 * @param {number} index
 * @param {number} to
 */
export function move(splits, index, to) {
  const place = clamp(to, splits[index - 1] ?? 0, splits[index + 1] ?? 1);
  return splits.map((split, other) => (other === index ? place : split));
}
