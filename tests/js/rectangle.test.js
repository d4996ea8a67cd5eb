// A crop stays whole, within its photograph and at least 1 × 1, whatever is drawn, dragged or typed.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { explain, fit, move, parse, resize, same, span } from "../../static/js/crop/rectangle.js";

/** @import { Rectangle, Size } from "../../static/js/crop/rectangle.js" */

const EDGES = ["n", "ne", "e", "se", "s", "sw", "w", "nw"];
const RUNS = { numRuns: 4000, seed: 1 };
const size = fc.record({ width: fc.integer({ min: 1, max: 400 }), height: fc.integer({ min: 1, max: 400 }) });
const far = fc.double({ min: -1000, max: 1000, noNaN: true });
const typed = fc.integer({ min: -1000, max: 1000 });
const point = fc.record({ x: far, y: far });

/** A photograph with a crop of it. */
const cropped = size.chain(({ width, height }) =>
  fc
    .record({
      x: fc.integer({ min: 0, max: width - 1 }),
      y: fc.integer({ min: 0, max: height - 1 }),
      right: fc.integer({ min: 1, max: width }),
      bottom: fc.integer({ min: 1, max: height }),
    })
    .map(({ x, y, right, bottom }) => ({
      size: { width, height },
      crop: { x, y, width: Math.max(1, right - x), height: Math.max(1, bottom - y) },
    })),
);

/**
 * @param {Rectangle} crop
 * @param {Size} photograph
 */
function assertFits(crop, photograph) {
  assert.ok(Object.values(crop).every(Number.isInteger), JSON.stringify(crop));
  assert.ok(crop.x >= 0 && crop.y >= 0 && crop.width >= 1 && crop.height >= 1, JSON.stringify(crop));
  assert.ok(crop.x + crop.width <= photograph.width, JSON.stringify(crop));
  assert.ok(crop.y + crop.height <= photograph.height, JSON.stringify(crop));
}

test("a crop that is drawn fits", () => {
  fc.assert(
    fc.property(size, point, point, (photograph, a, b) => assertFits(span(a, b, photograph), photograph)),
    RUNS,
  );
});

test("a crop that is drawn holds what lies between its corners, to half a pixel, from wherever it was drawn", () => {
  const within = fc.double({ min: 0, max: 300, noNaN: true });
  const corner = fc.record({ x: within, y: within });
  fc.assert(
    fc.property(corner, corner, (a, b) => {
      const photograph = { width: 300, height: 300 };
      const crop = span(a, b, photograph);
      assert.deepEqual(span(b, a, photograph), crop);
      if (Math.abs(a.x - b.x) < 2) return;
      assert.ok(Math.abs(crop.x - Math.min(a.x, b.x)) <= 0.5);
      assert.ok(Math.abs(crop.x + crop.width - Math.max(a.x, b.x)) <= 0.5);
    }),
    RUNS,
  );
});

test("a press that draws nothing is a crop of one pixel, also in the last corner", () => {
  const photograph = { width: 30, height: 20 };
  assert.deepEqual(span({ x: 7, y: 5 }, { x: 7, y: 5 }, photograph), { x: 7, y: 5, width: 1, height: 1 });
  assert.deepEqual(span({ x: 99, y: 99 }, { x: 99, y: 99 }, photograph), { x: 29, y: 19, width: 1, height: 1 });
});

test("a crop that is moved fits, and keeps its size", () => {
  fc.assert(
    fc.property(cropped, far, far, ({ crop, size: photograph }, dx, dy) => {
      const after = move(crop, dx, dy, photograph);
      assertFits(after, photograph);
      assert.deepEqual([after.width, after.height], [crop.width, crop.height]);
    }),
    RUNS,
  );
});

test("a crop whose edges are dragged fits, and the edges that are not dragged stay", () => {
  fc.assert(
    fc.property(cropped, fc.constantFrom(...EDGES), far, far, ({ crop, size: photograph }, edges, dx, dy) => {
      const after = resize(crop, edges, dx, dy, photograph);
      assertFits(after, photograph);
      if (!edges.includes("w")) assert.equal(after.x, crop.x);
      if (!edges.includes("n")) assert.equal(after.y, crop.y);
      if (!edges.includes("e")) assert.equal(after.x + after.width, crop.x + crop.width);
      if (!edges.includes("s")) assert.equal(after.y + after.height, crop.y + crop.height);
    }),
    RUNS,
  );
});

test("an edge that is dragged over the opposite one stops a pixel before it, and at the border on its own side", () => {
  const photograph = { width: 100, height: 80 };
  const crop = { x: 20, y: 10, width: 30, height: 40 };
  assert.deepEqual(resize(crop, "w", 500, 0, photograph), { x: 49, y: 10, width: 1, height: 40 });
  assert.deepEqual(resize(crop, "e", -500, 0, photograph), { x: 20, y: 10, width: 1, height: 40 });
  assert.deepEqual(resize(crop, "n", 0, 500, photograph), { x: 20, y: 49, width: 30, height: 1 });
  assert.deepEqual(resize(crop, "s", 0, -500, photograph), { x: 20, y: 10, width: 30, height: 1 });
  assert.deepEqual(resize(crop, "nw", -500, -500, photograph), { x: 0, y: 0, width: 50, height: 50 });
  assert.deepEqual(resize(crop, "se", 500, 500, photograph), { x: 20, y: 10, width: 80, height: 70 });
});

test("numbers that are typed are made to fit, and those that fit stay as they are", () => {
  const numbers = fc.record({ x: typed, y: typed, width: typed, height: typed });
  fc.assert(
    fc.property(size, numbers, (photograph, crop) => assertFits(fit(crop, photograph), photograph)),
    RUNS,
  );
  fc.assert(
    fc.property(cropped, ({ crop, size: photograph }) => assert.deepEqual(fit(crop, photograph), crop)),
    RUNS,
  );
});

test("what is too long moves before it shrinks", () => {
  const photograph = { width: 100, height: 80 };
  assert.deepEqual(fit({ x: 90, y: 0, width: 30, height: 80 }, photograph), { x: 70, y: 0, width: 30, height: 80 });
  assert.deepEqual(fit({ x: 90, y: 0, width: 300, height: 9 }, photograph), { x: 0, y: 0, width: 100, height: 9 });
});

test("what gave way is named by its own side", () => {
  const photograph = { width: 100, height: 80 };
  const long = { x: 90, y: 0, width: 30, height: 20 };
  assert.equal(explain("width", long, fit(long, photograph)), "x is 70 now: from 90 on, a width of 30 does not fit.");
  const high = { x: 0, y: 70, width: 30, height: 20 };
  assert.equal(explain("y", high, fit(high, photograph)), "y is 60 now: from 70 on, a height of 20 does not fit.");
  const large = { x: 0, y: 0, width: 30, height: 200 };
  assert.equal(explain("height", large, fit(large, photograph)), "The height is 80 now: there is no more.");
});

test("crops are the same if all four numbers are", () => {
  const crop = { x: 1, y: 2, width: 3, height: 4 };
  assert.ok(same(crop, { ...crop }));
  for (const side of /** @type {const} */ (["x", "y", "width", "height"])) {
    assert.ok(!same(crop, { ...crop, [side]: 9 }), side);
  }
});

test("a crop is read as it is written", () => {
  assert.deepEqual(parse("1,2,30,40"), { x: 1, y: 2, width: 30, height: 40 });
  for (const text of ["", "1,2,3"]) assert.equal(parse(text), null);
});
