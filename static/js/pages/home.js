// Home: a photograph or a clip can also be dropped anywhere on the page or pasted, and is sent as soon as it is chosen.

import { read } from "../lib/answers.js";

const form = document.querySelector("#upload");
const input = form.querySelector("#file");
const message = form.querySelector("#upload-error");
const sending = form.querySelector(".sending");
const bar = form.querySelector("#sent");
const barText = form.querySelector("#sent-text");
const row = form.querySelector(".row");
let request = null;

function reset() {
  request = null;
  sending.hidden = true;
  row.hidden = false;
  input.value = "";
}

function fail(text) {
  reset();
  message.textContent = text;
  message.focus();
}

/** Go on to the page of what was taken, or say why it was not; an XMLHttpRequest that broke has the status 0. */
function finish({ target }) {
  try {
    location.assign(`/samples/${read(target.status, target.responseText).id}`);
  } catch (refusal) {
    fail(refusal.message);
  }
}

function send(file) {
  if (request) return;
  message.textContent = "";
  const limit = Number(form.dataset.limit);
  if (file.size > limit) {
    fail(`This file has ${(file.size / 1048576).toFixed(1)} MB; at most ${Math.floor(limit / 1048576)} MB can be taken: send a smaller one.`);
    return;
  }
  request = new XMLHttpRequest();
  row.hidden = true;
  sending.hidden = false;
  bar.value = 0;
  barText.textContent = "Sending …";
  request.upload.addEventListener("progress", (event) => {
    if (event.lengthComputable) bar.value = event.loaded / event.total;
  });
  request.upload.addEventListener("load", () => {
    bar.removeAttribute("value");
    barText.textContent = "Reading the file …";
  });
  for (const end of ["load", "error", "abort"]) request.addEventListener(end, finish);
  request.open("POST", form.dataset.api);
  const body = new FormData();
  body.append("file", file, file.name || "upload");
  request.send(body);
}

function take(files, otherwise) {
  if (files.length) send(files[0]);
  else if (otherwise) fail(otherwise);
}

input.hidden = true;
form.querySelector("[type=submit]").hidden = true;
form.querySelector("#ways").hidden = false;
const choose = form.querySelector("#choose");
choose.hidden = false;
choose.addEventListener("click", () => input.click());
input.addEventListener("change", () => take(input.files));
form.addEventListener("submit", (event) => {
  event.preventDefault();
  take(input.files, "Choose a photograph or a clip first: a PNG, JPEG, WebP, TIFF, MP4, WebM, GIF or APNG file.");
});

let inside = 0; // dragenter and dragleave come for every element on the way
const carriesFile = (event) => event.dataTransfer?.types.includes("Files");
const mark = (on) => document.documentElement.classList.toggle("dragging", on);
document.addEventListener("dragenter", (event) => {
  if (!carriesFile(event)) return;
  inside += 1;
  mark(true);
});
document.addEventListener("dragleave", (event) => {
  if (!carriesFile(event)) return;
  inside = Math.max(0, inside - 1);
  mark(inside > 0);
});
document.addEventListener("dragover", (event) => {
  if (carriesFile(event)) event.preventDefault();
});
document.addEventListener("drop", (event) => {
  event.preventDefault();
  inside = 0;
  mark(false);
  take(event.dataTransfer.files, "That was not a file: save the picture, and drop the file here.");
});
document.addEventListener("paste", (event) => take(event.clipboardData.files));

// Going back to this page finds it as it was left, in the middle of an upload.
window.addEventListener("pageshow", (event) => {
  if (event.persisted) reset();
});
