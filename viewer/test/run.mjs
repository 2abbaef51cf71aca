// SPDX-License-Identifier: Apache-2.0
// Tests of the page in a headless Chromium without network. POLHODE names the program that makes the pages; without
// Chromium or the packages of package.json the test is skipped (exit code 77). SCREENSHOTS names a folder for pictures.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, statSync, truncateSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../..");
const skip = (why) => { console.log(`skipped: ${why}`); process.exit(77); };
let launch, openPage;
try { ({ launch, openPage } = await import("./browser.mjs")); } catch { skip("the packages of viewer/package.json are not installed: run 'npm ci' in viewer/"); }
const browser = await launch();
if (!browser) skip("there is no Chromium: install the Debian package chromium, or name one with CHROMIUM");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const polhode = process.env.POLHODE ?? join(root, "build/release/apps/polhode/polhode");
const folder = mkdtempSync(join(tmpdir(), "polhode-viewer-"));
const run = (...words) => execFileSync(polhode, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] }).toString();

const model = `format: 1
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
writeFileSync(join(folder, "all.yaml"), model);
run("run", "all.yaml", "--quiet");
run("view", "all.results", "--html", "all.html", "--quiet");
copyFileSync(join(root, "examples/tyre_on_kerb/model.yaml"), join(folder, "tyre.yaml"));
run("run", "tyre.yaml", "--quiet", "--set", "analysis.duration=0.2 s");
run("view", "tyre.results", "--html", "tyre.html", "--quiet");

let failed = 0, passed = 0;
const open = [];
const page_of = async (name, options) => {
  const opened = await openPage(browser, name.startsWith("http") ? name : join(folder, name), options);
  open.push(opened);
  return opened;
};
const expect = (condition, text) => { if (!condition) throw new Error(text); };
async function test(name, body) {
  if (process.argv[2] && !process.argv[2].split("|").some((part) => name.includes(part))) return;
  try {
    await body();
    // No test may leave a message on the console, nor ask a network for anything.
    for (const { faults, requests } of open) expect(faults.length + requests.length === 0, `console or network: ${[...faults, ...requests].join(" | ")}`);
    passed++;
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}: ${error.message}`);
  }
  for (const { context } of open.splice(0)) await context.close();
}
const clock = (page) => page.locator("output.clock").textContent().then(parseFloat);
const shot = (page, name) => (process.env.SCREENSHOTS ? page.screenshot({ path: join(process.env.SCREENSHOTS, `${name}.png`) }) : null);
/** Different colours in the picture: an empty one has few. */
const colours = (page) => page.evaluate(() => {
  const from = document.querySelector(".view > canvas"), to = document.createElement("canvas");
  to.width = 200; to.height = 150;
  const ctx = to.getContext("2d");
  ctx.drawImage(from, 0, 0, 200, 150);
  const data = ctx.getImageData(0, 0, 200, 150).data, seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add((data[i] >> 3) << 10 | (data[i + 1] >> 3) << 5 | data[i + 2] >> 3);
  return seen.size;
});
const violations = async (page) => {
  await page.evaluate(axe);  // by the debugger: the page's own policy would refuse a script element
  const found = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  return found.violations.map((v) => `${v.id}: ${v.nodes.slice(0, 3).map((n) => n.html.slice(0, 120)).join(" ; ")}`);
};

await test("the saved file opens without network and shows a picture", async () => {
  const { page } = await page_of("all.html");
  expect(!(await page.evaluate(() => document.documentElement.dataset.failed)), await page.locator("#app").textContent());
  expect(await colours(page) > 40, "the picture is empty");
  expect((await page.locator(".drift").textContent()).includes("energy drift"), "no energy drift in view");
  await shot(page, "all");
});

await test("it plays, pauses, and starts again at the end", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.waitForFunction(() => parseFloat(document.querySelector("output.clock").textContent) > 0.02);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  const t = await clock(page);
  await page.waitForTimeout(200);
  expect(await clock(page) === t, "time goes on while it is paused");
  await page.keyboard.press("End");
  expect(await clock(page) === 1, "End does not go to the end");
  await page.keyboard.press("ArrowLeft");
  expect(Math.abs(await clock(page) - 0.99) < 1e-6, `one frame back is ${await clock(page)}`);
});

await test("the slider moves the time, and the picture with it", async () => {
  const { page } = await page_of("all.html");
  const before = await page.evaluate(() => document.querySelector(".view > canvas").toDataURL());
  await page.getByLabel("Time", { exact: true }).fill("50");
  expect(Math.abs(await clock(page) - 0.5) < 1e-6, `time is ${await clock(page)}`);
  await page.waitForTimeout(200);
  expect(before !== await page.evaluate(() => document.querySelector(".view > canvas").toDataURL()), "the picture stands still");
});

