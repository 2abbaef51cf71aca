// SPDX-License-Identifier: Apache-2.0
// A film of a page of 'polhode view --html', without a screen: node film.mjs PAGE OUT.gif|OUT.mp4|FOLDER [options]
//   --size 640x400  --rate 20 (pictures a second)  --speed 1 (seconds of the recording in one of the film)
//   --from T --to T (left out: all)  --turn 0 (degrees that the camera goes round)  --link '#eye=...' (where it begins: what Link puts into the address)
// A folder gets pictures 00000.png and so on. An .mp4 file needs ffmpeg.
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { parseArgs } from "node:util";
import { gif } from "./gif.mjs";
import { launch, openPage } from "./test/browser.mjs";

const fail = (why, code = 2) => { console.error(`film: ${why}`); process.exit(code); };
const text = { type: "string" };
const { values: o, positionals } = parseArgs({ allowPositionals: true, options: { size: { ...text, default: "640x400" }, rate: { ...text, default: "20" }, speed: { ...text, default: "1" },
  from: text, to: text, turn: { ...text, default: "0" }, link: { ...text, default: "" } } });
const [page_file, out] = positionals;
if (!page_file || !out) fail("name a page and what to write: node film.mjs PAGE OUT.gif");
const kind = extname(out) || "folder", [width, height] = o.size.split("x").map(Number), rate = Number(o.rate), speed = Number(o.speed);
if (!(width > 15 && height > 15)) fail(`--size is ${o.size}; write it as 640x400`);
if (!(rate > 0 && speed > 0)) fail("--rate and --speed are numbers above zero");
if (![".gif", ".mp4", "folder"].includes(kind)) fail(`cannot write '${kind}'. Name a .gif or .mp4 file, or a folder`);
if (kind === ".mp4" && spawnSync("ffmpeg", ["-version"]).error) fail("there is no ffmpeg: install it, or write a .gif file");
const browser = await launch();
if (!browser) fail("there is no Chromium: install the Debian package chromium, or name one with CHROMIUM", 1);

const { page } = await openPage(browser, resolve(page_file) + o.link, { viewport: { width, height } });
if (await page.evaluate(() => document.documentElement.dataset.failed)) fail(await page.locator("#app").textContent(), 1);
const range = await page.evaluate(() => window.polhodeFilm.begin());
const from = Number(o.from ?? range.begin), to = Number(o.to ?? range.end), count = Math.max(1, Math.round((to - from) / speed * rate) + 1);
const folder = kind === "folder" ? resolve(out) : mkdtempSync(join(tmpdir(), "polhode-film-")), pictures = [];
mkdirSync(folder, { recursive: true });
for (let k = 0; k < count; k++) {
  const part = count > 1 ? k / (count - 1) : 0;
  await page.evaluate(([t, turn]) => window.polhodeFilm.show(t, turn), [from + part * (to - from), part * Number(o.turn)]);
  if (kind === ".gif") {
    const pixels = await page.evaluate(() => window.polhodeFilm.pixels());
    pictures.push({ width: pixels.width, height: pixels.height, rgba: Buffer.from(pixels.rgba, "base64") });
  } else writeFileSync(join(folder, `${String(k).padStart(5, "0")}.png`), Buffer.from((await page.evaluate(() => window.polhodeFilm.png())).split(",")[1], "base64"));
}
await browser.close();
if (kind === ".gif") writeFileSync(out, gif(pictures, rate));
if (kind === ".mp4") {
  const made = spawnSync("ffmpeg", ["-y", "-loglevel", "error", "-framerate", String(rate), "-i", join(folder, "%05d.png"), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", out]);
  if (made.status !== 0) fail(made.stderr.toString(), 1);
}
if (kind !== "folder") rmSync(folder, { recursive: true });
console.log(`${out}: ${count} pictures of ${width} x ${height}, ${(count / rate).toFixed(1)} s`);
