// The home page: a photograph or a clip can also be dropped anywhere on the page or pasted, and is sent as soon as it
// is chosen.

import { read, refusalOf } from "../lib/answers.js";
import { find } from "../lib/dom.js";

const MEBIBYTE = 2 ** 20;
const form = find(document, "#upload", HTMLFormElement);
const input = find(form, "#file", HTMLInputElement);
const message = find(form, "#upload-error");
const sending = find(form, ".sending");
const bar = find(form, "#sent", HTMLProgressElement);
const barText = find(form, "#sent-text");
const row = find(form, ".row");
/** @type {XMLHttpRequest | null} */
let request = null;

function reset() {
  request = null;
  sending.hidden = true;
  row.hidden = false;
  input.value = "";
}

/** @param {string} text */
function fail(text) {
  reset();
  message.textContent = text;
  message.focus();
}

/**
 * Go on to the page of what was taken, or say why it was not; a request that broke has the status 0.
 *
 * @param {XMLHttpRequest} request
 */
function finish({ status, responseText }) {
  try {
    const { id } = /** @type {{ id: string }} */ (read(status, responseText));
    location.assign(`/samples/${id}`);
  } catch (error) {
    fail(refusalOf(error).message);
  }
}

/** @param {File} file */
function send(file) {
  if (request) return;
  message.textContent = "";
  const limit = Number(form.dataset.limit);
  if (file.size > limit) {
    const [size, most] = [(file.size / MEBIBYTE).toFixed(1), Math.floor(limit / MEBIBYTE)];
    fail(`This file has ${size} MB; at most ${most} MB can be taken: send a smaller one.`);
    return;
  }
  const upload = new XMLHttpRequest();
  request = upload;
  row.hidden = true;
  sending.hidden = false;
  bar.value = 0;
  barText.textContent = "Sending …";
  upload.upload.addEventListener("progress", (event) => {
    if (event.lengthComputable) bar.value = event.loaded / event.total;
  });
  upload.upload.addEventListener("load", () => {
    bar.removeAttribute("value");
    barText.textContent = "Reading the file …";
  });
  for (const end of ["load", "error", "abort"]) upload.addEventListener(end, () => finish(upload));
  upload.open("POST", form.dataset.api ?? "");
  const body = new FormData();
  body.append("file", file, file.name || "upload");
  upload.send(body);
}

/**
 * @param {DataTransfer | HTMLInputElement | null} source
 * @param {string} [otherwise] what to say where there is no file
 */
function take(source, otherwise) {
  const file = source?.files?.[0];
  if (file) send(file);
  else if (otherwise) fail(otherwise);
}

input.hidden = true;
find(form, "[type=submit]").hidden = true;
find(form, "#ways").hidden = false;
const choose = find(form, "#choose");
choose.hidden = false;
choose.addEventListener("click", () => input.click());
input.addEventListener("change", () => take(input));
form.addEventListener("submit", (event) => {
  event.preventDefault();
  take(input, "Choose a photograph or a clip first: a PNG, JPEG, WebP, TIFF, MP4, WebM, GIF or APNG file.");
});

let inside = 0; // dragenter and dragleave come for every element on the way

/** @param {DragEvent} event */
const carriesFile = (event) => event.dataTransfer?.types.includes("Files") ?? false;

/** @param {number} levels */
function enter(levels) {
  inside = Math.max(0, levels);
  document.documentElement.classList.toggle("dragging", inside > 0);
}
document.addEventListener("dragenter", (event) => {
  if (carriesFile(event)) enter(inside + 1);
});
document.addEventListener("dragleave", (event) => {
  if (carriesFile(event)) enter(inside - 1);
});
document.addEventListener("dragover", (event) => {
  if (carriesFile(event)) event.preventDefault();
});
document.addEventListener("drop", (event) => {
  event.preventDefault();
  enter(0);
  take(event.dataTransfer, "That was not a file: save the picture, and drop the file here.");
});
document.addEventListener("paste", (event) => take(event.clipboardData));

// Going back to this page finds it as it was left, in the middle of an upload.
window.addEventListener("pageshow", (event) => {
  if (event.persisted) reset();
});