await test("a name chooses an object with its values and its line of the model", async () => {
  const { page } = await page_of("all.html");
  await page.getByLabel("Search objects by name").fill("hinge");
  await page.getByRole("button", { name: /hinge/ }).first().click();
  const details = page.locator(".details");
  await details.locator("td.number").first().waitFor();
  expect((await details.textContent()).includes("revolute joint"), "no kind");
  expect((await details.locator("pre").textContent()).includes("hinge: {type: revolute"), "another line of the model");
  const value = await details.locator("td.number").first().textContent();
  await page.getByLabel("Time", { exact: true }).fill("30");
  expect(value !== await details.locator("td.number").first().textContent(), "the values stand still");
});

await test("values are those of the results", async () => {
  const { page } = await page_of("all.html");
  const csv = readFileSync(join(folder, "all.yaml"), "utf8") && run("convert", "all.results", "out.csv", "--channels", "bodies.arm.position") + readFileSync(join(folder, "out.csv"), "utf8");
  const row = csv.trim().split("\n")[31].split(",").map(Number);
  await page.getByRole("button", { name: /^arm/ }).first().click();
  await page.getByLabel("Time", { exact: true }).fill("30");
  const shown = (await page.locator(".details td.number").first().textContent()).trim().split(/\s+/).map(Number);
  for (let k = 0; k < 3; k++) expect(Math.abs(shown[k] - row[k + 1]) < 1e-3 * (1 + Math.abs(row[k + 1])), `${shown} is not ${row.slice(1)}`);
});

await test("a click in the picture chooses what is there", async () => {
  const { page } = await page_of("all.html");
  const box = await page.locator(".view > canvas").boundingBox();
  let found = "";
  for (let i = 2; i < 9 && !found; i++)
    for (let j = 2; j < 9 && !found; j++) {
      await page.mouse.click(box.x + box.width * i / 10, box.y + box.height * j / 10);
      found = await page.locator(".details h2").textContent({ timeout: 50 }).catch(() => "");
    }
  expect(found !== "", "no click meets anything");
  await page.keyboard.press("Escape");
  expect(await page.locator(".details h2").count() === 0, "Escape keeps the choice");
});

await test("hidden, ghost and isolated bodies change the picture", async () => {
  const { page } = await page_of("all.html");
  const picture = async () => { await page.waitForTimeout(150); return page.evaluate(() => document.querySelector(".view > canvas").toDataURL()); };
  await page.getByRole("button", { name: /^arm/ }).first().click();
  const pictures = [await picture()];
  for (const key of ["h", "a", "g", "i"]) { await page.keyboard.press(key); pictures.push(await picture()); }
  expect(pictures[0] !== pictures[1] && pictures[1] !== pictures[3] && pictures[0] === pictures[2] && pictures[3] !== pictures[4], "pictures do not differ as they should");
});

await test("plots and time move one another; they save as CSV, SVG and PNG", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByLabel("Channel to plot").fill("bodies.arm.position");
  await page.getByRole("button", { name: "New plot" }).click();
  await page.locator(".plot .u-over").waitFor();
  const over = await page.locator(".plot .u-over").boundingBox();
  await page.mouse.click(over.x + over.width / 2, over.y + over.height / 2);
  expect(Math.abs(await clock(page) - 0.5) < 0.02, `a click in the middle of the plot goes to ${await clock(page)}`);
  await page.getByLabel("Channel to plot").fill("energy.kinetic");
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await page.waitForFunction(() => document.querySelectorAll(".series li").length === 4);
  for (const [button, head] of [["CSV", "t [s],bodies.arm.position.x [m]"], ["SVG", "<svg"], ["PNG", "\x89PNG"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: `Save as ${button}` }).click()]);
    const text = readFileSync(await download.path(), "latin1");
    expect(text.startsWith(head), `${button} begins with ${text.slice(0, 40)}`);
    if (button === "CSV") expect(text.trim().split("\n").length === 102, "not a row for each frame");
  }
  for (const kind of ["spectrum", "phase", "stacked", "time"]) { await page.getByLabel("Kind of plot").selectOption(kind); await page.waitForTimeout(60); }
  await page.getByLabel("Channel to plot").fill("bodies.nobody.position");
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await page.getByText("There is no channel 'bodies.nobody.position'.").waitFor();
  await shot(page, "plots");
});

