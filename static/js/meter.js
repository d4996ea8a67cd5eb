// The structure meter beside a crop. It follows the crop while that is dragged: one question at a time, the next one about
// the newest crop. Its sentence is announced, its number is not, so that dragging does not chatter.

const SIDES = ["x", "y", "width", "height"];

class Meter {
  constructor(root) {
    this.root = root;
    const around = root.closest("fieldset, form");
    this.fields = SIDES.map((side) => around.querySelector(`[name$="crop.${side}"]`));
    this.frame = around.querySelector("[name$='time.first']");
    this.select = around.querySelector("select[name$=sample]");
    this.bar = root.querySelector(".meter-bar");
    this.asked = "";
    // What is not known yet has its room already, so that nothing moves under the pointer when it comes.
    root.classList.toggle("unknown", root.hidden);
    root.hidden = false;
    this.asking = false;
    for (const change of ["crop", "change"]) root.closest("form").addEventListener(change, () => this.follow().catch(reportError));
    this.follow().catch(reportError);
  }

  /** What to ask; nothing while the input is not on the screen. */
  address() {
    if (!this.root.parentElement.checkVisibility()) return "";
    const sample = this.select ? this.select.value : this.root.dataset.sample;
    const crop = this.fields.map((field) => field.value);
    if (!sample || !crop.every((value) => /^\d+$/.test(value))) return "";
    const frame = this.frame.closest(".time").hidden || !/^\d+$/.test(this.frame.value) ? "" : `&frame=${this.frame.value}`;
    return `/api/v1/samples/${encodeURIComponent(sample)}/structure?crop=${crop.join(",")}${frame}`;
  }

  async follow() {
    if (this.asking) return;
    this.asking = true;
    for (let address = this.address(); address && address !== this.asked; address = this.address()) {
      this.asked = address;
      try {
        const answer = await fetch(address);
        if (answer.ok) this.show(await answer.json());
        else this.root.classList.add("unknown"); // such as a crop that holds transparent pixels: the form says so when it is sent
      } catch {
        break; // offline: the next move of the crop asks again
      }
    }
    this.asking = false;
  }

  show({ delta, verdict, words }) {
    const shown = Math.max(0, delta);
    const place = Math.min(1, Math.sqrt(shown / Number(this.bar.dataset.end)));
    this.bar.querySelector(".meter-value").setAttribute("width", 100 * place);
    this.root.querySelector(".meter-number").textContent = shown.toFixed(2);
    this.root.dataset.verdict = verdict;
    this.root.classList.remove("unknown");
    const sentence = this.root.querySelector(".structure-words");
    if (sentence.textContent !== words) sentence.textContent = words;
  }
}

for (const root of document.querySelectorAll(".structure[data-sample]")) new Meter(root);
