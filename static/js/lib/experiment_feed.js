// Server-sent events of an experiment, and where those fail or are held back, its record every second.

import { Refusal, ask } from "./answers.js";
import { start } from "./start.js";

/**
 * An experiment as its record and its events tell of it.
 *
 * @typedef {object} State
 * @property {string} status
 * @property {number} [progress] from 0 to 1
 * @property {string | null} [stage]
 * @property {number | null} [position] in the queue, from 1 on
 * @property {number | null} [elapsed] seconds since it began to run
 */

export const ENDS = new Map([
  ["succeeded", "has succeeded"],
  ["failed", "has failed"],
  ["cancelled", "was cancelled"],
]);

const ASK_EVERY = 1000; // milliseconds
const SILENCE = 5000; // milliseconds without an event, after which one asks: proxies hold events back
const WATCH = 250; // milliseconds
const PATIENCE = 20_000; // milliseconds for one answer

/**
 * Follow an experiment to its end, of which is told once.
 *
 * @param {string} address of its record
 * @param {{ show: (state: State) => void, lose: () => void }} on `lose` where the connection broke
 */
export function feed(address, on) {
  let done = false;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  let asking;
  let heard = performance.now();
  const source = "EventSource" in globalThis ? new EventSource(`${address}/events`) : null;

  const watch = setInterval(() => {
    if (performance.now() - heard < SILENCE) return;
    heard = performance.now();
    start(look);
  }, WATCH);

  /** @param {State} state */
  function show(state) {
    if (done) return;
    if (ENDS.has(state.status)) {
      done = true;
      source?.close();
      clearInterval(asking);
      clearInterval(watch);
    }
    on.show(state);
  }

  async function look() {
    /** @type {State} */
    let state = { status: "cancelled" }; // and deleted
    try {
      state = /** @type {State} */ (await ask(address, { patience: PATIENCE }));
    } catch (error) {
      if (!(error instanceof Refusal) || (error.status !== 404 && error.status !== 410)) {
        on.lose();
        return;
      }
    }
    show(state);
  }

  function poll() {
    if (!asking && !done) asking = setInterval(() => start(look), ASK_EVERY);
  }

  if (!source) {
    poll();
    return;
  }
  for (const name of ["status", "progress", "end", "message"]) {
    source.addEventListener(name, (/** @type {MessageEvent<string>} */ event) => {
      /** @type {unknown} */
      const state = JSON.parse(event.data);
      show(/** @type {State} */ (state));
      heard = performance.now();
      clearInterval(asking);
      asking = undefined;
    });
  }
  // The browser reconnects by itself; until it has, the answer is asked for, which also notices an end that was missed.
  source.addEventListener("error", poll);
}
