// Progress of an experiment, shown in its waiting room.

import { find, seek } from "./dom.js";
import { ENDS, feed } from "./experiment_feed.js";
import { start } from "./start.js";

/** @import { State } from "./experiment_feed.js" */

const TICK = 250; // milliseconds

/**
 * What the waiting room says of a state; `news` is what is announced: not every per cent.
 *
 * @param {State} state
 */
export function describe({ status, progress, stage, position }) {
  const percent = Math.round((progress ?? 0) * 100);
  const end = ENDS.get(status);
  if (end) {
    const loading = "Loading the result …";
    return { status: "Finished", stage: loading, percent, news: `The experiment ${end}. ${loading}` };
  }
  const place = position ? `Place ${position} in the queue` : "In the queue";
  if (status !== "running") return { status: "Waiting", stage: place, percent, news: place };
  const name = stage ?? "starting";
  const words = `${name[0]?.toUpperCase()}${name.slice(1)}, ${percent} %`;
  return { status: "Running", stage: words, percent, news: `Running, ${Math.floor(percent / 25) * 25} %` };
}

/**
 * @param {HTMLElement} card
 * @param {() => Promise<void>} finish loads the result
 */
export function follow(card, finish) {
  const part = (/** @type {string} */ name) => find(card, `[data-${name}]`);
  const bar = find(card, "[role=progressbar]");
  const opened = performance.now();
  /** @type {number | null} */
  let began = null;
  let announced = "";

  const clock = setInterval(() => {
    const seconds = (performance.now() - (began ?? opened)) / 1000;
    part("elapsed").textContent = `${Math.floor(seconds)} s`;
  }, TICK);

  /** @param {string} text */
  function announce(text) {
    if (text === announced) return;
    announced = text;
    part("live").textContent = text;
  }

  /** @param {State} state */
  function show(state) {
    const { status, stage, percent, news } = describe(state);
    part("status").textContent = status;
    part("stage").textContent = stage;
    announce(news);
    if (ENDS.has(state.status)) {
      clearInterval(clock);
      bar.hidden = true;
      seek(card, "[data-cancel]", HTMLButtonElement)?.form?.remove();
      start(finish);
      return;
    }
    bar.setAttribute("aria-valuenow", String(percent));
    find(bar, "progress", HTMLProgressElement).value = percent / 100;
    if (state.status === "running") began ??= performance.now() - 1000 * (state.elapsed ?? 0);
  }

  feed(`/api/v1/experiments/${card.dataset.experiment}`, {
    show,
    lose: () => announce("The connection broke; trying again."),
  });
}
