// What the waiting room says of an experiment's state.

import assert from "node:assert/strict";
import { test } from "node:test";
import { describe } from "../../static/js/lib/progress.js";

test("one that waits says its place in the queue", () => {
  const waiting = { status: "Waiting", percent: 0 };
  const [third, somewhere] = ["Place 3 in the queue", "In the queue"];
  assert.deepEqual(describe({ status: "queued", position: 3 }), { ...waiting, stage: third, news: third });
  assert.deepEqual(describe({ status: "queued" }), { ...waiting, stage: somewhere, news: somewhere });
});

test("one that runs says its stage and every per cent, and announces every quarter", () => {
  /** @param {number} progress */
  const at = (progress) => describe({ status: "running", progress, stage: "spot" });
  assert.deepEqual(at(0.514), { status: "Running", stage: "Spot, 51 %", percent: 51, news: "Running, 50 %" });
  assert.deepEqual(at(0.749), { status: "Running", stage: "Spot, 75 %", percent: 75, news: "Running, 75 %" });
  assert.equal(at(0.24).news, "Running, 0 %");
  assert.equal(describe({ status: "running" }).stage, "Starting, 0 %");
});

test("each end is announced as what it is", () => {
  for (const [status, words] of Object.entries({
    succeeded: "The experiment has succeeded. Loading the result …",
    failed: "The experiment has failed. Loading the result …",
    cancelled: "The experiment was cancelled. Loading the result …",
  })) {
    const { status: shown, stage, news } = describe({ status, progress: 1 });
    assert.deepEqual([shown, stage, news], ["Finished", "Loading the result …", words]);
  }
});
