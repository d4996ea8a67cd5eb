// The slider's splits stay in order, whatever is done to one of them.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { move, share } from "../../static/js/viewer/splits.js";

test("pictures begin with the same width each", () => {
  assert.deepEqual(share(2), [0.5]);
  assert.deepEqual(share(4), [0.25, 0.5, 0.75]);
});

test("the divider of three pictures stops at the other one, and at the stage's border", () => {
  const splits = [0.3, 0.6];
  assert.deepEqual(move(splits, 0, 0.9), [0.6, 0.6]);
  assert.deepEqual(move(splits, 1, 0.1), [0.3, 0.3]);
  assert.deepEqual(move(splits, 0, -1), [0, 0.6]);
  assert.deepEqual(move(splits, 1, 2), [0.3, 1]);
  assert.deepEqual(move(splits, 1, 0.5), [0.3, 0.5]);
  assert.deepEqual(splits, [0.3, 0.6], "what was there before stays as it was");
});

test("splits stay in ascending order from 0 to 1", () => {
  const moves = fc.array(fc.tuple(fc.nat(3), fc.double({ min: -2, max: 2, noNaN: true })), { maxLength: 20 });
  fc.assert(
    fc.property(fc.integer({ min: 2, max: 5 }), moves, (pictures, list) => {
      let splits = share(pictures);
      for (const [index, to] of list) splits = move(splits, index % splits.length, to);
      const borders = [0, ...splits, 1];
      assert.deepEqual(
        borders,
        borders.toSorted((a, b) => a - b),
      );
      assert.equal(splits.length, pictures - 1);
    }),
    { seed: 1 },
  );
});
