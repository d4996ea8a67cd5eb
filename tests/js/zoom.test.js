// The zoom of the crop's photograph: a point that is held stays where it is, and nothing beyond the photograph is seen.

import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { Zoom } from "../../static/js/crop/zoom.js";

const RUNS = { numRuns: 2000, seed: 1 };
const SIZE = { width: 600, height: 400 };
const BASE = 0.5;

const make = () => {
  const zoom = new Zoom();
  zoom.layOut(SIZE, BASE);
  return zoom;
};

/** @param {Zoom} zoom */
function assertWithin({ x, y, times }) {
  const slack = 1e-9;
  assert.ok(x >= 0 && x + SIZE.width / times <= SIZE.width + slack, `x ${x}, ${times} times`);
  assert.ok(y >= 0 && y + SIZE.height / times <= SIZE.height + slack, `y ${y}, ${times} times`);
}

test("whatever is held wherever, the frame shows nothing beyond the photograph, at 1 × to 8 pixels a pixel", () => {
  const far = fc.double({ min: -2000, max: 2000, noNaN: true });
  fc.assert(
    fc.property(far, far, far, far, fc.double({ min: 0.01, max: 100, noNaN: true }), (x, y, across, down, times) => {
      const zoom = make();
      zoom.hold({ x, y }, across, down, times);
      assertWithin(zoom);
      assert.ok(zoom.times >= 1 && zoom.scale <= 8);
      assert.equal(zoom.largest, zoom.scale === 8);
    }),
    RUNS,
  );
});

test("a point about which one zooms in stays where it is", () => {
  const within = fc.double({ min: 0, max: 1, noNaN: true });
  fc.assert(
    fc.property(within, within, fc.double({ min: 1, max: 4, noNaN: true }), (across, down, factor) => {
      const zoom = make();
      zoom.hold({ x: 300, y: 200 }, 150, 100, 3); // enlarged about the middle already, to 1.5 screen pixels a pixel
      const point = { x: zoom.x + (across * SIZE.width) / 3, y: zoom.y + (down * SIZE.height) / 3 };
      const place = [(point.x - zoom.x) * zoom.scale, (point.y - zoom.y) * zoom.scale];
      zoom.about(factor, point);
      assert.equal(zoom.times, 3 * factor);
      for (const [axis, at] of [(point.x - zoom.x) * zoom.scale, (point.y - zoom.y) * zoom.scale].entries()) {
        assert.ok(Math.abs(at - (place[axis] ?? NaN)) < 1e-6);
      }
    }),
    RUNS,
  );
});

test("a crop is brought into view, and one that is too large by its middle", () => {
  const zoom = make();
  zoom.hold({ x: 0, y: 0 }, 0, 0, 4); // 150 × 100 pixels are seen
  zoom.reveal({ x: 500, y: 300, width: 50, height: 50 });
  assert.deepEqual([zoom.x, zoom.y], [400, 250]);
  zoom.reveal({ x: 410, y: 260, width: 50, height: 50 });
  assert.deepEqual([zoom.x, zoom.y], [400, 250], "what is seen already stays where it is");
  zoom.reveal({ x: 100, y: 40, width: 300, height: 10 });
  assert.deepEqual([zoom.x, zoom.y], [175, 40]);
});

test("all of a photograph is seen again", () => {
  const zoom = make();
  zoom.about(3, { x: 500, y: 300 });
  assert.ok(zoom.zoomed);
  zoom.whole();
  assert.deepEqual([zoom.times, zoom.x, zoom.y, zoom.zoomed], [1, 0, 0, false]);
});