await test("solids have colours, a legend and a choice of fields", async () => {
  const { page } = await page_of("tyre.html");
  expect((await page.locator(".legend").textContent()).includes("von mises [Pa]"), "no legend");
  const before = await page.evaluate(() => document.querySelector(".view > canvas").toDataURL());
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Field in colours").selectOption({ label: "displacement (size)" });
  await page.waitForTimeout(300);
  expect((await page.locator(".legend").textContent()).includes("displacement (size) [m]"), "the legend stays");
  await page.keyboard.press("End");
  await page.waitForTimeout(300);
  expect(before !== await page.evaluate(() => document.querySelector(".view > canvas").toDataURL()), "the picture stays");
  await page.getByLabel("Section plane").selectOption("y");
  await page.waitForTimeout(200);
  await shot(page, "tyre");
});

await test("a link keeps camera, time and choice", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("button", { name: /^arm/ }).first().click();
  await page.getByLabel("Time", { exact: true }).fill("25");
  await page.keyboard.press("1");
  await page.keyboard.press("b");
  const hash = await page.evaluate(() => location.hash);
  const again = await page_of("all.html" + hash);
  expect(Math.abs(await clock(again.page) - 0.25) < 1e-6, "another time");
  expect(await again.page.locator(".details h2").textContent() === "arm", "another choice");
});

await test("two clicks measure a distance", async () => {
  const { page } = await page_of("all.html");
  await page.keyboard.press("m");
  expect(await page.locator(".measure").isVisible(), "no ruler");
  const box = await page.locator(".view > canvas").boundingBox();
  for (let i = 1; i < 10 && !/\d m/.test(await page.locator(".measure").textContent()); i++)
    for (const y of [0.5, 0.65, 0.8]) await page.mouse.click(box.x + box.width * i / 10, box.y + box.height * y);
  expect(/\d m/.test(await page.locator(".measure").textContent()), "no distance");
});

await test("a second recording is a ghost, and plots show the difference", async () => {
  run("run", "all.yaml", "--quiet", "-o", "other.results", "--set", "bodies.ball.position=[0.6, 0, 0.5]", "--set", "analysis.duration=0.6 s");
  run("view", "all.results", "other.results", "--html", "compared.html", "--quiet");
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
  await becomes(false).catch(() => expect(false, "the ghost is not seen"));
  await page.keyboard.press("c");
  await becomes(true).catch(() => expect(false, "the ghost does not come back"));
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByLabel("Channel to plot").fill("bodies.ball.position.z");
  await page.getByRole("button", { name: "New plot" }).click();
  await page.waitForFunction(() => document.querySelectorAll(".series li").length === 2);
  await page.getByLabel("Kind of plot").selectOption("difference");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save as CSV" }).click()]);
  const rows = readFileSync(await download.path(), "utf8").trim().split("\n").map((row) => row.split(","));
  expect(rows[0][1] === "Δ bodies.ball.position.z [m]", rows[0].join());
  const z = (name) => { run("convert", `${name}.results`, "z.csv", "--channels", "bodies.ball.position.z"); return readFileSync(join(folder, "z.csv"), "utf8").trim().split("\n").slice(1).map((row) => Number(row.split(",")[1])); };
  const a = z("all"), b = z("other");
  for (const k of [0, 7, 30, 60]) expect(Math.abs(Number(rows[k + 1][1]) - (b[k] - a[k])) < 1e-6, `row ${k} is ${rows[k + 1]}, not ${b[k] - a[k]}`);
  expect(Math.abs(Number(rows[1][1]) - 0.3) < 1e-6 && rows[101][1] === "NaN", `begins with ${rows[1]}, ends with ${rows[101]}`);
  const found = await violations(page);
  expect(found.length === 0, found.join(" | "));
  await shot(page, "compared");
});

await test("recordings in an archive share the player", async () => {
  run("view", "all.results", "tyre.results", "--zip", "both.zip", "--quiet");
  execFileSync("python3", ["-m", "zipfile", "-e", "both.zip", "both"], { cwd: folder });
  expect(statSync(join(folder, "both.zip")).size < statSync(join(folder, "all.html")).size, "the archive of two is larger than one page");
  for (const name of ["all", "tyre"]) {
    const { page } = await page_of(`both/${name}.html`);
    expect(!(await page.evaluate(() => document.documentElement.dataset.failed)), await page.locator("#app").textContent());
    expect(await colours(page) > 30, "the picture is empty");
  }
  const list = readFileSync(join(folder, "both/index.html"), "utf8");
  expect(list.includes('<a href="all.html">all</a> Everything, 101 frames') && list.includes('href="tyre.html"'), list);
});

const slide = (page, label, value) => page.getByLabel(label, { exact: true }).evaluate((input, x) => { input.value = x; input.dispatchEvent(new Event("input")); }, value);
const picture = async (page) => {  // of what is drawn now: the page draws before the second of two frames
  await page.waitForTimeout(150);
  return page.evaluate(async () => {
    for (let k = 0; k < 3; k++) await new Promise(requestAnimationFrame);
    return document.querySelector(".view > canvas").toDataURL();
  });
};

