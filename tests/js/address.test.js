// The address of a form says what is filled in, and nothing that it begins with. tests/web/form/test_address.py compares whole
// forms with what the service writes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { queryOf, shorten } from "../../static/js/lib/address.js";

/** @import { Field } from "../../static/js/lib/address.js" */

const CROP = "method=rpn&crop.x=0&crop.y=0&crop.width=64&crop.height=64";

/**
 * A form as it begins, with some fields changed.
 *
 * @param {Record<string, string>} changed
 * @returns {Field[]}
 */
function form(changed = {}) {
  const fields = [
    { name: "time.first", value: "", initial: "" },
    ...["x", "y"].map((side) => ({ name: `crop.${side}`, value: "0" })),
    ...["width", "height"].map((side) => ({ name: `crop.${side}`, value: "64" })),
    { name: "input-2.sample", value: "sky" },
    { name: "input-2.crop.x", value: "", initial: "" },
    { name: "input-3.sample", value: "", initial: "" },
    { name: "input-3.crop.x", value: "5", initial: "" },
    { name: "method", value: "rpn" },
    { name: "rpn.alpha", value: "0.1", initial: "0.1" },
    { name: "rpn.periodic", value: "on", initial: "on" },
    { name: "mix.alpha", value: "0.3", initial: "0.1" },
    { name: "size", value: "1", initial: "1" },
    { name: "width", value: "64", initial: "" },
    { name: "height", value: "64", initial: "" },
    { name: "loop", value: "", initial: "on" },
    { name: "seed", value: "0", initial: "0" },
    { name: "unlisted", value: "", initial: "" },
  ];
  return fields.map((field) => ({ ...field, value: changed[field.name] ?? field.value }));
}

const STILL = { inputs: 1, lacks: ["loop"] };
const SEVERAL = { inputs: 4, lacks: ["loop"] };

test("a form as it begins is its method and its crop", () => {
  assert.equal(queryOf(form(), STILL), CROP);
});

test("a size says itself, and its sides only where they are free", () => {
  assert.equal(queryOf(form({ size: "2" }), STILL), `${CROP}&size=2`);
  assert.equal(queryOf(form({ size: "free", height: "" }), STILL), `${CROP}&size=free&width=64`);
});

test("a seed and parameters are said, an unchecked box as nothing", () => {
  const changed = form({ seed: "7", "rpn.alpha": "0,2", "rpn.periodic": "", unlisted: "on" });
  assert.equal(queryOf(changed, STILL), `${CROP}&rpn.alpha=0,2&rpn.periodic=&seed=7&unlisted=on`);
});

test("a method’s inputs are said, but not the crop of one that is left out", () => {
  const mixed = CROP.replace("rpn", "mix");
  assert.equal(queryOf(form({ method: "mix" }), SEVERAL), `${mixed}&input-2.sample=sky&mix.alpha=0.3`);
  const third = form({ method: "mix", "input-3.sample": "sand" });
  const inputs = "input-2.sample=sky&input-3.sample=sand&input-3.crop.x=5";
  assert.equal(queryOf(third, SEVERAL), `${mixed}&${inputs}&mix.alpha=0.3`);
});

test("a parameter that methods share is said where the chosen one has it", () => {
  assert.equal(queryOf(form(), { inputs: 1, lacks: [] }), `${CROP}&loop=`);
});

test("what means something in addresses is written so that it does not", () => {
  assert.equal(queryOf(form({ seed: "x&y=z #" }), STILL), `${CROP}&seed=x%26y%3Dz+%23`);
});

test("a time range that is all of the clip is not said", () => {
  assert.deepEqual(shorten("0", "48", "48"), ["", ""]);
  assert.deepEqual(shorten("", "48", "48"), ["", ""]);
  assert.deepEqual(shorten("", "", "48"), ["", ""]);
  assert.deepEqual(shorten("0", "47", "48"), ["0", "47"]);
  assert.deepEqual(shorten("1", "47", "48"), ["1", "47"]);
  assert.deepEqual(shorten("3", "", "48"), ["3", ""]);
});
