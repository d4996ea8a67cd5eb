// Tiles of a video that plays, n × n of it: what of them lies on the stage, drawn on a canvas at every new frame.

/** @import { Size } from "./geometry.js" */

export class Mosaic {
  canvas = document.createElement("canvas");
  context = this.canvas.getContext("2d");
  /** @type {number[]} */
  columns = [];
  /** @type {number[]} */
  rows = [];

  /** @param {HTMLVideoElement} video */
  constructor(video) {
    this.video = video;
    const next = () => {
      this.paint();
      video.requestVideoFrameCallback(next);
    };
    video.requestVideoFrameCallback(next);
    // A video that is hidden and stands still calls nobody back.
    for (const name of ["loadeddata", "seeked"]) video.addEventListener(name, () => this.paint());
  }

  /**
   * Place n × n videos of `wide` × `high` screen pixels, from (left, top) of a box on.
   *
   * @param {Size} box
   * @param {number} left
   * @param {number} top
   * @param {number} wide
   * @param {number} high
   * @param {number} tiles n
   * @param {boolean} smooth where they are reduced
   */
  place(box, left, top, wide, high, tiles, smooth) {
    // Every tile begins at a whole pixel of the screen, where the one before it ends.
    const edge = (/** @type {number} */ place) => Math.round(place * devicePixelRatio);
    const numbers = [...Array(tiles + 1).keys()];
    this.columns = numbers.map((index) => edge(left + index * wide));
    this.rows = numbers.map((index) => edge(top + index * high));
    this.canvas.width = Math.round(box.width * devicePixelRatio);
    this.canvas.height = Math.round(box.height * devicePixelRatio);
    if (this.context) this.context.imageSmoothingEnabled = smooth;
    this.paint();
  }

  paint() {
    if (this.canvas.hidden || this.video.readyState < HTMLMediaElement.HAVE_CURRENT_DATA) return;
    for (const [top, bottom] of pairs(this.rows)) {
      for (const [left, right] of pairs(this.columns)) {
        this.context?.drawImage(this.video, left, top, right - left, bottom - top);
      }
    }
  }
}

/**
 * Each number with the one after it.
 *
 * @param {number[]} edges
 */
function pairs(edges) {
  return edges.slice(1).map((edge, index) => /** @type {[number, number]} */ ([edges[index], edge]));
}