await test("elements of solids have colours of their own, and solids may have different fields", async () => {
  const { page } = await page_of("tyre.html");
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Time", { exact: true }).fill("5");
  const offered = await page.getByLabel("Field in colours").locator("option").allTextContents();
  for (const name of ["von mises by element", "principal stretches by element largest", "cauchy by element xy", "velocity (size)", "von mises"]) expect(offered.includes(name), `${name} is not in ${offered}`);
  await page.getByLabel("Field in colours").selectOption({ label: "principal stretches by element largest" });
  await page.waitForFunction(() => document.querySelector(".legend").textContent.includes("principal stretches by element largest [-]"));
  const stretched = await picture(page), [low, high] = await page.evaluate(() => ["Lowest", "Highest"].map((n) => document.querySelector(`[aria-label="${n} value in colours"]`).valueAsNumber));
  expect(low >= 0 && high > 1 && high < 3, `stretches from ${low} to ${high}`);
  await shot(page, "tyre_elements");
  await page.getByLabel("Highest value in colours").fill("1.01");
  await page.keyboard.press("Enter");
  expect(await picture(page) !== stretched, "the range changes nothing");
  await page.getByLabel("Field in colours").selectOption({ label: "von mises by element" });
  await page.waitForFunction(() => document.querySelector(".legend").textContent.includes("von mises by element [Pa]"));
  const flat = await picture(page);
  await page.getByLabel("Field in colours").selectOption({ label: "von mises" });
  await page.waitForTimeout(300);
  expect(await picture(page) !== flat, "elements and nodes have one picture");
});

await test("the helical axis of a body is the axis of its hinge, of a screw with its pitch, seen from the ground and from a body", async () => {
  writeFileSync(join(folder, "screw.yaml"), `format: 1
bodies:
  table: {mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}
  nut: {mass: 1, inertia: [1, 1, 1], position: [1, 0.5, 0], shape: {box: [0.2, 0.2, 0.2]}, angular_velocity: [2, 0, 1], velocity: [0.1, 1, 0]}
joints:
  turns: {type: revolute, bodies: [ground, table], at: [0, 0, 0], axis: z}
  slides: {type: cylindrical, bodies: [table, nut], at: [1, 0, 0], axis: x}
loads:
  thread: {type: screw, joint: slides, pitch: 0.3}
  drive: {type: rotary_motor, joint: turns, speed: 1}
  other: {type: rotary_motor, joint: slides, speed: 2}
analysis: {duration: 1 s, step: 2 ms}
output: {every: 20 ms}
`);
  const axis_of = async (page) => {
    const text = await page.locator(".helical").textContent(), number = "-?[\\d.]+(?:e[+-]?\\d+)?";
    const found = text.match(new RegExp(`^(${number}) rad/s about (.*) through (.*) m; (${number}) m along`));
    expect(found, `the axis reads '${text}'`);
    return { rate: Number(found[1]), along: found[2].split(",").map(Number), point: found[3].split(",").map(Number), pitch: Number(found[4]) };
  };
  const { page } = await page_of("all.html");
  await page.getByRole("tab", { name: "Display" }).click();
  const before = await picture(page);
  await page.getByLabel("Time", { exact: true }).fill("30");
  await page.getByLabel("Body of the helical axis").selectOption("arm");
  await page.waitForFunction(() => document.querySelector(".helical").textContent.includes("rad/s"));
  const hinge = await axis_of(page), near = (a, b, by) => Math.abs(a - b) < by;
  expect(near(Math.abs(hinge.along[1]), 1, 1e-3) && near(hinge.point[0], 0, 1e-3) && near(hinge.point[2], 1, 1e-3) && near(hinge.pitch, 0, 1e-6), JSON.stringify(hinge));
  expect(await picture(page) !== before, "no axis in the picture");
  await shot(page, "helical");
  run("run", "screw.yaml", "--quiet");
  run("view", "screw.results", "--html", "screw.html", "--quiet");
  const other = await page_of("screw.html");
  await other.page.getByRole("tab", { name: "Display" }).click();
  await other.page.getByLabel("Time", { exact: true }).fill("25");
  await other.page.getByLabel("Body of the helical axis").selectOption("nut");
  await other.page.getByLabel("Helical axis seen from").selectOption("table");
  await other.page.waitForFunction(() => document.querySelector(".helical").textContent.includes("rad/s"));
  // The table has turned by 0.5 rad: the screw's axis is its x, through its middle; lead over one turn is the pitch for a radian.
  const screw = await axis_of(other.page), t = 0.5;
  expect(near(screw.rate, 2, 1e-3) && near(Math.abs(screw.along[0]), Math.cos(t), 2e-3) && near(Math.abs(screw.along[1]), Math.sin(t), 2e-3), JSON.stringify(screw));
  expect(near(Math.abs(screw.pitch), 0.3 / (2 * Math.PI), 1e-4) && near(screw.point[1] * Math.cos(t) - screw.point[0] * Math.sin(t), 0, 2e-3) && near(screw.point[2], 0, 2e-3), JSON.stringify(screw));
  await other.page.getByLabel("Helical axis seen from").selectOption("ground");
  await other.page.waitForFunction(() => !document.querySelector(".helical").textContent.startsWith("2.000"));
  const both = await axis_of(other.page);  // rates of 1 about z and 2 about the table's x together
  expect(near(both.rate, Math.sqrt(5), 2e-3) && near(Math.abs(both.along[2]), 1 / Math.sqrt(5), 2e-3), JSON.stringify(both));
});

