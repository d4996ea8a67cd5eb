// A time range stays whole and within its clip, and holds at least two frames where it is to be a video.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { explain, fit, move } from "../../static/js/crop/frame_range.js";

/** @import { Extent, FrameRange } from "../../static/js/crop/frame_range.js" */

const RUNS = { numRuns: 4000, seed: 1 };
const clip = fc.record({ total: fc.integer({ min: 2, max: 300 }), video: fc.boolean() });
const any = fc.integer({ min: -1000, max: 1000 });
const part = fc.constantFrom(
  /** @type {const} */ ("range"),
  /** @type {const} */ ("first"),
  /** @type {const} */ ("last"),
);

/**
 * @param {FrameRange} range
 * @param {Extent} extent
 */
function assertFits({ first, count }, { total, video }) {
  assert.ok(Number.isInteger(first) && Number.isInteger(count));
  assert.ok(first >= 0 && first + count <= total, `${first} + ${count} of ${total}`);
  assert.ok(count >= (video ? 2 : 1), `${count} frames`);
}

test("numbers that are typed are made to fit, and what fits stays as it is", () => {
  fc.assert(
    fc.property(clip, any, any, (extent, first, count) => {
      const range = fit({ first, count }, extent);
      assertFits(range, extent);
      assert.deepEqual(fit(range, extent), range);
    }),
    RUNS,
  );
});

test("a range that is dragged fits, whatever of it and however far", () => {
  fc.assert(
    fc.property(clip, any, any, part, any, (extent, first, count, dragged, to) => {
      assertFits(move(dragged, to, fit({ first, count }, extent), extent), extent);
    }),
    RUNS,
  );
});

test("the end that is not dragged stays", () => {
  fc.assert(
    fc.property(clip, any, any, any, ({ total }, first, count, to) => {
      const extent = { total, video: true };
      const before = fit({ first, count }, extent);
      const begun = move("first", to, before, extent);
      assert.equal(begun.first + begun.count, before.first + before.count);
      const ended = move("last", to, before, extent);
      assert.equal(ended.first, before.first);
      assert.equal(move("range", to, before, extent).count, before.count);
    }),
    RUNS,
  );
});

test("a video has two frames when one of its ends is dragged over the other", () => {
  const extent = { total: 48, video: true };
  assert.deepEqual(move("first", 47, { first: 10, count: 20 }, extent), { first: 28, count: 2 });
  assert.deepEqual(move("last", 0, { first: 10, count: 20 }, extent), { first: 10, count: 2 });
  assert.deepEqual(move("last", 99, { first: 10, count: 20 }, extent), { first: 10, count: 38 });
});

test("a still method takes one frame, and a video method afterwards the rest", () => {
  const extent = { total: 48, video: false };
  assert.deepEqual(move("first", 47, { first: 10, count: 20 }, extent), { first: 47, count: 1 });
  assert.deepEqual(move("first", 12, { first: 10, count: 20 }, extent), { first: 12, count: 36 });
});

test("what gave way is said", () => {
  const video = { total: 48, video: true };
  const words = (/** @type {FrameRange} */ meant) => explain(meant, fit(meant, video), video);
  assert.equal(words({ first: 0, count: 1 }), "A video has 2 frames or more.");
  assert.equal(words({ first: 0, count: 90 }), "It is 48 frames now: the clip has no more.");
  assert.equal(words({ first: 40, count: 20 }), "It begins with frame 28 now: from 40 on, 20 frames do not fit.");
  const still = { total: 48, video: false };
  const late = { first: 90, count: 1 };
  assert.equal(explain(late, fit(late, still), still), "The last frame of the clip is 47.");
});
