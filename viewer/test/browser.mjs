// SPDX-License-Identifier: Apache-2.0
// A headless Chromium without network, and helpers of all tests of the page.
import { existsSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const program = [process.env.CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((p) => p && existsSync(p));

export async function launch(args = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]) {
  if (!program) return null;
  return chromium.launch({ executablePath: program, args: ["--no-sandbox", ...args] });
}

/** A page that notes every message of the console, every fault and every request to a network; it stands still until it is played. */
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({ viewport: { width: 900, height: 620 }, acceptDownloads: true, offline: !address.startsWith("http"), reducedMotion: "reduce", ...options });
  // Drawing commands of the page to the graphics processor.
  await context.addInitScript(() => {
    window.drawCalls = 0;
    for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"]) {
      const draw = WebGL2RenderingContext.prototype[name];
      WebGL2RenderingContext.prototype[name] = function (...words) { window.drawCalls++; return draw.apply(this, words); };
    }
  });
  const page = await context.newPage();
  const faults = [], requests = [];
  // A message of Chromium when a picture is read back from its software renderer, not an error of the page.
  page.on("console", (m) => { if (["error", "warning"].includes(m.type()) && !/GL Driver Message|software WebGL/.test(m.text())) faults.push(m.text()); });
  page.on("pageerror", (e) => faults.push(String(e)));
  page.on("request", (r) => { if (/^(https?|wss?):/.test(r.url()) && !r.url().startsWith("http://127.0.0.1")) requests.push(r.url()); });
  await page.goto(address.startsWith("http") ? address : pathToFileURL(address.split("#")[0]).href + (address.includes("#") ? "#" + address.split("#")[1] : ""), { timeout: 120000 });
  await page.waitForFunction(() => document.documentElement.dataset.ready || document.documentElement.dataset.failed, null, { timeout: 120000 });
  return { page, context, faults, requests };
}
