// An experiment is followed to its end by events, and by asking where these fail or are held back.

import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { feed } from "../../static/js/lib/experiment_feed.js";

/** @import { State } from "../../static/js/lib/experiment_feed.js" */

class FakeEventSource extends EventTarget {
  /** @type {FakeEventSource[]} */
  static opened = [];
  closed = false;

  /** @param {string} address */
  constructor(address) {
    super();
    this.address = address;
    FakeEventSource.opened.push(this);
  }

  close() {
    this.closed = true;
  }

  /**
   * @param {string} name
   * @param {State} state
   */
  send(name, state) {
    this.dispatchEvent(new MessageEvent(name, { data: JSON.stringify(state) }));
  }

  fail() {
    this.dispatchEvent(new Event("error"));
  }
}

/** @type {State[]} */
let shown = [];
let lost = 0;
/** @type {string[]} */
let asked = [];
/** @type {() => Response} */
let answer = () => Response.error();
let now = 0;

beforeEach(() => {
  [shown, lost, asked, now] = [[], 0, [], 0];
  FakeEventSource.opened = [];
  mock.timers.enable({ apis: ["setInterval", "setTimeout"] });
  mock.method(performance, "now", () => now);
  mock.method(globalThis, "fetch", (/** @type {string} */ address) => {
    asked.push(address);
    return Promise.resolve(answer());
  });
  Object.assign(globalThis, { EventSource: FakeEventSource, reportError: assert.fail });
});
afterEach(() => {
  mock.timers.reset();
  mock.restoreAll();
});

/** @param {State} state */
const respond = (state) => () => new Response(JSON.stringify(state), { status: 200 });

function open() {
  feed("/api/v1/experiments/x", {
    show: (state) => shown.push(state),
    lose: () => {
      lost += 1;
    },
  });
  return FakeEventSource.opened[0] ?? assert.fail("no event source");
}

/**
 * Let time go by, and what was asked be answered.
 *
 * @param {number} milliseconds
 */
async function pass(milliseconds) {
  for (let left = milliseconds; left > 0; left -= 250) {
    now += 250;
    mock.timers.tick(250);
    for (let turn = 0; turn < 20; turn += 1) await Promise.resolve();
    await new Promise((over) => setImmediate(over));
  }
}

test("every event is shown, and after the end nothing is asked or shown any more", async () => {
  const source = open();
  assert.equal(source.address, "/api/v1/experiments/x/events");
  source.send("status", { status: "queued", position: 2 });
  source.send("progress", { status: "running", progress: 0.5 });
  source.send("end", { status: "succeeded" });
  source.send("message", { status: "running", progress: 0.6 });
  assert.deepEqual(
    shown.map(({ status }) => status),
    ["queued", "running", "succeeded"],
  );
  assert.ok(source.closed);
  source.fail();
  await pass(20_000);
  assert.deepEqual(asked, []);
});

test("after five seconds of silence the record is asked for, and not before", async () => {
  const source = open();
  answer = respond({ status: "running", progress: 0.25 });
  await pass(3000);
  source.send("progress", { status: "running", progress: 0.1 });
  await pass(4750);
  assert.equal(asked.length, 0);
  await pass(250);
  assert.deepEqual(asked, ["/api/v1/experiments/x"]);
  assert.equal(shown.at(-1)?.progress, 0.25);
  await pass(4750);
  assert.equal(asked.length, 1);
});

test("where events fail it is asked once a second, until they come again", async () => {
  const source = open();
  answer = respond({ status: "running", progress: 0.25 });
  source.fail();
  source.fail();
  await pass(3000);
  assert.equal(asked.length, 3);
  source.send("progress", { status: "running", progress: 0.3 });
  await pass(4000);
  assert.equal(asked.length, 3);
  source.send("progress", { status: "running", progress: 0.4 });
  source.fail();
  await pass(1000);
  assert.equal(asked.length, 4);
});

test("an end that was missed is noticed by asking", async () => {
  const source = open();
  source.fail();
  answer = respond({ status: "failed" });
  await pass(1000);
  assert.deepEqual(shown, [{ status: "failed" }]);
  assert.ok(source.closed);
  await pass(20_000);
  assert.equal(asked.length, 1);
});

for (const status of [404, 410]) {
  test(`one that is gone (${status}) was cancelled`, async () => {
    open().fail();
    answer = () => new Response(JSON.stringify({ detail: "It was deleted." }), { status });
    await pass(1000);
    assert.deepEqual(shown, [{ status: "cancelled" }]);
    assert.equal(lost, 0);
  });
}

test("an answer that is none says that the connection broke, and it is asked again", async () => {
  open().fail();
  answer = () => new Response("<html>", { status: 502 });
  await pass(2000);
  assert.equal(lost, 2);
  assert.deepEqual(shown, []);
  answer = respond({ status: "running", progress: 0.25 });
  await pass(1000);
  assert.equal(shown.length, 1);
});

test("a browser without events asks every second", async () => {
  Reflect.deleteProperty(globalThis, "EventSource");
  answer = respond({ status: "running", progress: 0.25 });
  feed("/api/v1/experiments/x", { show: (state) => shown.push(state), lose: assert.fail });
  await pass(2000);
  assert.equal(shown.length, 2);
});
