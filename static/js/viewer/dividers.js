// The dividers of the slider view: one between each two pictures, moved by pointer or keys.

const KEYS = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1 };

/** Add dividers to a stage; `changed(splits)` hears of their places, parts of the stage's width in ascending order. */
export function divide(stage, titles, changed) {
  const splits = titles.slice(1).map((_, index) => (index + 1) / titles.length);

  function move(index, part) {
    splits[index] = Math.min(Math.max(part, splits[index - 1] ?? 0), splits[index + 1] ?? 1);
    show(index);
    changed(splits);
  }

  const handles = splits.map((_, index) => {
    const handle = document.createElement("div");
    handle.className = "divider";
    handle.tabIndex = 0;
    for (const [name, value] of Object.entries({
      role: "slider",
      "aria-label": `Divider between ${titles[index]} and ${titles[index + 1]}`,
      "aria-orientation": "horizontal",
      "aria-valuemin": 0,
      "aria-valuemax": 100,
    })) handle.setAttribute(name, value);
    handle.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      handle.focus();
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener("pointermove", (event) => {
      if (!handle.hasPointerCapture(event.pointerId)) return;
      const bounds = stage.getBoundingClientRect();
      move(index, (event.clientX - bounds.left) / bounds.width);
    });
    handle.addEventListener("keydown", (event) => {
      const to = event.key === "Home" ? 0 : event.key === "End" ? 1 : splits[index] + (KEYS[event.key] ?? NaN);
      if (Number.isNaN(to)) return;
      event.preventDefault();
      move(index, to);
    });
    stage.append(handle);
    return handle;
  });

  function show(index) {
    handles[index].style.left = `${splits[index] * 100}%`;
    handles[index].setAttribute("aria-valuenow", Math.round(splits[index] * 100));
  }
  splits.forEach((_, index) => show(index));
  return { splits, remove: () => handles.forEach((handle) => handle.remove()) };
}
