// Videos that play in step: whoever is ahead waits for the slowest.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { pace } from "../../static/js/viewer/pacing.js";

test("in step, all play at the same pace", () => {
  assert.deepEqual(pace([10, 10.4, 10.5], 24), [24, 24, 24]);
});

test("a little ahead is slowed down, far ahead waits", () => {
  assert.deepEqual(pace([10, 11, 12, 12.1, 90], 20), [20, 16, 16, 0, 0]);
});

test("from whatever distance, they come within half a frame of each other, and the slowest never waits", () => {
  const start = fc.array(fc.double({ min: 0, max: 60, noNaN: true }), { minLength: 2, maxLength: 4 });
  fc.assert(
    fc.property(start, (begin) => {
      let positions = begin;
      for (let step = 0; step < 60 * 20; step += 1) {
        const paces = pace(positions, 24);
        assert.equal(paces[positions.indexOf(Math.min(...positions))], 24);
        positions = positions.map((position, index) => position + (paces[index] ?? NaN) / 60);
      }
      assert.ok(Math.max(...positions) - Math.min(...positions) <= 0.5 + 24 / 60);
    }),
    { numRuns: 100, seed: 1 },
  );
});
