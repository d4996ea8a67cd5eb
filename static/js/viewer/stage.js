// One stage of the viewer: pictures lying on grey, placed by a scale and a centre that all stages share.

import { Mosaic } from "./mosaic.js";

/** A picture or film: its <img> or <video>, its size in pixels, and a <div> or <canvas> that repeats it. */
export function picture(stage, title) {
  const video = stage.querySelector("video");
  const mosaic = video && new Mosaic(video);
  const tile = mosaic?.canvas ?? document.createElement("div");
  tile.className = "tile";
  tile.setAttribute("role", "img");
  tile.hidden = true;
  const [width, height] = [Number(stage.dataset.width), Number(stage.dataset.height)];
  return { image: video ?? stage.querySelector("img"), mosaic, tile, title, width, height };
}

const snapped = (value) => Math.round(value * devicePixelRatio) / devicePixelRatio;

/**
 * Place a picture, or n × n of it, on a stage of `room` pixels.
 *
 * `view` is {scale, x, y}: screen pixels per pixel, and where the stage's centre is, in pixels from the picture's centre.
 * `from` and `to`, parts of the stage's width, bound what of it is seen.
 */
export function place(shown, room, view, tiles, from = 0, to = 1) {
  const width = shown.width * tiles * view.scale;
  const height = shown.height * tiles * view.scale;
  const left = snapped(room.width / 2 - width / 2 - view.x * view.scale);
  const top = snapped(room.height / 2 - height / 2 - view.y * view.scale);
  shown.image.hidden = tiles > 1;
  shown.tile.hidden = tiles === 1;
  const target = tiles > 1 ? shown.tile : shown.image;
  target.classList.toggle("pixelated", view.scale > 1);
  if (tiles > 1) {
    shown.tile.setAttribute("aria-label", `${shown.title}, ${tiles} × ${tiles} times`);
    repeat(shown, room, left, top, width, height, view.scale, tiles);
    return;
  }
  shown.image.style.transform = `translate(${left}px, ${top}px) scale(${view.scale})`;
  const cutLeft = Math.max(0, (from * room.width - left) / view.scale);
  const cutRight = Math.max(0, (left + width - to * room.width) / view.scale);
  shown.image.style.clipPath = cutLeft || cutRight ? `inset(0 ${cutRight}px 0 ${cutLeft}px)` : "";
}

/** Repeat in a box no larger than the stage, so that 16 × 3 × 4096 pixels cost no more than a screen. */
function repeat({ image, mosaic, tile, width, height }, room, left, top, wide, high, scale, tiles) {
  const [x0, y0] = [Math.max(0, left), Math.max(0, top)];
  const [x1, y1] = [Math.min(room.width, left + wide), Math.min(room.height, top + high)];
  const box = { width: Math.max(0, x1 - x0), height: Math.max(0, y1 - y0) };
  Object.assign(tile.style, { left: `${x0}px`, top: `${y0}px`, width: `${box.width}px`, height: `${box.height}px` });
  if (mosaic) {
    mosaic.place(box, left - x0, top - y0, width * scale, height * scale, tiles, scale <= 1);
    return;
  }
  Object.assign(tile.style, {
    backgroundImage: `url("${image.src}")`,
    backgroundSize: `${width * scale}px ${height * scale}px`,
    backgroundPosition: `${left - x0}px ${top - y0}px`,
  });
}

/** The scale at which n × n of every picture is seen whole; whole numbers above 1, so that pixels stay square and equal. */
export function fitting(pictures, room, tiles) {
  const margin = Math.min(32, room.width / 16);
  const [wide, high] = [room.width - margin, room.height - margin];
  const scale = Math.min(...pictures.map(({ width, height }) => Math.min(wide / width, high / height) / tiles));
  return scale >= 1 ? Math.min(Math.floor(scale), 4) : scale;
}
