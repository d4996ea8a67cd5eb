// Says beforehand, at the fields and at the main button, why the service would refuse the form as it is, and what a large run
// would take. Nothing is hindered: the form can be sent at any time, and is then answered in the same words. What the service
// itself has said of the form stays until what it is about has changed and is found mended; what no check can find, such as a
// full queue, until the form is sent again.

import { ask } from "../lib/answers.js";
import { start } from "../lib/start.js";

const PAUSE = 300; // milliseconds without a change
const PATIENCE = 20_000; // milliseconds for an answer
const form = document.querySelector("#experiment");
const summary = form.querySelector(".summary");
const problem = document.querySelector("#run-problem");
const memory = document.querySelector("#run-memory");
const GIBIBYTE = 2 ** 30;
let timer = 0;
let request = null;

/** The form's texts as the service reads them, or those of one field or group of fields. */
function texts(name = "") {
  const said = [...new FormData(form)].filter(([key, value]) => typeof value === "string" && key !== "press");
  const meant = name ? said.filter(([key]) => key === name || key.startsWith(`${name}.`)) : said;
  return new URLSearchParams(meant).toString();
}

/** What the service said, by the form names that it is about; without a name it is about all of the form. */
const raised = new Map();
for (const words of summary?.querySelectorAll("[data-about]") ?? []) {
  const { about, lasting } = words.dataset;
  raised.set(about, { words, lasting: lasting !== undefined, text: words.textContent, about: texts(about) });
}
let asked = null; // nothing yet, also where the service has answered: a person may have been quicker than this script

const idOf = (name) => `${name.replaceAll(".", "-")}-error`;

/** What a message is about: one field, or those of a crop or a time range. */
const fieldsOf = (id) => [...form.querySelectorAll(`[id="${id}"], [id^="${id}-"]`)].filter((each) => each.matches("input, select"));

function mark(message, text) {
  if (message.textContent === text) return;
  message.textContent = text;
  message.hidden = !text;
  for (const field of fieldsOf(message.id.replace(/-error$/, ""))) {
    field.toggleAttribute("aria-invalid", Boolean(text));
    if (text) field.setAttribute("aria-invalid", "true");
    const others = (field.getAttribute("aria-describedby") ?? "").split(" ").filter((id) => id && id !== message.id);
    field.setAttribute("aria-describedby", [...others, ...(text ? [message.id] : [])].join(" "));
  }
}

/** Take what the service said out of the summary where it is mended, and bring it up to date where it is not. */
function settle(errors) {
  for (const [name, message] of raised) {
    const { words, lasting, about } = message;
    if (lasting && (!name || texts(name) === about)) continue;
    if (errors[name]) {
      message.text = errors[name];
      words.textContent = errors[name];
    } else {
      words.closest("li").remove();
      raised.delete(name);
    }
  }
  if (!summary?.isConnected || raised.size) return;
  summary.remove();
  document.title = document.title.replace(/^Error: /, "");
}

function show({ errors, plan }) {
  settle(errors);
  const kept = [...raised].map(([name, { text }]) => [idOf(name), text]);
  const found = Object.entries(errors).map(([name, text]) => [idOf(name), text]);
  const said = Object.fromEntries([...found, ...kept]);
  for (const message of form.querySelectorAll(".error[id$=-error]")) mark(message, said[message.id] ?? "");
  const [first = ""] = Object.values(errors);
  if (problem.textContent !== first) problem.textContent = first;
  problem.hidden = !first;
  const gibibytes = (bytes) => (bytes / GIBIBYTE).toFixed(1);
  const large = plan && 2 * plan.memory > plan.memory_limit;
  memory.textContent = large ? `Takes about ${gibibytes(plan.memory)} of ${gibibytes(plan.memory_limit)} GB of memory.` : "";
}

async function check() {
  const body = texts();
  if (body === asked) return;
  request?.abort();
  request = new AbortController();
  const { signal } = request;
  try {
    const found = await ask("/experiments/check", { method: "POST", body: new URLSearchParams(body), signal, patience: PATIENCE });
    asked = body;
    show(found);
  } catch {
    if (!signal.aborted) memory.textContent = ""; // not known of this form; sent off, it is answered
  }
}

function later() {
  clearTimeout(timer);
  timer = setTimeout(() => start(check), PAUSE);
}

for (const change of ["input", "change", "crop"]) form.addEventListener(change, later);
for (const back of ["pageshow", "online"]) window.addEventListener(back, later);
form.addEventListener("submit", () => {
  clearTimeout(timer);
  request?.abort();
});
if (document.activeElement === document.body) summary?.focus(); // where the browser does not do so by itself
