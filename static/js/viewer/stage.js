// A stage of the viewer: pictures lying on grey, placed by a scale and a centre that all stages share.

import { find, seek } from "../lib/dom.js";
import { cut, lay } from "./geometry.js";
import { Mosaic } from "./mosaic.js";

/** @import { Size, View } from "./geometry.js" */

/**
 * A picture or video, its size in pixels, and what repeats it.
 *
 * @typedef {object} Picture
 * @property {HTMLImageElement | HTMLVideoElement} image
 * @property {HTMLElement} tile
 * @property {Mosaic | null} mosaic of a video, drawing on the tile
 * @property {string} title
 * @property {number} width
 * @property {number} height
 */

/**
 * The picture or video that lies on a stage.
 *
 * @param {HTMLElement} stage
 * @param {string} title
 * @returns {Picture}
 */
export function takePicture(stage, title) {
  const video = seek(stage, "video", HTMLVideoElement);
  const mosaic = video && new Mosaic(video);
  const tile = mosaic?.canvas ?? document.createElement("div");
  tile.className = "tile";
  tile.setAttribute("role", "img");
  tile.hidden = true;
  const [width, height] = [Number(stage.dataset.width), Number(stage.dataset.height)];
  return { image: video ?? find(stage, "img", HTMLImageElement), mosaic, tile, title, width, height };
}

/**
 * Place a picture, or n × n of it, on a stage.
 *
 * @param {Picture} shown
 * @param {Size} room of the stage
 * @param {View} view
 * @param {number} tiles n
 * @param {number} from part of the stage's width, from which on it is seen
 * @param {number} to
 */
export function place(shown, room, view, tiles, from = 0, to = 1) {
  const laid = lay(shown, room, view, tiles, devicePixelRatio);
  shown.image.hidden = tiles > 1;
  shown.tile.hidden = tiles === 1;
  const target = tiles > 1 ? shown.tile : shown.image;
  target.classList.toggle("pixelated", view.scale > 1);
  if (tiles > 1) {
    shown.tile.setAttribute("aria-label", `${shown.title}, ${tiles} × ${tiles} times`);
    repeat(shown, room, laid, view.scale, tiles);
    return;
  }
  shown.image.style.transform = `translate(${laid.left}px, ${laid.top}px) scale(${view.scale})`;
  const { left, right } = cut(laid, view.scale, from * room.width, to * room.width);
  shown.image.style.clipPath = left || right ? `inset(0 ${right}px 0 ${left}px)` : "";
}

/**
 * Repeat in a box no larger than the stage, so that 16 × 3 × 4096 pixels cost no more than a screen.
 *
 * @param {Picture} picture
 * @param {Size} room
 * @param {ReturnType<typeof lay>} laid
 * @param {number} scale
 * @param {number} tiles
 */
function repeat({ image, mosaic, tile, width, height }, room, laid, scale, tiles) {
  const [x0, y0] = [Math.max(0, laid.left), Math.max(0, laid.top)];
  const [x1, y1] = [Math.min(room.width, laid.left + laid.width), Math.min(room.height, laid.top + laid.height)];
  const box = { width: Math.max(0, x1 - x0), height: Math.max(0, y1 - y0) };
  const [left, top] = [laid.left - x0, laid.top - y0];
  const bounds = { left: `${x0}px`, top: `${y0}px`, width: `${box.width}px`, height: `${box.height}px` };
  Object.assign(tile.style, bounds);
  if (mosaic) {
    mosaic.place(box, left, top, width * scale, height * scale, tiles, scale <= 1);
    return;
  }
  tile.style.backgroundImage = `url("${image.src}")`;
  tile.style.backgroundSize = `${width * scale}px ${height * scale}px`;
  tile.style.backgroundPosition = `${left}px ${top}px`;
}
