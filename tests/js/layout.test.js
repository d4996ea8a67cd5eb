// The rooms of static/js: what each of them may import, and how long a file may be.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { test } from "node:test";

const ROOT = resolve(import.meta.dirname, "../../static/js");
/** @type {Record<string, string[]>} */
const MAY_IMPORT = {
  lib: ["lib"],
  crop: ["crop", "lib"],
  viewer: ["viewer", "lib"],
  pages: ["crop", "viewer", "lib"],
};
const files = readdirSync(ROOT, { recursive: true, encoding: "utf8" }).filter((name) => name.endsWith(".js"));

/** @param {string} name */
const readScript = (name) => readFileSync(join(ROOT, name), "utf8");

test("every script lies in a room, and imports only from the rooms that its own builds on", () => {
  assert.ok(files.length > 30);
  for (const name of files) {
    const room = dirname(name);
    assert.ok(room in MAY_IMPORT, `${name} lies in no room`);
    for (const [, path = ""] of readScript(name).matchAll(/from "(\.[^"]+)"/g)) {
      const from = dirname(relative(ROOT, resolve(ROOT, room, path)));
      assert.ok(MAY_IMPORT[room]?.includes(from), `${name} imports ${path}`);
    }
  }
});

test("no script has more than 300 lines", () => {
  for (const name of files) assert.ok(readScript(name).split("\n").length <= 301, name);
});
