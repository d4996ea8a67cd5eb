// Pan and zoom by mouse, touch and keyboard, on any of several stages.

const STEP = 48; // screen pixels an arrow key pans by
const NOTCH = 50; // screen pixels: less than this is a trackpad's pinch, which comes as small steps with Ctrl
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Where a point is on a stage, from the stage's centre. */
function centred(stage, x, y) {
  const bounds = stage.getBoundingClientRect();
  return [x - bounds.left - bounds.width / 2, y - bounds.top - bounds.height / 2];
}

/**
 * `on.pan(dx, dy)` in screen pixels; `on.zoom(factor, x, y)` about a point given from the stage's centre. The wheel alone
 * zooms while `on.focused()`; otherwise it scrolls the page, as it does everywhere.
 */
export function listen(stage, on) {
  const down = new Map();

  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && !on.focused()) return;
    event.preventDefault();
    const moved = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
    const speed = event.ctrlKey && Math.abs(moved) < NOTCH ? 0.01 : 0.002;
    on.zoom(Math.exp(-moved * speed), ...centred(stage, event.clientX, event.clientY));
  }, { passive: false });

  stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || event.target.closest(".divider")) return;
    down.set(event.pointerId, [event.clientX, event.clientY]);
    stage.setPointerCapture(event.pointerId);
    stage.classList.add("held");
  });
  stage.addEventListener("pointermove", (event) => {
    const was = down.get(event.pointerId);
    if (!was) return;
    const now = [event.clientX, event.clientY];
    const others = [...down].filter(([id]) => id !== event.pointerId).map(([, point]) => point);
    down.set(event.pointerId, now);
    if (!others.length) {
      on.pan(now[0] - was[0], now[1] - was[1]);
      return;
    }
    const [other] = others;
    const middle = (point) => [(point[0] + other[0]) / 2, (point[1] + other[1]) / 2];
    const apart = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
    on.pan(middle(now)[0] - middle(was)[0], middle(now)[1] - middle(was)[1]);
    on.zoom(apart(now) / apart(was), ...centred(stage, ...middle(now)));
  });
  const up = (event) => {
    down.delete(event.pointerId);
    if (!down.size) stage.classList.remove("held");
  };
  stage.addEventListener("pointerup", up);
  stage.addEventListener("pointercancel", up);
}

/** The same by keys, on what holds the stages. */
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
