// SPDX-License-Identifier: Apache-2.0
// Sizes, load times and pictures a second of pages, in a headless Chromium with software rendering: node measure.mjs PAGE ...
import { statSync } from "node:fs";
import { cpus } from "node:os";
import { resolve } from "node:path";
import { launch, openPage } from "./browser.mjs";

const browser = await launch();
console.log(`${cpus()[0].model}, ${cpus().length} processors; Chromium ${browser.version()}, SwiftShader, 900 x 620`);
for (const file of process.argv.slice(2)) {
  const { page, context } = await openPage(browser, resolve(file));
  const ready = Number(await page.evaluate(() => document.documentElement.dataset.ready));
  await page.waitForTimeout(500);
  await page.keyboard.press(" ");
  const count = () => page.evaluate(() => Number(document.documentElement.dataset.frames ?? 0));
  const from = await count(), begin = Date.now();
  await page.waitForTimeout(4000);
  const rate = (await count() - from) / ((Date.now() - begin) / 1000);
  console.log(`${file}  ${(statSync(file).size / 1e6).toFixed(1)} MB  ready after ${(ready / 1000).toFixed(2)} s  ${rate.toFixed(1)} pictures/s`);
  await context.close();
}
await browser.close();
