// Says beforehand, at the fields and at the main button, why the service would refuse the form as it is, and what a large run
// would take. Nothing is hindered: the form can be sent at any time, and is then answered in the same words.

import { start } from "./start.js";

const PAUSE = 300; // milliseconds without a change
const form = document.querySelector("#experiment");
const problem = document.querySelector("#run-problem");
const memory = document.querySelector("#run-memory");
const GIBIBYTE = 2 ** 30;
let timer = 0;
let asked = "";
let request = null;

/** What a message is about: one field, or those of a crop or a time range. */
const about = (id) => [...form.querySelectorAll(`[id="${id}"], [id^="${id}-"]`)].filter((each) => each.matches("input, select"));

function mark(message, text) {
  if (message.textContent === text) return;
  message.textContent = text;
  message.hidden = !text;
  for (const field of about(message.id.replace(/-error$/, ""))) {
    field.toggleAttribute("aria-invalid", Boolean(text));
    if (text) field.setAttribute("aria-invalid", "true");
    const others = (field.getAttribute("aria-describedby") ?? "").split(" ").filter((id) => id && id !== message.id);
    field.setAttribute("aria-describedby", [...others, ...(text ? [message.id] : [])].join(" "));
  }
}

function show({ errors, plan }) {
  const texts = Object.fromEntries(Object.entries(errors).map(([name, text]) => [`${name.replaceAll(".", "-")}-error`, text]));
  for (const message of form.querySelectorAll(".error[id$=-error]")) mark(message, texts[message.id] ?? "");
  const [first = ""] = Object.values(errors);
  if (problem.textContent !== first) problem.textContent = first;
  problem.hidden = !first;
  const gibibytes = (bytes) => (bytes / GIBIBYTE).toFixed(1);
  const large = plan && 2 * plan.memory > plan.memory_limit;
  memory.textContent = large ? `Takes about ${gibibytes(plan.memory)} of ${gibibytes(plan.memory_limit)} GB of memory.` : "";
  if (!first) form.querySelector(".summary")?.remove();
}

async function ask() {
  const texts = [...new FormData(form)].filter(([, value]) => typeof value === "string");
  const body = new URLSearchParams(texts).toString();
  if (body === asked) return;
  request?.abort();
  request = new AbortController();
  try {
    const answer = await fetch("/experiments/check", { method: "POST", body: new URLSearchParams(body), signal: request.signal });
    if (!answer.ok) return; // sent off, the form says why
    const found = await answer.json();
    asked = body;
    show(found);
  } catch {
    // Offline, or asked anew meanwhile.
  }
}

function later() {
  clearTimeout(timer);
  timer = setTimeout(() => start(ask), PAUSE);
}

for (const change of ["input", "change", "crop"]) form.addEventListener(change, later);
form.addEventListener("submit", () => {
  clearTimeout(timer);
  request?.abort();
});
window.addEventListener("pageshow", () => {
  if (!form.querySelector(".summary")) later(); // an answer that is there already stands until something changes
});
