// n × n of a film that plays: what of it lies on the stage, drawn on a canvas at every new frame.

export class Mosaic {
  constructor(video) {
    this.video = video;
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d");
    this.columns = this.rows = [];
    const next = () => {
      this.paint();
      video.requestVideoFrameCallback(next);
    };
    video.requestVideoFrameCallback(next);
    // A video that is hidden and stands still calls nobody back.
    for (const name of ["loadeddata", "seeked"]) video.addEventListener(name, () => this.paint());
  }

  /** Place n × n films of `wide` × `high` screen pixels, from (left, top) of the box on; `smooth` if they are reduced. */
  place(box, left, top, wide, high, tiles, smooth) {
    // Every tile begins at a whole pixel of the screen, where the one before it ends.
    const edges = (start, side) => Array.from({ length: tiles + 1 }, (_, index) => Math.round((start + index * side) * devicePixelRatio));
    this.columns = edges(left, wide);
    this.rows = edges(top, high);
    this.canvas.width = Math.round(box.width * devicePixelRatio);
    this.canvas.height = Math.round(box.height * devicePixelRatio);
    this.context.imageSmoothingEnabled = smooth;
    this.paint();
  }

  paint() {
    if (this.canvas.hidden || this.video.readyState < HTMLMediaElement.HAVE_CURRENT_DATA) return;
    const { context, columns, rows, video } = this;
    for (let row = 0; row + 1 < rows.length; row += 1) {
      for (let column = 0; column + 1 < columns.length; column += 1) {
        const [x, y] = [columns[column], rows[row]];
        context.drawImage(video, x, y, columns[column + 1] - x, rows[row + 1] - y);
      }
    }
  }
}
