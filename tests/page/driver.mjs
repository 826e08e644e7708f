// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
// Drives Chromium for the tests: a JSON request a line comes in, a JSON answer a line goes out.
// usage: node driver.mjs WEB_FOLDER CHROMIUM FLAG…
import fs from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import readline from "node:readline";

const [web, chromiumPath, ...args] = process.argv.slice(2);
const require = createRequire(path.join(web, "package.json"));
const { chromium } = require("playwright-core");
const browser = await chromium.launch({ executablePath: chromiumPath, args });
const pages = new Map();
let serial = 0;

const operations = {
  async open({ url, headset, width, height, density }) {
    const viewport = { width, height };
    const context = await browser.newContext({ viewport, deviceScaleFactor: density, ignoreHTTPSErrors: true });
    const page = await context.newPage();
    const id = ++serial;
    const held = { page, said: [] };
    page.on("console", (message) => {
      if (message.type() === "error") held.said.push(message.text());
    });
    page.on("pageerror", (error) => held.said.push(String(error.stack)));
    if (headset) {
      await page.addInitScript(fs.readFileSync(path.join(web, "node_modules/iwer/build/iwer.min.js"), "utf8"));
      await page.addInitScript(fs.readFileSync(new URL("headset.js", import.meta.url), "utf8"));
    }
    pages.set(id, held);
    await page.goto(url);
    return id;
  },
  // Runs the body of an async function in the page and returns what it returns.
  js: ({ page, code }) => pages.get(page).page.evaluate(`(async () => { ${code} })()`),
  shot: ({ page, file }) =>
    pages.get(page).page.screenshot({ path: file, scale: "css" }).then(() => null),
  mouse: async ({ page, steps }) => {
    const { mouse } = pages.get(page).page;
    for (const [what, ...values] of steps) await mouse[what](...values);
    return null;
  },
  // A command of the Chrome DevTools Protocol: the heap as the engine itself counts it.
  async devtools({ page, method, params }) {
    const held = pages.get(page);
    held.devtools ??= await held.page.context().newCDPSession(held.page);
    return held.devtools.send(method, params);
  },
  key: ({ page, key }) => pages.get(page).page.keyboard.press(key).then(() => null),
  said: async ({ page }) => pages.get(page).said,
  close: async ({ page }) => {
    await pages.get(page).page.context().close();
    pages.delete(page);
    return null;
  },
};

for await (const line of readline.createInterface({ input: process.stdin })) {
  const request = JSON.parse(line);
  try {
    const value = await operations[request.op](request);
    process.stdout.write(`${JSON.stringify({ value: value ?? null })}\n`);
  } catch (error) {
    process.stdout.write(`${JSON.stringify({ error: String(error.stack ?? error) })}\n`);
  }
}
await browser.close();
