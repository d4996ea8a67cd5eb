// Answers of the service are told from those of what stands in front of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Refusal, read } from "../../static/js/lib/answers.js";

/**
 * @param {number} status
 * @param {string} text
 */
function refuse(status, text) {
  try {
    read(status, text);
  } catch (error) {
    if (error instanceof Refusal) return error;
  }
  return assert.fail("it was not refused");
}

test("a record is read", () => {
  assert.deepEqual(read(200, '{"id": "x"}'), { id: "x" });
  assert.deepEqual(read(201, "[]"), []);
});

test("the service's own reason is passed on, and final where it is about what was sent", () => {
  const problem = JSON.stringify({ detail: "There is no such sample." });
  for (const [status, final] of /** @type {const} */ ([
    [404, true],
    [422, true],
    [429, false],
    [500, false],
    [503, false],
  ])) {
    const refusal = refuse(status, problem);
    assert.deepEqual([refusal.message, refusal.status, refusal.final], ["There is no such sample.", status, final]);
  }
});

test("no answer, and one of somebody else, are said to be so and not final", () => {
  for (const [status, text, words] of /** @type {const} */ ([
    [0, "", /connection broke/],
    [200, "<html>", /answered in its place/],
    [200, "7", /answered in its place/],
    [403, "<html>", /wants a login/],
    [413, "null", /too large/],
    [502, '{"detail": 7}', /cannot be reached/],
    [418, "", /answered 418 without a reason/],
  ])) {
    const refusal = refuse(status, text);
    assert.match(refusal.message, words);
    assert.equal(refusal.final, false);
  }
});
