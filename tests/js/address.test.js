// The address of a form says what is filled in, and nothing that it begins with.

import assert from "node:assert/strict";
import { test } from "node:test";
import { addressOf, timeOf } from "../../static/js/lib/address.js";

/** @import { Draft, Input } from "../../static/js/lib/address.js" */

/** @type {Input} */
const GRAVEL = { sample: "gravel_gray", crop: "0,0,64,64", time: "" };
/** @type {Draft} */
const PLAIN = { method: "rpn", inputs: [GRAVEL], size: "1", width: "64", height: "64", seed: "", parameters: [] };

test("a form as it begins is its method and its crop", () => {
  assert.equal(addressOf(PLAIN), "/samples/gravel_gray?method=rpn&crop=0,0,64,64");
});

test("a size says itself, and its sides only where they are free", () => {
  assert.equal(addressOf({ ...PLAIN, size: "2" }), "/samples/gravel_gray?method=rpn&crop=0,0,64,64&size=2");
  const free = { ...PLAIN, size: "free", width: "100", height: "" };
  assert.equal(addressOf(free), "/samples/gravel_gray?method=rpn&crop=0,0,64,64&size=free&width=100");
});

test("a seed and parameters are said, an unchecked box as nothing", () => {
  const draft = {
    ...PLAIN,
    seed: "7",
    parameters: /** @type {[string, string][]} */ ([
      ["spot", "tip"],
      ["periodic", ""],
    ]),
  };
  assert.equal(addressOf(draft), "/samples/gravel_gray?method=rpn&crop=0,0,64,64&seed=7&spot=tip&periodic=");
});

test("further inputs are said by their number, with crop and time range; those that are left out keep the others’ numbers", () => {
  const inputs = [
    { ...GRAVEL, time: "0,12" },
    { sample: "", crop: "", time: "" },
    { sample: "sky", crop: "1,2,3,4", time: "5,6" },
    { sample: "sand", crop: "1,2,3,4", time: "" },
  ];
  const further = "third=sky:1,2,3,4@5,6&fourth=sand:1,2,3,4";
  const address = addressOf({ ...PLAIN, method: "mix", inputs });
  assert.equal(address, `/samples/gravel_gray?method=mix&crop=0,0,64,64&time=0,12&${further}`);
});

test("what means something in addresses is written so that it does not", () => {
  const inputs = [{ ...GRAVEL, sample: "a/b?c" }];
  const parameters = /** @type {[string, string][]} */ ([["name", "x&y=z"]]);
  const address = addressOf({ ...PLAIN, inputs, parameters });
  assert.equal(address, "/samples/a%2Fb%3Fc?method=rpn&crop=0,0,64,64&name=x%26y%3Dz");
});

test("a time range that is empty or all of the clip is not said", () => {
  assert.equal(timeOf("", "", "48"), "");
  assert.equal(timeOf("0", "48", "48"), "");
  assert.equal(timeOf("0", "47", "48"), "0,47");
  assert.equal(timeOf("1", "47", "48"), "1,47");
  assert.equal(timeOf("3", "", "48"), "3,");
});
