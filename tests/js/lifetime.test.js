// An observer lets go once its part of the page has been taken away.

import assert from "node:assert/strict";
import { test } from "node:test";
import { observe } from "../../static/js/lib/lifetime.js";

function watch() {
  /** @type {string[]} */
  const heard = [];
  const observer = { observe: () => heard.push("observe"), disconnect: () => heard.push("disconnect") };
  const life = new AbortController();
  const start = () =>
    observe(
      /** @type {ResizeObserver} */ (/** @type {unknown} */ (observer)),
      /** @type {Element} */ ({}),
      life.signal,
    );
  return { heard, life, start };
}

test("it observes until then", () => {
  const { heard, life, start } = watch();
  start();
  assert.deepEqual(heard, ["observe"]);
  life.abort();
  assert.deepEqual(heard, ["observe", "disconnect"]);
});

test("what has been taken away already is not observed", () => {
  const { heard, life, start } = watch();
  life.abort();
  start();
  assert.deepEqual(heard, []);
});
