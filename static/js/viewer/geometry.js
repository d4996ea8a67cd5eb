// Geometry of the viewer: where pictures lie on a stage at a scale, and what of them is seen. A view is the scale, in
// screen pixels per pixel, and which point of the pictures lies in the stage's centre, in pixels from their own
// centres.

import { clamp } from "../lib/clamp.js";

/** @typedef {{ width: number, height: number }} Size */
/** @typedef {{ scale: number, x: number, y: number }} View */

const MARGIN = 32; // screen pixels that pictures leave free, at most
const LARGEST_FIT = 4; // screen pixels per pixel that small pictures are shown at
export const [SMALLEST, LARGEST] = [0.25, 16]; // screen pixels per pixel, unless pictures fit at fewer only

/**
 * The scale at which n × n of every picture is seen whole; whole numbers above 1, so that pixels stay square and equal.
 *
 * @param {Size[]} pictures
 * @param {Size} room
 * @param {number} tiles n
 */
export function fit(pictures, room, tiles) {
  const margin = Math.min(MARGIN, room.width / 16);
  const [wide, high] = [room.width - margin, room.height - margin];
  const scale = Math.min(...pictures.map(({ width, height }) => Math.min(wide / width, high / height) / tiles));
  return scale >= 1 ? Math.min(Math.floor(scale), LARGEST_FIT) : scale;
}

/**
 * Zoom by a factor about a place on the stage: what lies there stays there.
 *
 * @param {View} view
 * @param {number} factor
 * @param {number} x from the stage's centre, in screen pixels
 * @param {number} y
 * @param {number} whole the scale at which all is seen, down to which one can zoom whatever it is
 * @returns {View}
 */
export function zoom(view, factor, x, y, whole) {
  const scale = clamp(view.scale * factor, Math.min(SMALLEST, whole), LARGEST);
  return { scale, x: view.x + x / view.scale - x / scale, y: view.y + y / view.scale - y / scale };
}

/**
 * Pan by screen pixels, until the border of the largest picture lies in the stage's centre.
 *
 * @param {View} view
 * @param {number} dx
 * @param {number} dy
 * @param {Size[]} pictures
 * @param {number} tiles of each picture, in a row and in a column
 * @returns {View}
 */
export function pan({ scale, x, y }, dx, dy, pictures, tiles) {
  const wide = (Math.max(...pictures.map(({ width }) => width)) * tiles) / 2;
  const high = (Math.max(...pictures.map(({ height }) => height)) * tiles) / 2;
  return { scale, x: clamp(x - dx / scale, -wide, wide), y: clamp(y - dy / scale, -high, high) };
}

/**
 * Where n × n of a picture lie on a stage, in screen pixels from its top left corner; corners at whole pixels of the screen.
 *
 * @param {Size} picture
 * @param {Size} room
 * @param {View} view
 * @param {number} tiles n
 * @param {number} ratio pixels of the screen per pixel of CSS
 */
export function lay(picture, room, view, tiles, ratio) {
  const snap = (/** @type {number} */ value) => Math.round(value * ratio) / ratio;
  const [width, height] = [picture.width * tiles * view.scale, picture.height * tiles * view.scale];
  const left = snap(room.width / 2 - width / 2 - view.x * view.scale);
  const top = snap(room.height / 2 - height / 2 - view.y * view.scale);
  return { left, top, width, height };
}

/**
 * How much to cut off a picture on its left and on its right, in its own pixels, so that it is seen between two places.
 *
 * @param {{ left: number, width: number }} laid where it lies on the stage, in screen pixels
 * @param {number} scale
 * @param {number} from screen pixels from the stage's left border
 * @param {number} to
 */
export function cut({ left, width }, scale, from, to) {
  return { left: Math.max(0, (from - left) / scale), right: Math.max(0, (left + width - to) / scale) };
}
