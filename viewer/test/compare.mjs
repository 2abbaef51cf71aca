// SPDX-License-Identifier: Apache-2.0
// Two recordings in one page.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { channels, chosen, expect, folder, made, model, page_of, picture, run, saved, served, shot, test, violations } from "./support.mjs";

await test("a second recording is a ghost, and plots show the difference", async () => {
  const { page } = await page_of("compared.html");
  const steady = async () => {
    for (let last = ""; ;) {
      const now = await page.evaluate(() => document.querySelector(".view > canvas").toDataURL());
      if (now === last) return now;
      last = now;
      await page.waitForTimeout(400);
    }
  };
  expect((await page.locator(".compared").textContent()).includes("all.results, and as a ghost other.results, which ends at 0.6000 s"), await page.locator(".compared").textContent());
  await page.getByLabel("Time", { exact: true }).fill("20");
  const both = await steady();
  const becomes = (same) => page.waitForFunction(([was, want]) => (document.querySelector(".view > canvas").toDataURL() === was) === want, [both, same], { timeout: 20000 });
  await page.keyboard.press("c");
  await becomes(false).catch(() => expect(false, "the ghost is not visible"));
  await page.keyboard.press("c");
  await becomes(true).catch(() => expect(false, "the ghost does not come back"));
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByLabel("Channel to plot").fill("bodies.ball.position.z");
  await page.getByRole("button", { name: "New plot" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".series li").length === 2);
  await page.getByLabel("Kind of plot").selectOption("difference");
  const rows = (await saved(page, "CSV")).trim().split("\n").map((row) => row.split(","));
  expect(rows[0][1] === "Δ bodies.ball.position.z [m]", rows[0].join());
  const z = (name) => channels(name, "bodies.ball.position.z").map((row) => row[1]);
  const a = z("all"), b = z("other");
  for (const k of [0, 7, 30, 60]) expect(Math.abs(Number(rows[k + 1][1]) - (b[k] - a[k])) < 1e-6, `row ${k} is ${rows[k + 1]}, not ${b[k] - a[k]}`);
  expect(Math.abs(Number(rows[1][1]) - 0.3) < 1e-6 && rows[101][1] === "NaN", `begins with ${rows[1]}, ends with ${rows[101]}`);
  const found = await violations(page);
  expect(found.length === 0, found.join(" | "));
  await shot(page, "compared");
});

await test("two recordings stand side by side", async () => {
  const { page } = await page_of("compared.html");
  await page.getByLabel("Time", { exact: true }).fill("20");
  const ghost = await picture(page);
  await page.keyboard.press("v");
  await page.locator(".sides").waitFor();
  expect((await page.locator(".sides").textContent()) === "all.resultsother.results" && !await page.locator(".compared").isVisible(), "the pictures have no names");
  const beside = await picture(page);
  // Each half shows bodies, in many colours, and the halves differ, as the ball is at another position.
  const halves = await page.evaluate(() => {
    const from = document.querySelector(".view > canvas"), to = document.createElement("canvas"), w = from.width / 2, h = from.height;
    Object.assign(to, { width: from.width, height: h });
    const context = to.getContext("2d", { willReadFrequently: true });
    context.drawImage(from, 0, 0);
    const of = (x) => context.getImageData(x, 0, w, h).data, [a, b] = [of(0), of(Math.floor(w))];
    const count = (data) => { const seen = new Set(); for (let i = 0; i < data.length; i += 4) seen.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]); return seen.size; };
    let differ = 0;
    for (let i = 0; i < a.length; i += 4) differ += a[i] !== b[i] ? 1 : 0;
    return { a: count(a), b: count(b), differ: differ / (a.length / 4) };
  });
  await shot(page, "side_by_side");
  expect(halves.a > 40 && halves.b > 40 && halves.differ > 0.001 && halves.differ < 0.4, JSON.stringify(halves));
  const box = await page.locator(".view > canvas").boundingBox();
  let name = "";
  for (let i = 11; i < 20 && name !== "ball"; i++)
    for (let j = 2; j < 19 && name !== "ball"; j++) {
      await page.mouse.click(box.x + box.width * i / 20, box.y + box.height * j / 20);
      name = await chosen(page);
    }
  expect(name === "ball", "no click in the right picture meets the ball");
  await page.keyboard.press("Escape");
  await page.keyboard.press("v");
  expect(beside !== ghost, "the pictures are one");
  await page.waitForFunction((was) => document.querySelector(".view > canvas").toDataURL() === was, ghost, { timeout: 20000 }).catch(() => expect(false, "the ghost does not come back"));
});

/** Part of the pixels that differ, of the picture from an earlier one, or of its right half from its left half. */
const differing = (page, before) => page.evaluate(async (before) => {
  const read = async (source, x, w, h) => { const context = new OffscreenCanvas(w, h).getContext("2d"); context.drawImage(source, -x, 0); return context.getImageData(0, 0, w, h).data; };
  const now = document.querySelector(".view > canvas"), { height } = now, width = before ? now.width : Math.floor(now.width / 2);
  const first = before ? Object.assign(new Image(), { src: before }) : now;
  if (before) await first.decode();
  const a = await read(first, 0, width, height), b = await read(now, before ? 0 : now.width / 2, width, height);
  let differ = 0;
  for (let i = 0; i < a.length; i += 4) differ += [0, 1, 2].some((k) => Math.abs(a[i + k] - b[i + k]) > 24) ? 1 : 0;
  return differ / (a.length / 4);
}, before ?? null);

await test("bodies of equal names have equal colours, and a ghost hides nothing at the same place", async () => {
  made("compared.html");
  // One body more, and so another order of the others; too far to be seen.
  writeFileSync(join(folder, "more.yaml"), model.replace("bodies:\n", "bodies:\n  extra: {shape: {sphere: 0.1}, density: 1000, position: [0, 300, 300]}\n").replace("contacts: {default: {restitution: 0.5}}", "contacts: {}"));
  run("run", "more.yaml", "--quiet", "--set", "analysis.duration=10 ms");
  run("view", "all.results", "more.results", "--html", "more.html", "--quiet");
  const { page } = await page_of("more.html"), ghost = await picture(page);
  await shot(page, "ghost");
  await page.keyboard.press("c");
  await page.waitForTimeout(300);
  await picture(page);
  await shot(page, "noghost");
  expect(await differing(page, ghost) < 0.004, `${await differing(page, ghost)} of the picture are changed by a ghost at the same place`);
  await page.keyboard.press("v");
  await page.locator(".sides").waitFor();
  await picture(page);
  await shot(page, "equal_colours");
  expect(await differing(page) < 0.004, `${await differing(page)} of the two pictures differ`);
});

await test("two recordings are served", async () => {
  made("compared.html");
  await served(["all.results", "other.results"], async (address) => {
    const { page } = await page_of(address);
    expect((await page.locator(".compared").textContent()).includes("other.results"), "no ghost");
  });
});
