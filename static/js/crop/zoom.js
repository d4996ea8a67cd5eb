// Zoom of the photograph that is cropped: all of it fills its frame, or a part of it, enlarged.

import { clamp } from "../lib/clamp.js";

/** @import { Point, Rectangle, Size } from "./rectangle.js" */

const FINEST = 8; // screen pixels per pixel of the original, at most

export class Zoom {
  /** @type {Size} */
  size = { width: 0, height: 0 };
  base = 0; // screen pixels per pixel at which all of the photograph is seen; 0 until it has been laid out
  times = 1;
  x = 0; // (x, y) of the original lies in the frame's corner
  y = 0;

  whole() {
    [this.times, this.x, this.y] = [1, 0, 0];
  }

  /**
   * @param {Size} size of the photograph
   * @param {number} base screen pixels per pixel at which all of it is seen
   */
  layOut(size, base) {
    this.size = size;
    this.base = base;
    this.hold(this, 0, 0);
  }

  get scale() {
    return this.base * this.times;
  }

  get zoomed() {
    return this.times > 1;
  }

  get largest() {
    return this.times >= FINEST / this.base;
  }

  /**
   * Enlarge so many times; a point of the original then lies `across` and `down` screen pixels from the corner.
   *
   * @param {Point} point
   * @param {number} across
   * @param {number} down
   * @param {number} times
   */
  hold({ x, y }, across, down, times = this.times) {
    this.times = clamp(times, 1, Math.max(1, FINEST / this.base));
    this.x = x - across / this.scale;
    this.y = y - down / this.scale;
    this.keepWithin();
  }

  /**
   * Enlarge by a factor; a point of the original stays where it is.
   *
   * @param {number} factor
   * @param {Point} point
   */
  about(factor, { x, y }) {
    this.hold({ x, y }, (x - this.x) * this.scale, (y - this.y) * this.scale, this.times * factor);
  }

  keepWithin() {
    const { width, height } = this.size;
    this.x = clamp(this.x, 0, width - width / this.times);
    this.y = clamp(this.y, 0, height - height / this.times);
  }

  /**
   * Move what is seen until a crop is, or the middle of one that is too large.
   *
   * @param {Rectangle} crop
   */
  reveal(crop) {
    if (!this.zoomed) return;
    this.x = reveal(this.x, this.size.width / this.times, crop.x, crop.width);
    this.y = reveal(this.y, this.size.height / this.times, crop.y, crop.height);
    this.keepWithin();
  }
}

/**
 * Where a view of length `room` that begins at `from` begins once it shows what is `long` and begins at `start`.
 *
 * @param {number} from
 * @param {number} room
 * @param {number} start
 * @param {number} long
 */
function reveal(from, room, start, long) {
  if (long > room) return start + (long - room) / 2;
  return clamp(from, start + long - room, start);
}
