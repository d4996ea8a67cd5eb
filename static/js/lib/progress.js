// The waiting room of an experiment: server-sent events, or asking every second where those fail.

import { ask } from "./answers.js";
import { start } from "./start.js";

const ASK_EVERY = 1000; // milliseconds
const SILENCE = 5000; // milliseconds without an event, after which one asks: proxies hold events back
const PATIENCE = 20_000; // milliseconds for one answer
const ENDS = new Map([["succeeded", "has succeeded"], ["failed", "has failed"], ["cancelled", "was cancelled"]]);

/**
 * @param {HTMLElement} card
 * @param {() => Promise<void>} finished loads the result
 */
export function follow(card, finished) {
  const address = `/api/v1/experiments/${card.dataset.experiment}`;
  const find = (name) => card.querySelector(`[data-${name}]`);
  const bar = card.querySelector("[role=progressbar]");
  const live = find("live");
  const opened = performance.now();
  let started = null;
  let announced = "";
  let done = false;
  let asking = 0;
  let heard = opened;
  const source = "EventSource" in window ? new EventSource(`${address}/events`) : null;

  function announce(text) {
    if (text === announced) return;
    announced = text;
    live.textContent = text;
  }

  function show(state) {
    if (done) return;
    if (ENDS.has(state.status)) {
      done = true;
      source?.close();
      clearInterval(asking);
      clearInterval(clock);
      find("status").textContent = "Finished";
      find("stage").textContent = "Loading the result …";
      bar.hidden = true;
      find("cancel")?.form.remove();
      announce(`The experiment ${ENDS.get(state.status)}. Loading the result …`);
      start(finished);
      return;
    }
    const running = state.status === "running";
    const part = Math.round((state.progress ?? 0) * 100);
    find("status").textContent = running ? "Running" : "Waiting";
    bar.setAttribute("aria-valuenow", part);
    bar.querySelector("progress").value = part / 100;
    const place = state.position ? `Place ${state.position} in the queue` : "In the queue";
    const stage = state.stage ?? "starting";
    find("stage").textContent = running ? `${stage[0].toUpperCase()}${stage.slice(1)}, ${part} %` : place;
    announce(running ? `Running, ${Math.floor(part / 25) * 25} %` : place);
    if (running) started ??= performance.now() - 1000 * (state.elapsed ?? 0);
  }

  const clock = setInterval(() => {
    const seconds = (performance.now() - (started ?? opened)) / 1000;
    find("elapsed").textContent = `${Math.floor(seconds)} s`;
    if (performance.now() - heard < SILENCE) return;
    heard = performance.now();
    start(look);
  }, 250);

  async function look() {
    let state = { status: "cancelled" }; // and deleted
    try {
      state = await ask(address, { patience: PATIENCE });
    } catch ({ status }) {
      if (status !== 404 && status !== 410) {
        announce("The connection broke; trying again.");
        return;
      }
    }
    show(state);
  }

  function poll() {
    if (!asking && !done) asking = setInterval(() => start(look), ASK_EVERY);
  }

  if (source) {
    for (const name of ["status", "progress", "end", "message"]) {
      source.addEventListener(name, (event) => {
        show(JSON.parse(event.data));
        heard = performance.now();
        clearInterval(asking);
        asking = 0;
      });
    }
    // The browser reconnects by itself; until it has, the answer is asked for, which also notices an end that was missed.
    source.addEventListener("error", poll);
  } else {
    poll();
  }
}
