// Pinch of two fingers: what lies between them moves along, and is enlarged as often as they are further apart.

/** @typedef {[x: number, y: number]} Place on the screen, in its pixels */

/**
 * @param {PointerEvent | WheelEvent} event
 * @returns {Place}
 */
export const placeOf = (event) => [event.clientX, event.clientY];

/**
 * The place halfway between two others.
 *
 * @param {Place} a
 * @param {Place} b
 * @returns {Place}
 */
export const middle = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];

/**
 * How far two places are apart, never 0.
 *
 * @param {Place} a
 * @param {Place} b
 */
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;

/**
 * What one finger that moves from `before` to `after` does while the other one stays: how far the middle went, and how often what
 * lies there was enlarged.
 *
 * @param {Place} before
 * @param {Place} after
 * @param {Place} other
 */
export function pinch(before, after, other) {
  const [from, to] = [middle(before, other), middle(after, other)];
  const factor = distance(after, other) / distance(before, other);
  return { dx: to[0] - from[0], dy: to[1] - from[1], factor, about: to };
}