await test("trails, centres, axes, parallel projection, section and follow change the picture and come back", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("button", { name: /^arm/ }).first().click();
  await page.getByLabel("Time", { exact: true }).fill("40");
  await page.getByRole("tab", { name: "Display" }).click();
  const plain = await picture(page);
  for (const label of ["Trails", "Centres of mass", "Body axes", "Parallel projection (o)", "Reactions of joints", "Ground grid", "World axes", "Springs and motors", "Bodies as ghosts"]) {
    const box = page.getByLabel(label, { exact: true });
    await box.click();
    expect(await picture(page) !== plain, `${label} changes nothing`);
    await box.click();
    await page.waitForTimeout(100);
    expect(await picture(page) === plain, `${label} does not go back`);
  }
  for (const axis of ["x", "y", "z"]) {
    await page.getByLabel("Section plane").selectOption(axis);
    expect(await picture(page) !== plain, `a section across ${axis} changes nothing`);
  }
  await page.getByLabel("Section plane").selectOption("none");
  expect(await picture(page) === plain, "the section does not go");
  // Followed, the arm stays where it is in the picture while everything else moves: its centre projects to one place.
  await page.keyboard.press("f");
  const eye = async () => { await page.keyboard.press("b"); return page.evaluate(() => location.hash.match(/at=([^&]*)/)[1].split(",").map(Number)); };
  const first = await eye();
  await page.getByLabel("Time", { exact: true }).fill("80");
  const moved = await eye();
  run("convert", "all.results", "arm.csv", "--channels", "bodies.arm.position");
  const rows = readFileSync(join(folder, "arm.csv"), "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  for (let k = 0; k < 3; k++) expect(Math.abs(moved[k] - first[k] - rows[80][k + 1] + rows[40][k + 1]) < 1e-3, `the camera goes from ${first} to ${moved}`);
});

await test("forces are scaled and filtered", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Time", { exact: true }).fill("60");
  const plain = await picture(page);
  await slide(page, "Length of arrows", 2.5);
  const long = await picture(page);
  await slide(page, "Smallest shown, part of the largest", 0.5);
  expect(plain !== long && await picture(page) !== long, "arrows stay as they are");
});

await test("speed and loop do what they say", async () => {
  const { page } = await page_of("all.html");
  await page.getByLabel("Speed").selectOption("10×");
  await page.getByRole("button", { name: "Loop" }).click();
  await page.keyboard.press("End");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.getByRole("button", { name: "Play", exact: true }).waitFor({ timeout: 20000 });
  expect(await clock(page) === 1, `without a loop it stops at ${await clock(page)}`);
});

await test("a spectrum peaks where it should, and stacked energies add up", async () => {
  writeFileSync(join(folder, "tone.yaml"), `format: 1
bodies: {bob: {point_mass: true, mass: 1, position: [1.1, 0, 0]}}
loads: {spring: {type: spring_damper, bodies: [ground, bob], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 986.96044, free_length: 1}}
analysis: {duration: 8 s, step: 2 ms}
output: {every: 10 ms}
`);
  run("run", "tone.yaml", "--quiet");
  run("view", "tone.results", "--html", "tone.html", "--quiet");
  const { page } = await page_of("tone.html");
  await page.getByRole("tab", { name: "Plot" }).click();
  await page.getByLabel("Channel to plot").fill("bodies.bob.position.x");
  await page.getByRole("button", { name: "New plot" }).click();
  await page.getByLabel("Kind of plot").selectOption("spectrum");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save as CSV" }).click()]);
  const rows = readFileSync(await download.path(), "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  const [frequency, amplitude] = rows.reduce((a, b) => (b[1] > a[1] ? b : a));
  // sqrt(k / m) = 10 pi: 5 Hz, with an amplitude of 0.1 m.
  expect(Math.abs(frequency - 5) < 0.13 && Math.abs(amplitude - 0.1) < 0.02, `the peak is ${amplitude} m at ${frequency} Hz`);
});

await test("two recordings stand side by side", async () => {
  const { page } = await page_of("compared.html");
  await page.getByLabel("Time", { exact: true }).fill("20");
  const ghost = await picture(page);
  await page.keyboard.press("v");
  await page.locator(".sides").waitFor();
  expect((await page.locator(".sides").textContent()) === "all.resultsother.results" && !await page.locator(".compared").isVisible(), "the pictures have no names");
  const beside = await picture(page);
  // Each half has bodies: many colours, and the halves differ, as the ball hangs elsewhere.
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
      name = await page.locator(".details h2").textContent({ timeout: 30 }).catch(() => "");
    }
  expect(name === "ball", "no click in the right picture meets the ball");
  await page.keyboard.press("Escape");
  await page.keyboard.press("v");
  expect(beside !== ghost, "the pictures are one");
  await page.waitForFunction((was) => document.querySelector(".view > canvas").toDataURL() === was, ghost, { timeout: 20000 }).catch(() => expect(false, "the ghost does not come back"));
});

