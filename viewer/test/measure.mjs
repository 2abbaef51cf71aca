// SPDX-License-Identifier: Apache-2.0
// Sizes, load times and pictures a second of pages, in a headless Chromium with software rendering: node measure.mjs PAGE ...
// Processor times are more reliable than wall times on a shared machine.
import { statSync } from "node:fs";
import { cpus } from "node:os";
import { resolve } from "node:path";
import { launch, openPage } from "./browser.mjs";

const browser = await launch();
console.log(`${cpus()[0].model}, ${cpus().length} processors; Chromium ${browser.version()}, SwiftShader, 900 x 620`);
const session = await browser.newBrowserCDPSession();
const cpu = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
for (const file of process.argv.slice(2)) {
  const idle = await cpu();
  const { page, context } = await openPage(browser, resolve(file));
  const ready = Number(await page.evaluate(() => document.documentElement.dataset.ready));
  const loading = await cpu() - idle;
  await page.waitForTimeout(500);
  await page.keyboard.press(" ");
  const count = () => page.evaluate(() => Number(document.documentElement.dataset.frames ?? 0));
  await page.waitForTimeout(3000);  // until rendering has adapted to a slow machine
  const from = await count(), begin = Date.now(), busy = await cpu();
  await page.waitForTimeout(4000);
  const drawn = await count() - from, rate = drawn / ((Date.now() - begin) / 1000), each = (await cpu() - busy) / drawn;
  console.log(`${file}  ${(statSync(file).size / 1e6).toFixed(1)} MB  ready after ${(ready / 1000).toFixed(2)} s, ${loading.toFixed(1)} s of processors  ${rate.toFixed(1)} pictures/s, ${(1000 * each).toFixed(0)} ms of processors each`);
  await context.close();
}
await browser.close();
