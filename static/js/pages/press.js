// Idempotency of forms: one press, one experiment. A form that starts one carries a key of the press, by which the
// service knows a second request of the same press (a double click, or a press after the browser's Stop) and answers it
// with the same experiment. So nothing needs to be locked, and no button can stay dead. What is under way is said at
// once, until it is there, stopped or left.

import { find, findAll } from "../lib/dom.js";

const BYTES = 24;
const LONG = 10_000; // milliseconds after which a browser that does not tell of its Stop is not believed to be sending
const live = document.querySelector("#sending");
/** @type {HTMLElement | null} */
let pressed = null; // the button
/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;

function makeKey() {
  const bytes = crypto.getRandomValues(new Uint8Array(BYTES));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** @param {HTMLElement} button */
function show(button) {
  clearTimeout(timer);
  pressed = button;
  button.dataset.rest ??= button.textContent;
  button.setAttribute("aria-busy", "true");
  button.textContent = "Sending …";
  if (live) live.textContent = "Sending …";
}

function rest(words = "") {
  clearTimeout(timer);
  if (!pressed) return;
  pressed.removeAttribute("aria-busy");
  pressed.textContent = pressed.dataset.rest ?? "";
  if (live) live.textContent = words;
}

document.addEventListener("submit", (event) => {
  const form = event.target;
  if (event.defaultPrevented || !(form instanceof HTMLFormElement) || !form.matches("[data-press]")) return;
  if (!form.elements.namedItem("press")) {
    const key = { type: "hidden", name: "press", value: makeKey() };
    form.append(Object.assign(document.createElement("input"), key));
  }
  show(event.submitter ?? find(form, "button.main, button"));
  if (!("navigation" in window)) {
    timer = setTimeout(() => rest("Still sending. Press again if you have stopped it."), LONG);
  }
});

// Where the browser tells of its Stop.
/** @type {NavigateEvent | null} */
let sent = null;
if ("navigation" in window) {
  window.navigation.addEventListener("navigate", (event) => {
    if (!pressed || !event.formData?.has("press")) return;
    sent = event;
    show(pressed);
    event.signal.addEventListener("abort", () => sent === event && rest("Stopped."));
  });
}

// Escape is Stop in every browser, but not every browser stops what a script has not seen begin.
document.addEventListener("keydown", (event) => {
  if (event.key !== "Escape" || !pressed?.hasAttribute("aria-busy")) return;
  window.stop();
  rest("Stopped.");
});

// Who comes back may press again, for another experiment.
window.addEventListener("pageshow", () => {
  rest();
  for (const key of findAll(document, "[data-press] [name=press]")) key.remove();
});
