// Pan and zoom by mouse, touch and keyboard, on any of several stages.

import { pinch, placeOf } from "../lib/pinch.js";

/** @import { Place } from "../lib/pinch.js" */

const STEP = 48; // screen pixels an arrow key pans by
const NOTCH = 50; // screen pixels: less than this is a trackpad's pinch, which comes as small steps with Ctrl
const LINE = 16; // screen pixels of a line that a wheel scrolls
/** @type {Record<string, Place>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * What pans and zooms.
 *
 * @typedef {object} Movable
 * @property {(dx: number, dy: number) => void} pan by screen pixels
 * @property {(factor: number, x: number, y: number) => void} zoom about a place, in screen pixels from the stage's centre
 * @property {() => void} one shows every pixel once
 * @property {() => void} fit
 * @property {() => void} flip
 * @property {() => boolean} focused whether the wheel alone zooms; otherwise it scrolls the page, as it does everywhere
 */

/**
 * Where a place is on a stage, from the stage's centre.
 *
 * @param {HTMLElement} stage
 * @param {Place} place
 * @returns {Place}
 */
function centre(stage, [x, y]) {
  const bounds = stage.getBoundingClientRect();
  return [x - bounds.left - bounds.width / 2, y - bounds.top - bounds.height / 2];
}

/**
 * How often a turn of the wheel enlarges: turned away from oneself, or spread on a trackpad, more than once.
 *
 * @param {{ deltaY: number, deltaMode: number, ctrlKey: boolean }} event
 */
export function wheelFactor({ deltaY, deltaMode, ctrlKey }) {
  const turn = deltaY * (deltaMode === 1 ? LINE : 1); // WheelEvent.DOM_DELTA_LINE
  const speed = ctrlKey && Math.abs(turn) < NOTCH ? 0.01 : 0.002;
  return Math.exp(-turn * speed);
}

/**
 * Pan and zoom by what pointers and wheels do on a stage.
 *
 * @param {HTMLElement} stage
 * @param {Movable} on
 */
export function listen(stage, on) {
  /** @type {Map<number, Place>} */
  const down = new Map();

  /** @param {WheelEvent} event */
  function wheel(event) {
    if (!event.ctrlKey && !event.metaKey && !on.focused()) return;
    event.preventDefault();
    on.zoom(wheelFactor(event), ...centre(stage, placeOf(event)));
  }

  /** @param {PointerEvent} event */
  function press(event) {
    if (event.button !== 0 || (event.target instanceof Element && event.target.closest(".divider"))) return;
    down.set(event.pointerId, placeOf(event));
    stage.setPointerCapture(event.pointerId);
    stage.classList.add("held");
  }

  /** @param {PointerEvent} event */
  function move(event) {
    const before = down.get(event.pointerId);
    if (!before) return;
    const now = placeOf(event);
    down.set(event.pointerId, now);
    const [other] = [...down].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    if (!other) {
      on.pan(now[0] - before[0], now[1] - before[1]);
      return;
    }
    const { dx, dy, factor, about } = pinch(before, now, other);
    on.pan(dx, dy);
    on.zoom(factor, ...centre(stage, about));
  }

  /** @param {PointerEvent} event */
  function lift(event) {
    down.delete(event.pointerId);
    if (!down.size) stage.classList.remove("held");
  }

  stage.addEventListener("wheel", wheel, { passive: false });
  stage.addEventListener("pointerdown", press);
  stage.addEventListener("pointermove", move);
  stage.addEventListener("pointerup", lift);
  stage.addEventListener("pointercancel", lift);
}

/**
 * The same by keys, on what holds the stages.
 *
 * @param {HTMLElement} element
 * @param {Movable} on
 */
export function listenToKeys(element, on) {
  element.addEventListener("keydown", (event) => {
    if (event.target !== element || event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = ARROWS[event.key];
    if (arrow) on.pan(-arrow[0] * STEP, -arrow[1] * STEP);
    else if (event.key === "+" || event.key === "=") on.zoom(Math.SQRT2, 0, 0);
    else if (event.key === "-") on.zoom(Math.SQRT1_2, 0, 0);
    else if (event.key === "1") on.one();
    else if (event.key === "0") on.fit();
    else if (event.key.toLowerCase() === "f") on.flip();
    else return;
    event.preventDefault();
  });
}
