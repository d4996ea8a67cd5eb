// Undo gives back every change in turn, and redo makes it again.

import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../../static/js/crop/history.js";

/** @param {number} x */
const crop = (x) => ({ x, y: 0, width: 1, height: 1 });

/**
 * @param {number} count
 */
function make(count) {
  const history = new History(crop(0));
  for (let x = 1; x <= count; x += 1) history.keep(crop(x));
  return history;
}

test("undo and redo walk over all changes, and stop at both ends", () => {
  const history = make(3);
  const back = [];
  for (let step = 0; step < 5; step += 1) {
    history.undo();
    back.push(history.now.x);
  }
  assert.deepEqual(back, [2, 1, 0, 0, 0]);
  const forth = [];
  for (let step = 0; step < 5; step += 1) {
    history.redo();
    forth.push(history.now.x);
  }
  assert.deepEqual(forth, [1, 2, 3, 3, 3]);
});

test("a change after undo begins a new way forth", () => {
  const history = make(3);
  history.undo();
  history.keep(crop(9));
  history.redo();
  assert.equal(history.now.x, 9);
  history.undo();
  assert.equal(history.now.x, 2);
});

test("what goes on is one change, and what changes nothing is none", () => {
  const history = make(1);
  history.keep(crop(1));
  history.keep(crop(2));
  history.keep(crop(3), true);
  history.keep(crop(4), true);
  history.undo();
  assert.equal(history.now.x, 1);
});

test("a hundred changes are kept", () => {
  const history = make(150);
  for (let step = 0; step < 200; step += 1) history.undo();
  assert.equal(history.now.x, 50);
});
