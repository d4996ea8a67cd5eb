// Firefox, driven by WebDriver BiDi through puppeteer-core for firefox.py: one order as a line of JSON comes in, its answer goes
// out as one. The browser ends when the orders do.

import { createInterface } from "node:readline";
import puppeteer from "puppeteer-core";

const { binary, profile, preferences, width, height, patience } = JSON.parse(process.argv[2]);
const browser = await puppeteer.launch({
  browser: "firefox",
  executablePath: binary,
  headless: true,
  userDataDir: profile,
  extraPrefsFirefox: preferences,
  defaultViewport: null,
  protocolTimeout: patience * 1000,
});
const [page] = await browser.pages();
await page.setViewport({ width, height });
let noted = [];
page.on("pageerror", (error) => noted.push(`${error.message ?? error}`));
page.on("console", (message) => ["error", "warn"].includes(message.type()) && noted.push(message.text()));

const verbs = {
  // Not page.goto(), which at times waits for good for a page that is there.
  go: (address) => page.evaluate((there) => setTimeout(() => location.assign(there)), address),
  run: (expression) => page.evaluate(expression),
  async drag([first, ...others]) {
    await page.mouse.move(...first);
    await page.mouse.down();
    for (const point of others) await page.mouse.move(...point, { steps: 4 });
    await page.mouse.up();
  },
  async fingers([first, ...others]) {
    const touches = [];
    for (const point of first) touches.push(await page.touchscreen.touchStart(...point));
    for (const points of others) {
      for (const [finger, point] of points.entries()) await touches[finger].move(...point);
    }
    for (const touch of touches) await touch.end();
  },
  async wheel(at, by) {
    await page.mouse.move(...at);
    await page.mouse.wheel({ deltaY: by });
  },
  async press(keys) {
    const held = keys.split("+");
    const last = held.pop();
    for (const key of held) await page.keyboard.down(key);
    await page.keyboard.press(last);
    for (const key of held.reverse()) await page.keyboard.up(key);
  },
  write: (text) => page.keyboard.type(text),
  async choose(selector, path) {
    const field = await page.$(selector);
    await field.uploadFile(path);
  },
  capture: () => page.screenshot({ encoding: "base64" }),
  complaints() {
    const before = noted;
    noted = [];
    return before;
  },
};

const say = (answer) => process.stdout.write(`${JSON.stringify(answer)}\n`);
say({ value: await browser.version() });
for await (const line of createInterface({ input: process.stdin })) {
  const [verb, ...given] = JSON.parse(line);
  try {
    say({ value: (await verbs[verb](...given)) ?? null });
  } catch (error) {
    say({ error: `${error}` });
  }
}
await browser.close();
process.exit();
