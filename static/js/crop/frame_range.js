// A time range in frames of a clip: whole numbers, within the clip. Of a range the video methods take at least two
// frames; still methods take the one at its first end, and leave where it ends to the clip.

import { clamp } from "../lib/clamp.js";

/** @typedef {{ first: number, count: number }} FrameRange */
/** @typedef {"range" | "first" | "last"} Part what of a range is dragged */

/**
 * A clip's number of frames, and whether what is taken of it is a video.
 *
 * @typedef {{ total: number, video: boolean }} Extent
 */

const FEWEST = 2; // frames of a video

/**
 * Make a range fit: what is too long shrinks, and then begins where it fits. Of one frame the first one counts.
 *
 * @param {FrameRange} range
 * @param {Extent} extent
 * @returns {FrameRange}
 */
export function fit({ first, count }, { total, video }) {
  if (!video) {
    const only = clamp(first, 0, total - 1);
    return { first: only, count: clamp(count, 1, total - only) };
  }
  const long = clamp(count, FEWEST, total);
  return { first: clamp(first, 0, total - long), count: long };
}

/**
 * Move a range, or one of its ends, to begin or end with a frame.
 *
 * @param {Part} part
 * @param {number} frame
 * @param {FrameRange} range
 * @param {Extent} extent
 * @returns {FrameRange}
 */
export function move(part, frame, { first, count }, extent) {
  const { total, video } = extent;
  if (part === "range") return { first: clamp(frame, 0, total - count), count };
  if (part === "last") {
    const fewest = video ? FEWEST : 1;
    return { first, count: clamp(frame, first + fewest - 1, total - 1) + 1 - first };
  }
  if (!video) return fit({ first: frame, count: total }, extent); // a video method then takes the rest
  const end = first + count;
  const begin = clamp(frame, 0, end - FEWEST);
  return { first: begin, count: end - begin };
}

/**
 * Say what had to give way to the number that was typed.
 *
 * @param {FrameRange} meant
 * @param {FrameRange} range what of it fits
 * @param {Extent} extent
 */
export function explain(meant, range, { video }) {
  if (!video) return `The last frame of the clip is ${range.first}.`;
  if (range.count > meant.count) return `A video has ${FEWEST} frames or more.`;
  if (range.count < meant.count) return `It is ${range.count} frames now: the clip has no more.`;
  return `It begins with frame ${range.first} now: from ${meant.first} on, ${meant.count} frames do not fit.`;
}
