// Playback of a range of a clip's frames, over and over, and of single ones. Frame k is on the screen from k / rate
// seconds on.

/** @import { FrameRange } from "./frame_range.js" */

export const REDUCED = window.matchMedia("(prefers-reduced-motion: reduce)");

export class RangePlayback {
  /** @type {FrameRange} */
  range = { first: 0, count: Infinity };
  /** @type {number | null} */
  next = null; // the frame to seek once the browser has found the one before

  /**
   * @param {HTMLVideoElement} video
   * @param {number} rate
   * @param {(frame: number) => void} show takes the number of the frame that is on the screen, whenever it changes
   */
  constructor(video, rate, show) {
    this.video = video;
    this.rate = rate;
    this.show = show;
    video.controls = false; // the crop lies over them
    video.addEventListener("seeked", () => {
      const { next } = this;
      this.next = null;
      if (next !== null) this.seek(next);
    });
    // Files of MP4 have even sides: the column or row that was added lies outside the frame.
    const cover = () => {
      video.style.width = `${(100 * video.videoWidth) / video.width}%`;
      video.style.height = `${(100 * video.videoHeight) / video.height}%`;
    };
    video.addEventListener("loadedmetadata", cover);
    if (video.readyState >= HTMLMediaElement.HAVE_METADATA) cover(); // it was quicker than this script
    if ("requestVideoFrameCallback" in video) this.watch();
    else this.watchTime();
  }

  watchTime() {
    this.video.addEventListener("timeupdate", () => this.pass(this.video.currentTime));
  }

  watch() {
    this.video.requestVideoFrameCallback((_now, { mediaTime }) => {
      this.pass(mediaTime + 0.25 / this.rate); // rounding of a file's time stamps
      this.watch();
    });
  }

  get playing() {
    return !this.video.paused;
  }

  /**
   * Show a moment, and go back to the first frame at the end of the range.
   *
   * @param {number} time
   */
  pass(time) {
    const { first, count } = this.range;
    const frame = Math.floor(time * this.rate);
    this.show(frame);
    const whole = first === 0 && count >= this.video.duration * this.rate - 0.5; // the browser itself goes round
    if (this.playing && !whole && (frame < first || frame >= first + count - 1)) this.seek(first);
  }

  /** @param {number} frame */
  seek(frame) {
    if (this.video.seeking) this.next = frame;
    else this.video.currentTime = (frame + 0.5) / this.rate;
  }

  play() {
    this.video.play().catch(() => {}); // paused again before it began, or the browser saves power: the button remains
  }

  pause() {
    this.video.pause();
  }
}