await test("a page in the frame of a notebook plays", async () => {
  // As python/polhode/_show.py writes it: no origin of its own, scripts and downloads only.
  const text = readFileSync(join(folder, "all.html"), "utf8").replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  writeFileSync(join(folder, "notebook.html"), `<!doctype html><title>Notebook</title><iframe srcdoc="${text}" width="100%" height="600" sandbox="allow-scripts allow-downloads"></iframe><script>document.documentElement.dataset.ready = "1"</script>`);
  const { page } = await page_of("notebook.html");
  const frame = page.frameLocator("iframe");
  await frame.getByRole("button", { name: "Play", exact: true }).click({ timeout: 60000 });
  await frame.locator("output.clock").filter({ hasText: /0\.0[2-9]|0\.[1-9]/ }).waitFor({ timeout: 20000 });
});

await test("a hundred bodies with ten thousand frames load in three seconds of processors", async () => {
  const n = 100, all = (make) => Array.from({ length: n }, (_, i) => make(i)).join("\n");
  writeFileSync(join(folder, "chain.yaml"), `format: 1
gravity: [0, 0, -9.81]
bodies:
${all((i) => `  b${i}: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [${i + 0.5}, 0, 0]}`)}
joints:
${all((i) => `  j${i}: {type: revolute, bodies: [${i ? `b${i - 1}` : "ground"}, b${i}], at: [${i}, 0, 0], axis: y}`)}
analysis: {duration: 10 s, step: 1 ms}
output: {every: 1 ms}
`);
  run("run", "chain.yaml", "--quiet");
  run("view", "chain.results", "--html", "chain.html", "--quiet");
  expect(statSync(join(folder, "chain.html")).size > 20e6, "a small page");
  const session = await browser.newBrowserCDPSession();
  // Of the pages, not of the software that stands for a graphics processor: what a recording costs.
  const spent = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo.reduce((sum, { type, cpuTime }) => sum + (type === "renderer" ? cpuTime : 0), 0);
  const before = await spent(), { page } = await page_of("chain.html"), took = await spent() - before;
  console.log(`        ${took.toFixed(2)} s of processors, ready after ${(Number(await page.evaluate(() => document.documentElement.dataset.ready)) / 1000).toFixed(2)} s`);
  expect(took < 3, `it takes ${took} s`);
  await page.keyboard.press("End");
  expect(await clock(page) === 10, `the last frame is at ${await clock(page)}`);
});

await test("a model that overlaps is shown with what overlaps", async () => {
  writeFileSync(join(folder, "overlap.yaml"), `format: 1
bodies:
  one: {shape: {box: [1, 1, 1]}, density: 1000}
  two: {shape: {sphere: 0.5}, density: 1000, position: [0.7, 0, 0]}
  far: {shape: {sphere: 0.5}, density: 1000, position: [3, 0, 0]}
contacts: {}
analysis: {duration: 1 s, step: 1 ms}
`);
  run("view", "overlap.yaml", "--html", "overlap.html", "--quiet");
  const { page } = await page_of("overlap.html");
  const note = await page.locator(".notes").textContent();
  expect(note.includes("overlap at the start") && note.includes("contacts.overlaps: resolve"), note);
  await page.getByRole("button", { name: /^two/ }).first().click();
  expect((await page.locator(".details .warn").textContent()) === "overlaps at the start", "the body has no mark");
  await page.getByRole("button", { name: /^far/ }).first().click();
  await page.waitForFunction(() => document.querySelector(".details h2").textContent === "far");
  expect(await page.locator(".details .warn").count() === 0, "a body apart has a mark");
  await shot(page, "overlap");
});

