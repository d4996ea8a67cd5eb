// An experiment's page: what it needs is set up when it opens, and again when a finished run has replaced its waiting room.

import { offerCopies } from "./copy.js";
import { Player } from "./player.js";
import { follow } from "./progress.js";
import { Viewer } from "./viewer.js";

function setUp() {
  for (const root of document.querySelectorAll(".viewer:not(.waiting)")) {
    if (root.querySelector(".panes")) new Viewer(root);
    if (root.querySelector(".player")) new Player(root);
  }
  offerCopies(document);
  const waiting = document.querySelector("[data-experiment]");
  if (waiting) follow(waiting, replace);
}

/** Put the page as it is now in the place of the waiting room, without a reload. */
async function replace() {
  const answer = await fetch(location.href, { headers: { Accept: "text/html" } });
  const page = new DOMParser().parseFromString(await answer.text(), "text/html");
  const main = document.querySelector("main");
  const hadFocus = main.contains(document.activeElement) || document.activeElement === document.body;
  main.replaceChildren(...page.querySelector("main").childNodes);
  document.title = page.title;
  if (hadFocus) main.focus({ preventScroll: true });
  setUp();
}

setUp();
