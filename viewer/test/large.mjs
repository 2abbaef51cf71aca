// SPDX-License-Identifier: Apache-2.0
// Many frames, many bodies, many nodes.
import { existsSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { browser, clicked, clock, colours, expect, folder, made, page_of, recorded, run, served, shot, test } from "./support.mjs";

const list = (n, make) => Array.from({ length: n }, (_, i) => make(i)).join("\n");

/** Opens a page, and says what it took: seconds of processors of the pages, without the software that stands for a graphics processor, until
 *  it was ready, milliseconds of all processors, of the page alone and calls to draw for a picture while it plays, and megabytes that the
 *  page had at most. */
async function measured(name, pictures = 8) {
  const session = await browser.newBrowserCDPSession(), processes = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo;
  const spent = async (kind) => (await processes()).reduce((sum, { type, cpuTime }) => sum + (!kind || type === kind ? cpuTime : 0), 0);
  const pages = (await processes()).filter(({ type }) => type === "renderer").map(({ id }) => id);
  const before = await spent("renderer"), { page } = await page_of(name), loading = await spent("renderer") - before;
  const drawn = () => page.evaluate(() => Number(document.documentElement.dataset.frames ?? 0));
  await page.keyboard.press(" ");
  await page.waitForTimeout(1500);  // until rendering has adapted to a slow machine
  const from = await drawn(), busy = await spent(), alone = await spent("renderer"), issued = await page.evaluate(() => window.drawCalls);
  await page.waitForFunction((n) => Number(document.documentElement.dataset.frames) >= n, from + pictures, { timeout: 240000 });
  const count = await drawn() - from, each = 1000 * (await spent() - busy) / count, script = 1000 * (await spent("renderer") - alone) / count;
  const calls = (await page.evaluate(() => window.drawCalls) - issued) / count;
  await page.keyboard.press(" ");
  // A picture that stands still has all pixels, whatever playing has been reduced to.
  await page.waitForFunction(() => { const canvas = document.querySelector(".view > canvas"); return canvas.width === canvas.clientWidth && canvas.height === canvas.clientHeight; }, null, { timeout: 10000 });
  const own = (await processes()).filter(({ type, id }) => type === "renderer" && !pages.includes(id)).map(({ id }) => `/proc/${id}/status`).filter((file) => existsSync(file));
  const most = Math.max(...own.map((file) => Number(readFileSync(file, "utf8").match(/VmHWM:\s+(\d+)/)[1]) / 1024));
  console.log(`        ${name}: ${loading.toFixed(2)} s of processors until it is ready, ${each.toFixed(0)} ms and ${calls.toFixed(0)} calls for a picture (${script.toFixed(1)} ms by the page itself), ${most.toFixed(0)} MB at most`);
  return { page, loading, each, most, script, calls };
}

await test("a hundred bodies with ten thousand frames load in three seconds of processors, and play ten pictures a second", async () => {
  recorded("chain", `format: 1
gravity: [0, 0, -9.81]
bodies:
${list(100, (i) => `  b${i}: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [${i + 0.5}, 0, 0]}`)}
joints:
${list(100, (i) => `  j${i}: {type: revolute, bodies: [${i ? `b${i - 1}` : "ground"}, b${i}], at: [${i}, 0, 0], axis: y}`)}
analysis: {duration: 10 s, step: 1 ms}
output: {every: 1 ms}
`);
  expect(statSync(join(folder, "chain.html")).size > 20e6, "a small page");
  const { page, loading, each, most, script, calls } = await measured("chain.html", 40);
  expect(loading < 3, `it takes ${loading} s`);
  // Work of the page with a graphics processor: less than a sixtieth of a second, in a few calls independent of the number of bodies.
  expect(script < 1000 / 60 && calls < 30, `a picture takes the page ${script} ms and ${calls} calls`);
  expect(each < 100, `a picture takes ${each} ms of processors`);
  expect(most < 600, `the page takes ${most} MB`);
  await page.keyboard.press("End");
  expect(await clock(page) === 10, `the last frame is at ${await clock(page)}`);
});