for (const [name, options] of [["wide and light", {}], ["dark", { colorScheme: "dark" }], ["on a phone", { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true }]])
  await test(`nothing stands in the way of anyone, ${name}`, async () => {
    const { page } = await page_of("all.html", options);
    expect(await colours(page) > 30, "the picture is empty");
    if (options.isMobile) await page.getByRole("button", { name: "Panel" }).click();
    for (const tab of ["Plot", "Display", "Objects"]) {
      await page.getByRole("tab", { name: tab }).click();
      const found = await violations(page);
      expect(found.length === 0, found.join(" | "));
    }
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the window");
    if (options.colorScheme) expect(await page.evaluate(() => getComputedStyle(document.body).backgroundColor) === "rgb(20, 25, 31)", "not dark");
    await shot(page, name.replaceAll(" ", "_"));
  });

await test("the picture follows the size of the window", async () => {
  const { page } = await page_of("all.html");
  await page.setViewportSize({ width: 1100, height: 500 });
  await page.waitForFunction(() => document.querySelector(".view > canvas").clientWidth === 770);
  expect(await colours(page) > 30, "the picture is empty");
});

await test("results that are cut short are shown up to the last whole frame", async () => {
  const file = join(folder, "cut.h5");
  run("run", "all.yaml", "--quiet", "-o", "long.results", "--set", "analysis.step=0.5 ms", "--set", "output.every=0.5 ms");
  copyFileSync(join(folder, "long.results/results.h5"), file);
  truncateSync(file, Math.floor(0.8 * statSync(file).size));
  run("view", "cut.h5", "--html", "cut.html", "--quiet");
  const { page } = await page_of("cut.html");
  expect((await page.locator(".notes").textContent({ timeout: 2000 })).includes("cut short"), "no note");
  await page.keyboard.press("End");
  const end = await clock(page);
  expect(end > 0.1 && end < 1, `the last frame is at ${end}`);
});

await test("a page that has lost its end says so", async () => {
  const text = readFileSync(join(folder, "all.html"), "utf8"), last = text.lastIndexOf('<script type="application/octet-stream"');
  expect(last > text.lastIndexOf("<script>"), "no numbers stand behind the player");
  writeFileSync(join(folder, "lost.html"), text.slice(0, last));
  const { page } = await page_of("lost.html");
  expect(await colours(page) > 40, "what is whole is not shown");
  await page.getByRole("button", { name: /^hinge/ }).first().click();
  await page.getByText("This page is incomplete").waitFor({ timeout: 10000 });
  const chunk = text.indexOf('<script type="application/octet-stream" id="chunk-1"');
  writeFileSync(join(folder, "lost.html"), text.slice(0, chunk) + text.slice(text.indexOf("</script>", chunk) + 9));
  const again = await page_of("lost.html");
  expect((await again.page.locator("[role=alert]").textContent()).includes("incomplete"), "no message");
});

await test("an animated scene passes the validator of the Khronos Group", async () => {
  const { default: validator } = await import("gltf-validator");
  run("convert", "all.results", "all.glb");
  const bytes = new Uint8Array(readFileSync(join(folder, "all.glb"))), report = await validator.validateBytes(bytes);
  expect(report.issues.numErrors + report.issues.numWarnings === 0, JSON.stringify(report.issues.messages.slice(0, 3)));
  expect(report.info.animationCount === 1 && report.info.totalVertexCount > 100, "no animation or no shapes");
});

await test("a film has the pictures that were asked for", async () => {
  run("convert", "all.results", "film.gif", "--size", "160x120", "--rate", "8", "--to", "0.5", "--turn", "30");
  const { page } = await page_of("all.html");
  // Decoded by the browser, which is no work of ours.
  const found = await page.evaluate(async (text) => {
    const decoder = new ImageDecoder({ data: Uint8Array.from(atob(text), (c) => c.charCodeAt(0)), type: "image/gif" });
    await decoder.tracks.ready;
    await decoder.completed;
    const pictures = [];
    for (let k = 0; k < decoder.tracks.selectedTrack.frameCount; k++) {
      const { image } = await decoder.decode({ frameIndex: k }), canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight), context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const data = context.getImageData(0, 0, canvas.width, canvas.height).data, seen = new Set();
      for (let i = 0; i < data.length; i += 4) seen.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
      pictures.push({ size: `${canvas.width}x${canvas.height}`, colours: seen.size, sum: data.reduce((s, v, i) => (s + v * (i % 65521)) % 4294967291, 0) });
    }
    return pictures;
  }, readFileSync(join(folder, "film.gif")).toString("base64"));
  expect(found.length === 5 && found[0].size === "160x120" && found.every((p) => p.colours > 20), JSON.stringify(found));
  expect(new Set(found.map((p) => p.sum)).size === 5, "pictures are alike");
  run("convert", "all.results", "pictures", "--size", "64x48", "--rate", "2");
  expect(readFileSync(join(folder, "pictures/00002.png")).subarray(1, 4).toString() === "PNG", "no pictures in the folder");
  const told = (...words) => { try { run("convert", "all.results", ...words); return "nothing"; } catch (error) { return error.stderr.toString(); } };
  for (const [words, text] of [[["film.avi"], "cannot write '.avi' files"], [["film.gif", "--size", "10"], "Write it as 640x400"], [["film.gif", "--from", "3"], "the recording goes from 0 to 1 s"]])
    expect(told(...words).includes(text), told(...words));
  const there = spawnSync("ffmpeg", ["-version"]).error === undefined;
  if (!there) expect(told("film.mp4").includes("ffmpeg, which is missing"), told("film.mp4"));
  if (there) { run("convert", "all.results", "film.mp4", "--size", "160x120", "--rate", "8"); expect(statSync(join(folder, "film.mp4")).size > 1000, "no film"); }
});

