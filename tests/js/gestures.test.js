// Pointers on the frame of a crop: a slip drags nothing, a drag is taken back by a second finger, and two fingers zoom.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Gestures } from "../../static/js/crop/gestures.js";

/** @type {string[]} */
let heard = [];

class Frame extends EventTarget {
  setPointerCapture() {}
}

beforeEach(() => {
  heard = [];
  Object.assign(globalThis, { HTMLElement: class {} });
});

function open() {
  const frame = new Frame();
  new Gestures(/** @type {HTMLElement} */ (/** @type {unknown} */ (frame)), {
    kind: () => "draw",
    begin: () => null,
    pull: (_drag, [x, y]) => heard.push(`pull ${x},${y}`),
    end: ({ under }) => heard.push(under ? "end" : "click"),
    cancel: ({ under }) => heard.push(under ? "cancel" : "forget"),
    grip: ([x, y]) => [x, y],
    zoom: (_grip, factor, [x, y]) => heard.push(`zoom ${factor} at ${x},${y}`),
    settle: () => heard.push("settle"),
  });
  /**
   * @param {string} type
   * @param {number} x
   * @param {number} y
   * @param {object} more
   */
  return (type, x, y, more = {}) => {
    const event = new Event(type, { cancelable: true });
    frame.dispatchEvent(
      Object.assign(event, { clientX: x, clientY: y, pointerId: 1, button: 0, pointerType: "mouse" }, more),
    );
  };
}

for (const [pointerType, slop] of /** @type {const} */ ([
  ["mouse", 4],
  ["touch", 16],
])) {
  test(`a ${pointerType} may slip by less than ${slop} pixels and drag nothing`, () => {
    const send = open();
    send("pointerdown", 100, 100, { pointerType });
    send("pointermove", 100 + slop - 1, 100 - slop + 1, { pointerType });
    assert.deepEqual(heard, []);
    send("pointerup", 100, 100, { pointerType });
    assert.deepEqual(heard, ["click"]);
  });

  test(`a ${pointerType} drags from ${slop} pixels on, also back to where it began`, () => {
    const send = open();
    send("pointerdown", 100, 100, { pointerType });
    send("pointermove", 100, 100 - slop, { pointerType });
    send("pointermove", 100, 100, { pointerType });
    send("pointerup", 100, 100, { pointerType });
    assert.deepEqual(heard, [`pull 100,${100 - slop}`, "pull 100,100", "end"]);
  });
}

test("a press is under way from before its drag begins until it ends, for what the focus moves then", () => {
  const frame = /** @type {HTMLElement} */ (/** @type {unknown} */ (new Frame()));
  /** @type {boolean[]} */
  const pressed = [];
  const ignore = () => {};
  /** @type {Gestures<number, void>} */
  const gestures = new Gestures(frame, {
    kind: () => "draw",
    begin: () => pressed.push(gestures.pressed),
    pull: ignore,
    end: ignore,
    cancel: ignore,
    grip: ignore,
    zoom: ignore,
    settle: ignore,
  });
  for (const last of ["pointerup", "pointercancel"]) {
    for (const type of ["pointerdown", last]) {
      const place = { clientX: 5, clientY: 5, pointerId: 1, button: 0, pointerType: "mouse" };
      frame.dispatchEvent(Object.assign(new Event(type, { cancelable: true }), place));
    }
    pressed.push(gestures.pressed);
  }
  assert.deepEqual(pressed, [true, false, true, false]);
});

test("fingers that part enlarge, about the place between them, and take back what the first one had begun", () => {
  const send = open();
  const [first, second] = [{ pointerType: "touch" }, { pointerType: "touch", pointerId: 2 }];
  send("pointerdown", 100, 100, first);
  send("pointermove", 130, 100, first);
  send("pointerdown", 150, 100, second);
  send("pointermove", 170, 100, second);
  send("pointerup", 130, 100, first);
  send("pointermove", 300, 300, second);
  send("pointerup", 300, 300, second);
  assert.deepEqual(heard, ["pull 130,100", "cancel", "zoom 2 at 150,100", "settle"]);
});

test("a wheel with Ctrl enlarges where it is turned away, and alone scrolls the page", () => {
  Object.assign(globalThis, { WheelEvent: { DOM_DELTA_LINE: 1 } });
  const send = open();
  send("wheel", 5, 6, { deltaY: -100, deltaMode: 0 });
  assert.deepEqual(heard, []);
  send("wheel", 5, 6, { deltaY: -100, deltaMode: 0, ctrlKey: true });
  assert.deepEqual(heard, [`zoom ${Math.E} at 5,6`, "settle"]);
});