await test("ten thousand bodies are shown, play and are met by a click", async () => {
  recorded("many", `format: 1
gravity: [0, 0, -9.81]
bodies:
${list(10000, (i) => `  b${i}: {shape: {${i % 2 ? "sphere: 0.2" : "box: [0.3, 0.2, 0.1]"}}, density: 1000, position: [${i % 100}, ${Math.floor(i / 100)}, ${(i * 7919) % 10}], angular_velocity: [1, 0.1, 0]}`)}
analysis: {duration: 0.5 s, step: 50 ms}
output: {every: 50 ms}
`);
  // Equal shapes are drawn as instances; ten thousand separate ones would take a second per picture.
  const { page, loading, each, most } = await measured("many.html");
  expect(loading < 6 && each < 1000 && most < 450, `${loading} s to load, ${each} ms for a picture, ${most} MB`);
  expect(await colours(page) > 60, "the picture has few colours");
  const name = await clicked(page, /^b\d+$/);
  expect(/^b\d+$/.test(name), `no click meets a body, the last one met '${name}'`);
  await page.getByLabel("Search objects by name").fill("b9999");
  await page.getByRole("button", { name: /^b9999/ }).click();
  await page.waitForFunction(() => document.querySelector(".details h2").textContent === "b9999");
  await shot(page, "many");
});

await test("a solid of a hundred thousand nodes is shown with its colours", async () => {
  recorded("strip", `format: 1
gravity: [0, 0, -9.81]
materials: {rubber: {type: neo_hookean, youngs_modulus: 10 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  strip: {mesh: {block: {size: [2500, 0.1, 0.1], cells: [25004, 1, 1]}}, material: rubber, bonded: {ground: xmin}}
analysis: {duration: 2 ms, step: 1 ms, rho_inf: 0.8}
output: {every: 1 ms}
`);
  const { page, loading, each, most } = await measured("strip.html");
  expect(loading < 8 && each < 1500 && most < 500, `${loading} s to load, ${each} ms for a picture, ${most} MB`);
  expect((await page.locator(".objects").textContent()).includes("25004 elements, 100020 nodes"), await page.locator(".objects").textContent());
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Field in colours").selectOption({ label: "displacement (size)" });
  await page.waitForFunction(() => document.querySelector(".legend").textContent.includes("displacement (size) ["));
});

await test("a server sends only what is looked at", async () => {
  made("all.html");
  await served(["all.results"], async (address) => {
    const asked = [], { page } = await page_of(address);
    page.on("request", (request) => asked.push(request.url()));
    await page.waitForTimeout(1500);  // the page checks at intervals whether the file has changed
    const idle = new Set(asked.splice(0));
    await page.getByRole("button", { name: /^arm/ }).first().click();  // loads its velocities
    await page.locator(".details td.number").nth(2).waitFor();
    const wanted = asked.splice(0).filter((url) => !idle.has(url));
    expect(wanted.length > 0, "the velocities were there before they were wanted");
    await page.getByRole("button", { name: /^ball/ }).first().click();
    await page.waitForFunction(() => document.querySelector(".details h2").textContent === "ball" && document.querySelectorAll(".details td.number").length > 2);
    expect(asked.filter((url) => !idle.has(url)).length === 0, `what is there is asked for again: ${asked}`);
  });
});

await test("a crowd of balls is drawn as balls, and each is met by a click", async () => {
  run("examples", "spheres_in_a_bin", "--set", "N=30", "-o", "crowd.yaml");
  run("run", "crowd.yaml", "--quiet", "--set", "analysis.duration=0.02 s");
  run("view", "crowd.results", "--html", "crowd.html", "--quiet");
  const { page } = await page_of("crowd.html");
  const name = await clicked(page, /^b\d+$/);
  expect(/^b\d+$/.test(name), `no click meets a ball, the last one met '${name}'`);
  // Parallel projection and a section use other drawing paths; all must show pictures with many colours.
  for (const act of [() => undefined, () => page.keyboard.press("o"), async () => { await page.getByRole("tab", { name: "Display" }).click(); await page.getByLabel("Section plane").selectOption("x"); }]) {
    await act();
    await page.waitForTimeout(200);
    expect(await colours(page) > 60, "the picture has few colours");
  }
  await shot(page, "crowd");
});
