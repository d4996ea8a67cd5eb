// An experiment's page: what it needs is set up when it opens, and again when a finished run has replaced its waiting
// room.

import { offerCopies } from "../lib/copy.js";
import { find, findAll, seek } from "../lib/dom.js";
import { follow } from "../lib/progress.js";
import { Player } from "../viewer/player.js";
import { Viewer } from "../viewer/viewer.js";

const PAUSES = [500, 1000, 2000, 4000, 8000]; // milliseconds before the page is asked for again
const PATIENCE = 15_000; // milliseconds that an answer may take
const OURS = new Set([200, 404, 410]); // answers that will not be another one soon: the result, or that it was deleted
let life = new AbortController(); // of what is in <main>

function setUp() {
  for (const root of findAll(document, ".viewer:not(.waiting)")) {
    if (seek(root, ".panes")) new Viewer(root, life.signal);
    if (seek(root, ".player")) new Player(root, life.signal);
  }
  offerCopies(document);
  const waiting = seek(document, "[data-experiment]");
  if (waiting) follow(waiting, replace);
}

/** The page as it is now; null where there was no answer, or one of somebody on the way. */
async function fetchPage() {
  try {
    const signal = AbortSignal.timeout(PATIENCE);
    const answer = await fetch(location.href, { headers: { Accept: "text/html" }, signal });
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    return OURS.has(answer.status) && page.querySelector("main#main") ? page : null;
  } catch {
    return null;
  }
}

/** Put the page as it is now in the place of the waiting room, without a reload as long as there is another way. */
async function replace() {
  let page = await fetchPage();
  for (const pause of PAUSES) {
    if (page) break;
    find(document, "[data-loading]").hidden = false;
    await new Promise((over) => setTimeout(over, pause));
    page = await fetchPage();
  }
  if (page) show(page);
  else location.reload();
}

/** @param {Document} page */
function show(page) {
  const main = find(document, "main");
  const hadFocus = main.contains(document.activeElement) || document.activeElement === document.body;
  life.abort();
  life = new AbortController();
  main.replaceChildren(...find(page, "main").childNodes);
  document.title = page.title;
  if (hadFocus) main.focus({ preventScroll: true });
  setUp();
}

setUp();
