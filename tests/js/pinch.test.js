// Two fingers that part enlarge, about the place between them; and so does a wheel that is turned away.

import assert from "node:assert/strict";
import { test } from "node:test";
import { distance, middle, pinch } from "../../static/js/lib/pinch.js";
import { wheelFactor } from "../../static/js/viewer/pan_zoom.js";

test("twice as far apart is twice as large, half as far half as large", () => {
  assert.equal(pinch([110, 50], [120, 50], [100, 50]).factor, 2);
  assert.equal(pinch([120, 50], [110, 50], [100, 50]).factor, 0.5);
  assert.equal(pinch([100, 20], [100, 5], [100, 10]).factor, 0.5);
});

test("what lies between the fingers moves half as far as the one that moves", () => {
  assert.deepEqual(pinch([110, 50], [120, 60], [100, 50]), {
    dx: 5,
    dy: 5,
    about: [110, 55],
    factor: Math.hypot(20, 10) / 10,
  });
});

test("fingers upon each other are one pixel apart", () => {
  assert.equal(distance([3, 4], [3, 4]), 1);
  assert.equal(distance([0, 0], [3, 4]), 5);
  assert.deepEqual(middle([0, 0], [3, 4]), [1.5, 2]);
});

test("a wheel turned away from oneself enlarges, the other way round it takes that back", () => {
  const [away, back] = [-120, 120].map((deltaY) => wheelFactor({ deltaY, deltaMode: 0, ctrlKey: false }));
  assert.ok(away && back && away > 1);
  assert.ok(Math.abs(away * back - 1) < 1e-12);
});

test("lines count as 16 pixels, and the small steps of a trackpad's pinch five times", () => {
  const pixels = { deltaY: -48, deltaMode: 0, ctrlKey: false };
  assert.equal(wheelFactor({ deltaY: -3, deltaMode: 1, ctrlKey: false }), wheelFactor(pixels));
  assert.equal(wheelFactor({ deltaY: -10, deltaMode: 0, ctrlKey: true }), Math.exp(0.1));
  assert.ok(wheelFactor({ deltaY: -60, deltaMode: 0, ctrlKey: true }) < Math.exp(0.2));
});
