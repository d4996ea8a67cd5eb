// The range of a clip’s frames that plays over and over, beside its crop, and single frames of it. Frame k is on the screen from
// k / rate seconds on.

export const REDUCED = window.matchMedia("(prefers-reduced-motion: reduce)");

/** `told` is called with the number of the frame that is on the screen, whenever it changes. */
export class RangePlayback {
  constructor(video, rate, told) {
    Object.assign(this, { video, rate, told });
    this.range = { first: 0, count: Infinity };
    this.next = null; // the frame to seek once the browser has found the one before
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
    if (video.requestVideoFrameCallback) this.watch();
    else video.addEventListener("timeupdate", () => this.passed(video.currentTime));
  }

  watch() {
    this.video.requestVideoFrameCallback((now, { mediaTime }) => {
      this.passed(mediaTime + 0.25 / this.rate); // rounding of a file's time stamps
      this.watch();
    });
  }

  get playing() {
    return !this.video.paused;
  }

  passed(time) {
    const { first, count } = this.range;
    const frame = Math.floor(time * this.rate);
    this.told(frame);
    const whole = first === 0 && this.end >= this.video.duration * this.rate - 0.5; // the browser itself goes round
    if (this.playing && !whole && (frame < first || frame >= first + count - 1)) this.seek(first);
  }

  get end() {
    return this.range.first + this.range.count;
  }

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
