// Which part of the photograph its frame shows: all of it, or a part enlarged.

const FINEST = 8; // screen pixels per pixel of the original, at most
const between = (value, low, high) => Math.min(Math.max(value, low), high);

export class Zoom {
  constructor() {
    this.whole();
  }

  whole() {
    Object.assign(this, { times: 1, x: 0, y: 0 }); // (x, y) of the original lies in the frame's corner
  }

  /** `base` is the screen pixels per pixel at which all of a photograph of that size is seen. */
  layOut(size, base) {
    Object.assign(this, { size, base });
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

  /** Enlarge so many times; the point (x, y) of the original then lies `across` and `down` screen pixels from the corner. */
  hold({ x, y }, across, down, times = this.times) {
    this.times = between(times, 1, Math.max(1, FINEST / this.base));
    this.x = x - across / this.scale;
    this.y = y - down / this.scale;
    this.keepWithin();
  }

  /** Enlarge by a factor; the point (x, y) stays where it is. */
  about(factor, { x, y }) {
    this.hold({ x, y }, (x - this.x) * this.scale, (y - this.y) * this.scale, this.times * factor);
  }

  keepWithin() {
    const { width, height } = this.size;
    this.x = between(this.x, 0, width - width / this.times);
    this.y = between(this.y, 0, height - height / this.times);
  }

  /** Move what is seen until a crop is, or the middle of one that is too large. */
  reveal(crop) {
    if (!this.zoomed) return;
    for (const [start, long] of [["x", "width"], ["y", "height"]]) {
      const room = this.size[long] / this.times;
      const end = crop[start] + crop[long] - room;
      if (crop[long] > room) this[start] = crop[start] + (crop[long] - room) / 2;
      else this[start] = between(this[start], end, crop[start]);
    }
    this.keepWithin();
  }
}
