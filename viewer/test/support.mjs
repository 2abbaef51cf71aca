// SPDX-License-Identifier: Apache-2.0
// Helpers of the page's tests: a browser, recordings, and access to pages. POLHODE is the program that
// writes the pages; without Chromium or the packages of package.json tests are skipped (exit code 77). SCREENSHOTS names a folder
// for pictures.
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
export const root = join(here, "../..");
const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
let launch, openPage;
try { ({ launch, openPage } = await import("./browser.mjs")); } catch { skip("the packages of viewer/package.json are not installed: run 'npm ci' in viewer/"); }
export const browser = await launch();
if (!browser) skip("there is no Chromium: install the Debian package chromium, or name one with CHROMIUM");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const polhode = process.env.POLHODE ?? join(root, "build/release/apps/polhode/polhode");
export const folder = mkdtempSync(join(tmpdir(), "polhode-viewer-"));

/** Runs the program in the folder of the tests. @returns what it writes to stdout */
export const run = (...words) => execFileSync(polhode, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] }).toString();

/** What the program says when it refuses; "nothing" if it does not, or not in two minutes. */
export const refusal = (words, env = {}) => {
  try { execFileSync(polhode, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"], timeout: 120000, env: { ...process.env, ...env } }); return "nothing"; } catch (error) { return error.stderr.toString() || "nothing"; }
};

/** A server of `polhode view`, at its address while `body` goes on. */
export async function served(words, body) {
  const server = spawn(polhode, ["view", ...words, "--no-open"], { cwd: folder });
  try {
    await body(await new Promise((resolve) => server.stdout.once("data", (data) => resolve(data.toString().trim()))));
  } finally { server.kill("SIGINT"); }
}

/** Bodies of several kinds, a joint, a spring, a beam, a cable and contact. */
export const model = `format: 1
title: Everything
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  ball: {shape: {sphere: 0.2}, density: 1000, position: [0.6, 0, 0.2]}
  arm: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 1, 1]}
materials:
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 8000}
sections:
  rod: {type: circle, diameter: 20 mm, material: steel}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 1, 1], axis: y}
loads:
  spring: {type: spring_damper, bodies: [ground, arm], at: [[1, 1, 2], [1, 1, 1]], stiffness: 200, damping: 2}
beams:
  mast: {points: [[-1, 0, 0], [-1, 0, 1]], elements: 4, section: rod, up: y, bonded: {ground: start}}
cables:
  stay: {through: [[ground, [-2, 0, 0]], [mast, end]], stiffness: 10 kN}
contacts: {default: {restitution: 0.5}}
analysis: {duration: 1 s, step: 2 ms}
output: {every: 10 ms}
`;

/** Runs a model and writes its page: NAME.yaml, NAME.results, NAME.html. */
export function recorded(name, text, ...options) {
  writeFileSync(join(folder, `${name}.yaml`), text);
  run("run", `${name}.yaml`, "--quiet", ...options);
  run("view", `${name}.results`, "--html", `${name}.html`, "--quiet");
}

/** Pages that several tests open, made when the first of them does. */
const makers = {
  "all.html": () => recorded("all", model),
  "tyre.html": () => {
    copyFileSync(join(root, "examples/tyre_on_kerb/model.yaml"), join(folder, "tyre.yaml"));
    run("run", "tyre.yaml", "--quiet", "--set", "analysis.duration=0.2 s");
    run("view", "tyre.results", "--html", "tyre.html", "--quiet");
  },
  "compared.html": () => {  // the same model with another position of the ball and a shorter duration
    made("all.html");
    run("run", "all.yaml", "--quiet", "-o", "other.results", "--set", "bodies.ball.position=[0.6, 0, 0.5]", "--set", "analysis.duration=0.6 s");
    run("view", "all.results", "other.results", "--html", "compared.html", "--quiet");
  },
};
export function made(page) {
  if (makers[page] && !existsSync(join(folder, page))) makers[page]();
  return page;
}

const counts = { passed: 0, failed: 0 }, open = [];

/** A page of the folder, or at an address, in a context of its own, also of another browser. */
export async function page_of(name, options, within = browser) {
  const opened = await openPage(within, name.startsWith("http") ? name : join(folder, made(name.split("#")[0]) + (name.includes("#") ? "#" + name.split("#")[1] : "")), options);
  open.push(opened);
  return opened;
}

export const expect = (condition, text) => { if (!condition) throw new Error(text); };

/** Runs a test, unless the words of the command line ask for others. */
export async function test(name, body) {
  const wanted = process.argv[2]?.split("|");
  if (wanted && !wanted.some((part) => name.includes(part))) return;
  const begun = Date.now();
  try {
    await body();
    // No test may leave a message on the console, nor ask a network for anything.
    for (const { faults, requests } of open) expect(faults.length + requests.length === 0, `console or network: ${[...faults, ...requests].join(" | ")}`);
    counts.passed++;
    console.log(`ok      ${name} (${((Date.now() - begun) / 1000).toFixed(1)} s)`);
  } catch (error) {
    counts.failed++;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
  for (const { context } of open.splice(0)) await context.close();
}

/** Ends all: the browser, the folder, the process with 1 if a test failed. */
export async function end() {
  await browser.close();
  rmSync(folder, { recursive: true });
  console.log(`${counts.passed} passed, ${counts.failed} failed`);
  process.exit(counts.failed || !counts.passed ? 1 : 0);
}

export const clock = (page) => page.locator("output.clock").textContent().then(parseFloat);
export const shot = (page, name) => (process.env.SCREENSHOTS ? page.screenshot({ path: join(process.env.SCREENSHOTS, `${name}.png`) }) : null);

/** Different colours in the picture: an empty one has few. */
export const colours = (page) => page.evaluate(() => {
  const from = document.querySelector(".view > canvas"), to = document.createElement("canvas");
  to.width = 200; to.height = 150;
  const ctx = to.getContext("2d");
  ctx.drawImage(from, 0, 0, 200, 150);
  const data = ctx.getImageData(0, 0, 200, 150).data, seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add((data[i] >> 3) << 10 | (data[i + 1] >> 3) << 5 | data[i + 2] >> 3);
  return seen.size;
});

/** The picture as it is drawn now: the page draws before the second of two frames. */
export const picture = async (page) => {
  await page.waitForTimeout(150);
  return page.evaluate(async () => {
    for (let k = 0; k < 3; k++) await new Promise(requestAnimationFrame);
    return document.querySelector(".view > canvas").toDataURL();
  });
};

/** What axe finds against accessibility. */
export const violations = async (page) => {
  await page.evaluate(axe);  // by the debugger: the page's own policy would refuse a script element
  const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" ; ")}`);
};

export const slide = (page, label, value) => page.getByLabel(label, { exact: true }).evaluate((input, x) => { input.value = x; input.dispatchEvent(new Event("input")); }, value);

/** What a button of a plot saves. */
export async function saved(page, label) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: `Save as ${label}` }).last().click()]);
  return readFileSync(await download.path(), label === "PNG" ? "latin1" : "utf8");
}

/** Rows of numbers of a table. */
export const table = (text) => text.trim().split("\n").slice(1).map((row) => row.split(",").map(Number));

/** Rows of channels of results, as `polhode convert` writes them. */
export function channels(name, ...list) {
  run("convert", `${name}.results`, `${name}.csv`, "--channels", ...list);
  return table(readFileSync(join(folder, `${name}.csv`), "utf8"));
}

/** Name of the object that is chosen now; "" if none is. */
export const chosen = (page) => page.evaluate(() => document.querySelector(".details h2")?.textContent ?? "");

/** Clicks all over the picture until an object has such a name. @returns the name of the last one that was met, "" if none */
export async function clicked(page, wanted, from = 0.2) {
  const box = await page.locator(".view > canvas").boundingBox();
  let name = "";
  for (let x = from; x < from + 0.72 && !wanted.test(name); x += 0.1)
    for (let y = 0.2; y < 0.92 && !wanted.test(name); y += 0.1) {
      await page.mouse.click(box.x + box.width * x, box.y + box.height * y);
      name = await chosen(page);
    }
  return name;
}