await test("a crowd of balls is drawn as balls, and each is met by a click", async () => {
  run("examples", "spheres_in_a_bin", "--set", "N=30", "-o", "crowd.yaml");
  run("run", "crowd.yaml", "--quiet", "--set", "analysis.duration=0.02 s");
  run("view", "crowd.results", "--html", "crowd.html", "--quiet");
  const { page } = await page_of("crowd.html");
  const box = await page.locator(".view > canvas").boundingBox();
  let name = "";
  for (let i = 3; i < 8 && !/^b\d+$/.test(name); i++)
    for (let j = 3; j < 8 && !/^b\d+$/.test(name); j++) {
      await page.mouse.click(box.x + box.width * i / 10, box.y + box.height * j / 10);
      name = await page.locator(".details h2").textContent({ timeout: 50 }).catch(() => "");
    }
  expect(/^b\d+$/.test(name), `no click meets a ball, the last one met '${name}'`);
  // Parallel projection and a section draw them another way; all must show pictures full of colours.
  for (const act of [() => undefined, () => page.keyboard.press("o"), async () => { await page.getByRole("tab", { name: "Display" }).click(); await page.getByLabel("Section plane").selectOption("x"); }]) {
    await act();
    await page.waitForTimeout(200);
    expect(await colours(page) > 60, "the picture has few colours");
  }
  await shot(page, "crowd");
});

await test("two recordings are served", async () => {
  const server = spawn(polhode, ["view", "all.results", "other.results", "--no-open"], { cwd: folder });
  try {
    const address = await new Promise((resolve) => server.stdout.once("data", (data) => resolve(data.toString().trim())));
    const { page } = await page_of(address);
    expect((await page.locator(".compared").textContent()).includes("other.results"), "no ghost");
  } finally { server.kill("SIGINT"); }
});

await test("a model is served, and loaded again when it is saved", async () => {
  writeFileSync(join(folder, "served.yaml"), model);
  const server = spawn(polhode, ["view", "served.yaml", "--no-open"], { cwd: folder });
  try {
    const address = await new Promise((resolve) => server.stdout.once("data", (data) => resolve(data.toString().trim())));
    const { page } = await page_of(address);
    expect((await page.locator(".notes").textContent()).includes("mobility"), "no mobility");
    await page.waitForTimeout(500);
    writeFileSync(join(folder, "served.yaml"), model.replace("title: Everything", "title: Saved again"));
    await page.getByRole("heading", { name: "Saved again" }).waitFor({ timeout: 10000 });
    // What is wrong is told with its place, and the page comes back when it is mended; redundant joints are marked.
    const saved = async (text) => { await page.waitForTimeout(1200); writeFileSync(join(folder, "served.yaml"), text); };
    await saved(model.replace("restitution: 0.5", "restituton: 0.5"));
    await page.locator(".failed").waitFor({ timeout: 10000 });
    expect(/served\.yaml:\d+:\d+.*restituton[^]*restitution/.test(await page.locator(".failed").textContent()), await page.locator(".failed").textContent());
    await saved(model.replace("joints:\n", "joints:\n  second: {type: revolute, bodies: [ground, arm], at: [0, 1.5, 1], axis: y}\n"));
    await page.locator(".notes").waitFor({ timeout: 10000 });
    expect((await page.locator(".notes").textContent()).includes("5 redundant"), await page.locator(".notes").textContent());
    await page.getByRole("button", { name: /^second/ }).first().click();
    expect((await page.locator(".details .warn").textContent()).includes("redundant"), "the joint has no mark");
  } finally { server.kill("SIGINT"); }
});

await browser.close();
rmSync(folder, { recursive: true });
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
