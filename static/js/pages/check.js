// Validation of the form beforehand: says at the fields and at the main button why the service would refuse it as it
// is, and what a large run would take. Nothing is hindered: the form can be sent at any time, and is then answered in
// the same words. What the service itself has refused stays until what it is about has changed and is found mended;
// what no check can find, such as a full queue, until the form is sent again.

import { ask } from "../lib/answers.js";
import { find, findAll, seek } from "../lib/dom.js";
import { start } from "../lib/start.js";

/** @typedef {{ memory: number, memory_limit: number }} Plan what a run would take, in bytes */
/** @typedef {{ errors: Record<string, string>, plan: Plan | null }} Findings by the form names that they are about */

/**
 * What the service refused.
 *
 * @typedef {object} Refused
 * @property {HTMLElement} words in the summary
 * @property {boolean} lasting
 * @property {string} text
 * @property {string} about what the form held there
 */

const PAUSE = 300; // milliseconds without a change
const PATIENCE = 20_000; // milliseconds for an answer
const GIBIBYTE = 2 ** 30;
const form = find(document, "#experiment", HTMLFormElement);
const summary = seek(form, ".summary");
const problem = find(document, "#run-problem");
const memory = find(document, "#run-memory");
/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;
/** @type {AbortController | null} */
let request = null;

/**
 * The form's texts as the service reads them, or those of one field or group of fields.
 *
 * @param {string} name
 */
function readForm(name = "") {
  const texts = new URLSearchParams();
  for (const [key, value] of new FormData(form)) {
    const meant = !name || key === name || key.startsWith(`${name}.`);
    if (meant && typeof value === "string" && key !== "press") texts.append(key, value);
  }
  return texts.toString();
}

/** What the service refused, by the form names that it is about; without a name it is about all of the form. */
const refused = new Map(summary ? findAll(summary, "[data-about]").map(readRefusal) : []);
let checked = ""; // nothing yet, also where the service has answered: a person may have been quicker than this script

/**
 * @param {HTMLElement} words
 * @returns {[string, Refused]}
 */
function readRefusal(words) {
  const { about = "", lasting } = words.dataset;
  return [about, { words, lasting: lasting !== undefined, text: words.textContent, about: readForm(about) }];
}

/** @param {string} name */
const idOf = (name) => `${name.replaceAll(".", "-")}-error`;

/**
 * What a message is about: one field, or those of a crop or a time range.
 *
 * @param {string} id
 */
const fieldsOf = (id) => findAll(form, `:is(input, select):is([id="${id}"], [id^="${id}-"])`);

/**
 * @param {HTMLElement} message
 * @param {string} text
 */
function mark(message, text) {
  if (message.textContent === text) return;
  message.textContent = text;
  message.hidden = !text;
  for (const field of fieldsOf(message.id.replace(/-error$/, ""))) {
    if (text) field.setAttribute("aria-invalid", "true");
    else field.removeAttribute("aria-invalid");
    const others = (field.getAttribute("aria-describedby") ?? "").split(" ").filter((id) => id && id !== message.id);
    field.setAttribute("aria-describedby", [...others, ...(text ? [message.id] : [])].join(" "));
  }
}

/**
 * Take what the service refused out of the summary where it is mended, and bring it up to date where it is not.
 *
 * @param {Record<string, string>} errors
 */
function settle(errors) {
  for (const [name, refusal] of refused) {
    const { words, lasting, about } = refusal;
    if (lasting && (!name || readForm(name) === about)) continue;
    const error = errors[name];
    if (error) {
      refusal.text = error;
      words.textContent = error;
    } else {
      words.closest("li")?.remove();
      refused.delete(name);
    }
  }
  if (!summary?.isConnected || refused.size) return;
  summary.remove();
  document.title = document.title.replace(/^Error: /, "");
}

/** @param {Findings} findings */
function show({ errors, plan }) {
  settle(errors);
  const found = Object.entries(errors).map(([name, text]) => /** @type {const} */ ([idOf(name), text]));
  const kept = [...refused].map(([name, { text }]) => /** @type {const} */ ([idOf(name), text]));
  const texts = new Map([...found, ...kept]);
  for (const message of findAll(form, ".error[id$=-error]")) mark(message, texts.get(message.id) ?? "");
  const [first = ""] = Object.values(errors);
  if (problem.textContent !== first) problem.textContent = first;
  problem.hidden = !first;
  memory.textContent = plan && 2 * plan.memory > plan.memory_limit ? describe(plan) : "";
}

/** @param {Plan} plan */
function describe(plan) {
  const gibibytes = (/** @type {number} */ bytes) => (bytes / GIBIBYTE).toFixed(1);
  return `Takes about ${gibibytes(plan.memory)} of ${gibibytes(plan.memory_limit)} GB of memory.`;
}

async function check() {
  const text = readForm();
  if (text === checked) return;
  request?.abort();
  request = new AbortController();
  const { signal } = request;
  const body = new URLSearchParams(text);
  try {
    const answer = await ask("/experiments/check", { method: "POST", body, signal, patience: PATIENCE });
    checked = text;
    show(/** @type {Findings} */ (answer));
  } catch {
    if (!signal.aborted) memory.textContent = ""; // not known of this form; sent off, it is answered
  }
}

function checkLater() {
  clearTimeout(timer);
  timer = setTimeout(() => start(check), PAUSE);
}

for (const change of ["input", "change", "crop"]) form.addEventListener(change, checkLater);
for (const back of ["pageshow", "online"]) window.addEventListener(back, checkLater);
form.addEventListener("submit", () => {
  clearTimeout(timer);
  request?.abort();
});
if (document.activeElement === document.body) summary?.focus(); // where the browser does not do so by itself
