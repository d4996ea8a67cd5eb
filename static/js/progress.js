// The waiting room of an experiment: server-sent events, or asking every second where those fail.

const ASK_EVERY = 1000; // milliseconds
const FINISHED = new Set(["succeeded", "failed", "cancelled"]);

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
  const source = "EventSource" in window ? new EventSource(`${address}/events`) : null;

  function announce(text) {
    if (text === announced) return;
    announced = text;
    live.textContent = text;
  }

  function show(state) {
    if (done) return;
    if (FINISHED.has(state.status)) {
      done = true;
      source?.close();
      clearInterval(asking);
      clearInterval(clock);
      announce(`The experiment has ${state.status}.`);
      finished();
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
  }, 250);

  async function ask() {
    try {
      const answer = await fetch(address);
      if (answer.status === 404 || answer.status === 410) show({ status: "cancelled" });
      else if (answer.ok) show(await answer.json());
    } catch {
      announce("The connection broke; trying again.");
    }
  }

  function poll() {
    if (!asking && !done) asking = setInterval(ask, ASK_EVERY);
  }

  if (source) {
    for (const name of ["status", "progress", "end", "message"]) {
      source.addEventListener(name, (event) => {
        clearInterval(asking);
        asking = 0;
        show(JSON.parse(event.data));
      });
    }
    // The browser reconnects by itself; until it has, the answer is asked for, which also notices an end that was missed.
    source.addEventListener("error", poll);
  } else {
    poll();
  }
}
