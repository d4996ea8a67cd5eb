// Pacing of videos that play in step: those ahead of the slowest are slowed down, or wait for it.

const [AHEAD, FAR] = [0.5, 2]; // frames
const SLOWED = 0.8; // speed of a video that is a little ahead

/**
 * At how many frames a second each video is to play.
 *
 * @param {number[]} positions in frames
 * @param {number} rate frames a second that all of them play at once they are in step
 */
export function pace(positions, rate) {
  const slowest = Math.min(...positions);
  return positions.map((position) => {
    const ahead = position - slowest;
    if (ahead > FAR) return 0;
    return ahead > AHEAD ? rate * SLOWED : rate;
  });
}
