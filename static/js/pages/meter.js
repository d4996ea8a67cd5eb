// The structure meter beside a crop. It follows the crop while that is dragged: one question at a time, the next one
// about the newest crop. Its sentence is announced, its number is not, so that dragging does not chatter. What could
// not be asked is not known: no verdict stands beside a crop that it is not about.

import { ask, refusalOf } from "../lib/answers.js";
import { find, findAll, seek } from "../lib/dom.js";
import { start } from "../lib/start.js";

/** @typedef {{ delta: number | null, verdict: string, words: string }} Reading the structure index and what it means */

const PATIENCE = 20_000; // milliseconds for one answer
const [SOON, LATE] = [2_000, 60_000]; // milliseconds until a question that failed is asked again: from, doubling, up to

class Meter {
  question = ""; // the address that was asked last
  asking = false;
  pause = SOON;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  timer = undefined;

  /** @param {HTMLElement} root */
  constructor(root) {
    this.root = root;
    const around = /** @type {HTMLElement} */ (root.closest("fieldset, form"));
    this.frame = find(around, ".frame");
    this.time = find(around, ".time");
    this.select = seek(around, "select[name$=sample]", HTMLSelectElement);
    this.bar = find(root, ".meter-bar", SVGElement);
    this.sentence = find(root, ".structure-words");
    // What is not known yet has its room already, so that nothing moves under the pointer when it comes.
    if (root.hidden) root.classList.add("unknown");
    root.hidden = false;
    const follow = () => start(() => this.follow());
    for (const change of ["crop", "change"]) root.closest("form")?.addEventListener(change, follow);
    window.addEventListener("online", follow);
    follow();
  }

  /** Whether the input is on the screen and has a sample. */
  get shown() {
    return Boolean(this.root.parentElement?.checkVisibility() && this.sample);
  }

  get sample() {
    return this.select ? this.select.value : (this.root.dataset.sample ?? "");
  }

  /** What to ask; nothing where there is no crop to ask about. */
  address() {
    const { crop } = this.frame.dataset; // what the box shows, for numbers that are being typed may not fit
    if (!this.shown || !crop) return "";
    const { first } = this.time.dataset;
    const frame = this.time.hidden || first === undefined ? "" : `&frame=${first}`;
    return `/api/v1/samples/${encodeURIComponent(this.sample)}/structure?crop=${crop}${frame}`;
  }

  async follow() {
    if (this.asking) return;
    clearTimeout(this.timer);
    this.asking = true;
    try {
      for (let address = this.address(); address !== this.question; address = this.address()) {
        this.question = address;
        if (address) this.show(/** @type {Reading} */ (await ask(address, { patience: PATIENCE })));
        else if (this.shown) this.forget("");
      }
      this.pause = SOON;
    } catch (error) {
      const { message, final } = refusalOf(error);
      this.forget(message);
      if (!final) this.again();
      else if (this.address() !== this.question) this.again(0); // refused was a crop that has moved on meanwhile
    } finally {
      this.asking = false;
    }
  }

  /** Ask the same once more, later or with the next change. */
  again(pause = this.pause) {
    this.question = "";
    this.timer = setTimeout(() => start(() => this.follow()), pause);
    if (pause) this.pause = Math.min(2 * pause, LATE);
  }

  /**
   * Say nothing of this crop, but why: such as one that holds transparent pixels, or a connection that broke.
   *
   * @param {string} reason
   */
  forget(reason) {
    this.root.classList.add("unknown");
    delete this.root.dataset.verdict;
    this.say(reason);
  }

  /** @param {string} words */
  say(words) {
    if (this.sentence.textContent !== words) this.sentence.textContent = words;
  }

  /** @param {Reading} reading */
  show({ delta, verdict, words }) {
    if (delta === null) {
      this.forget(words);
      return;
    }
    const shown = Math.max(0, delta);
    const place = Math.min(1, Math.sqrt(shown / Number(this.bar.dataset.end)));
    find(this.bar, ".meter-value", SVGElement).setAttribute("width", String(100 * place));
    find(this.root, ".meter-number").textContent = shown.toFixed(2);
    this.root.dataset.verdict = verdict;
    this.root.classList.remove("unknown");
    this.say(words);
  }
}

for (const root of findAll(document, ".structure[data-sample]")) new Meter(root);
