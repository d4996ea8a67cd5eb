// The viewer's geometry, against what it is to look like: tiles that fit, a cut where its divider is, a zoom that holds what lies
// under the pointer, and a pan that keeps the pictures in sight.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { LARGEST, cut, fit, lay, pan, zoom } from "../../static/js/viewer/geometry.js";

/** @import { View } from "../../static/js/viewer/geometry.js" */

const RUNS = { numRuns: 3000, seed: 1 };
const size = fc.record({ width: fc.integer({ min: 1, max: 4096 }), height: fc.integer({ min: 1, max: 4096 }) });
const room = fc.record({ width: fc.integer({ min: 64, max: 2000 }), height: fc.integer({ min: 64, max: 1200 }) });
const tiles = fc.constantFrom(1, 2, 3);
const view = fc.record({
  scale: fc.double({ min: 0.05, max: 16, noNaN: true }),
  x: fc.double({ min: -500, max: 500, noNaN: true }),
  y: fc.double({ min: -500, max: 500, noNaN: true }),
});

/**
 * @param {number} one
 * @param {number} other
 * @param {number} slack
 */
function assertNear(one, other, slack = 1e-6 * (1 + Math.abs(other))) {
  assert.ok(Math.abs(one - other) <= slack, `${one} and ${other}`);
}

/**
 * Where on the stage a point of a picture is, from the stage's centre.
 *
 * @param {View} at
 * @param {number} x from the picture's centre
 */
const placeOf = ({ scale, x: centre }, x) => (x - centre) * scale;

test("all tiles of all pictures fit the stage, with some ground around them", () => {
  fc.assert(
    fc.property(fc.array(size, { minLength: 1, maxLength: 3 }), room, tiles, (pictures, stage, count) => {
      const scale = fit(pictures, stage, count);
      for (const { width, height } of pictures) {
        assert.ok(width * count * scale <= stage.width - 4 + 1e-9, `${width} × ${count} at ${scale}`);
        assert.ok(height * count * scale <= stage.height - 4 + 1e-9, `${height} × ${count} at ${scale}`);
      }
    }),
    RUNS,
  );
});

test("small pictures are enlarged by whole numbers, four times at most; large ones fill the stage", () => {
  const stage = { width: 1000, height: 1000 };
  assert.equal(fit([{ width: 8, height: 8 }], stage, 1), 4);
  assert.equal(fit([{ width: 300, height: 300 }], stage, 1), 3);
  assert.equal(fit([{ width: 300, height: 300 }], stage, 3), 1);
  assert.equal(fit([{ width: 1936, height: 8 }], stage, 1), 0.5);
  assert.equal(fit([{ width: 968, height: 8 }], stage, 2), 0.5);
});

test("what lies under the pointer stays there while one zooms, also where the pictures have been moved", () => {
  const near = fc.double({ min: -400, max: 400, noNaN: true });
  fc.assert(
    fc.property(view, fc.double({ min: 0.2, max: 5, noNaN: true }), near, near, (before, factor, x, y) => {
      const after = zoom(before, factor, x, y, 1);
      assertNear(placeOf(after, before.x + x / before.scale), x);
      assertNear((before.y + y / before.scale - after.y) * after.scale, y);
    }),
    RUNS,
  );
});

test("a zoom ends at 16 pixels a pixel, and at a quarter or where all is seen", () => {
  const begin = { scale: 1, x: 0, y: 0 };
  assert.equal(zoom(begin, 1000, 0, 0, 1).scale, LARGEST);
  assert.equal(zoom(begin, 0.001, 0, 0, 1).scale, 0.25);
  assert.equal(zoom(begin, 0.001, 0, 0, 0.1).scale, 0.1);
  assert.equal(zoom(begin, 2, 0, 0, 1).scale, 2);
});

test("a pan moves by what the pointer does, on the screen", () => {
  const after = pan({ scale: 4, x: 10, y: 20 }, 8, -12, [{ width: 200, height: 200 }], 1);
  assert.deepEqual(after, { scale: 4, x: 8, y: 23 });
});

test("however far they are thrown, the largest picture reaches the middle of the stage", () => {
  const far = fc.double({ min: -1e5, max: 1e5, noNaN: true });
  fc.assert(
    fc.property(
      fc.array(size, { minLength: 1, maxLength: 3 }),
      view,
      far,
      far,
      tiles,
      (pictures, at, dx, dy, count) => {
        const { x, y } = pan(at, dx, dy, pictures, count);
        assert.ok(Math.abs(x) <= (count * Math.max(...pictures.map(({ width }) => width))) / 2);
        assert.ok(Math.abs(y) <= (count * Math.max(...pictures.map(({ height }) => height))) / 2);
      },
    ),
    RUNS,
  );
});

test("a pan stops where the border of the largest picture, in all its tiles, is in the middle of the stage", () => {
  const pictures = [
    { width: 100, height: 300 },
    { width: 200, height: 50 },
  ];
  const far = 1e6;
  assert.deepEqual(pan({ scale: 2, x: 0, y: 0 }, far, far, pictures, 3), { scale: 2, x: -300, y: -450 });
  assert.deepEqual(pan({ scale: 2, x: 0, y: 0 }, -far, -far, pictures, 3), { scale: 2, x: 300, y: 450 });
});

test("pictures lie by their centres, at whole pixels of the screen", () => {
  fc.assert(
    fc.property(size, room, view, tiles, fc.constantFrom(1, 1.5, 2), (picture, stage, at, count, ratio) => {
      const laid = lay(picture, stage, at, count, ratio);
      assertNear(laid.left + laid.width / 2, stage.width / 2 - at.x * at.scale, 0.5 / ratio + 1e-6);
      assertNear(laid.top + laid.height / 2, stage.height / 2 - at.y * at.scale, 0.5 / ratio + 1e-6);
      assertNear(laid.left * ratio, Math.round(laid.left * ratio));
      assertNear(laid.top * ratio, Math.round(laid.top * ratio));
    }),
    RUNS,
  );
});

test("a picture is cut where the divider is, however it is zoomed and moved", () => {
  const part = fc.double({ min: 0, max: 1, noNaN: true });
  fc.assert(
    fc.property(size, room, view, part, part, (picture, stage, at, a, b) => {
      const [from, to] = [Math.min(a, b) * stage.width, Math.max(a, b) * stage.width];
      const laid = lay(picture, stage, at, 1, 1);
      const { left, right } = cut(laid, at.scale, from, to);
      const [begins, ends] = [laid.left + left * at.scale, laid.left + (picture.width - right) * at.scale];
      assertNear(begins, Math.max(from, laid.left));
      assertNear(ends, Math.min(to, laid.left + laid.width));
    }),
    RUNS,
  );
});

test("a picture that has been moved is cut in its own pixels", () => {
  const laid = lay({ width: 100, height: 100 }, { width: 400, height: 400 }, { scale: 2, x: 10, y: 0 }, 1, 1);
  assert.equal(laid.left, 80); // 200 - 100 - 2 · 10
  assert.deepEqual(cut(laid, 2, 100, 200), { left: 10, right: 40 });
});
