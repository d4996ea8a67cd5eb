// A video that counts in frames, and goes on counting when it has looped.

/**
 * @param {number} value
 * @param {number} count
 */
const modulo = (value, count) => ((value % count) + count) % count;

export class LoopingVideo {
  laps = 0;
  last = 0; // seconds of the video when it was last looked at

  /** @param {HTMLVideoElement} video */
  constructor(video) {
    this.video = video;
    this.count = Number(video.dataset.frames);
    this.rate = Number(video.dataset.rate);
    video.controls = false;
    video.preload = "auto";
    // No source yet, or none that can be played? The state does not tell these apart; the events of loading anew will.
    const { NETWORK_EMPTY, NETWORK_NO_SOURCE } = HTMLMediaElement;
    if (video.networkState === NETWORK_EMPTY || video.networkState === NETWORK_NO_SOURCE) video.load();
  }

  /** Frames since the first one, with a fraction. */
  get position() {
    const time = this.video.currentTime;
    if (time < this.last - this.count / this.rate / 2) this.laps += 1;
    this.last = time;
    return this.laps * this.count + Math.min(time * this.rate, this.count);
  }

  /**
   * Show the frame at a whole position. Its middle is asked for: files write a frame's begin with rounded digits.
   *
   * @param {number} position
   */
  go(position) {
    this.laps = Math.floor(position / this.count);
    this.last = (modulo(position, this.count) + 0.5) / this.rate;
    this.video.currentTime = this.last;
  }

  /**
   * Which of its own frames stands at a whole position.
   *
   * @param {number} position
   */
  frame(position) {
    return modulo(position, this.count);
  }

  /**
   * Play at so many frames a second; 0 waits.
   *
   * @param {number} frames
   */
  pace(frames) {
    const speed = frames / this.rate;
    if (this.video.playbackRate !== speed) this.video.playbackRate = speed;
  }
}
