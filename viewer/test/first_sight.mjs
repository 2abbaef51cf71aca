// SPDX-License-Identifier: Apache-2.0
// The page at first sight: plots of the probes below the picture, their layout and units, the table of extremes.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { build } from "esbuild";
import { channels, clock, expect, folder, page_of, recorded, root, saved, shot, test, violations } from "./support.mjs";

/** A source file of the page as a module. */
async function source(name) {
  const { outputFiles: [{ text }] } = await build({ entryPoints: [join(root, `viewer/src/${name}.ts`)], bundle: true, write: false, format: "esm", logLevel: "error" });
  writeFileSync(join(folder, `${name}.mjs`), text);
  return import(pathToFileURL(join(folder, `${name}.mjs`)));
}

// A crank of 0.2 m with a load of 20 kN, on a bench; probes in both ways of writing.
const probed = (probes) => `format: 1
title: Probed
gravity: [0, 0, -9.81]
bodies: {arm: {shape: {box: [1, 0.1, 0.1]}, density: 100000, position: [0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}
loads: {stay: {type: spring_damper, bodies: [ground, arm], at: [[1, 0, 1], [1, 0, 0]], stiffness: 20000, damping: 100}}
analysis: {duration: 1 s, step: 2 ms}
${probes}`;
const block = `output:
  every: 10 ms
  probes:                     # what is measured
    hinge: {joint: hinge}     # its angle
    tip:
      body: arm
      point: [0.5, 0, 0]
    stay: {load: stay, every: 1 ms}
`;
const inline = "output: {every: 10 ms, probes: {hinge: {joint: hinge}, tip: {body: arm, point: [0.5, 0, 0]}}}\n";
const made = (name) => { if (!existsSync(join(folder, `${name}.html`))) recorded(name, probed(name === "block" ? block : inline)); return `${name}.html`; };
const names = (page) => page.locator(".plot").evaluateAll((all) => all.map((plot) => [...plot.querySelectorAll(".series li")].map((li) => li.title)));
const plotted = (page, count) => page.waitForFunction((n) => document.querySelectorAll(".plot .u-over").length === n, count);

await test("the first probes are plotted under the picture, however they are written", async () => {
  for (const name of ["block", "inline"]) {
    const { page } = await page_of(made(name));
    await plotted(page, 2);
    const found = await names(page), position = ["x", "y", "z"].map((c) => `bodies.arm.position.${c} [m]`);
    expect(JSON.stringify(found) === JSON.stringify([["joints.hinge.coordinates [rad]"], position]), `${name}: ${JSON.stringify(found)}`);
    const bad = await violations(page);
    expect(bad.length === 0, bad.join(" | "));
    await shot(page, `first_${name}`);
    const phone = await page_of(`${name}.html`, { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true });
    await plotted(phone.page, 1);
  }
  const { page } = await page_of("all.html");
  expect(await page.locator(".plot").count() === 0, "there are plots without probes");
  const { probeEntries } = await source("probes"), read = (text) => probeEntries(text).map(({ name, of }) => `${name}: ${[...of].flat().join(" ")}`).join("; ");
  expect(read("output:\n  probes: {a: {contact: [x, y]}, b: {solid: s,\n    interface: i}}\n") === "a: contact [x, y]; b: solid s interface i", read("output:\n  probes: {a: {contact: [x, y]}, b: {solid: s,\n    interface: i}}\n"));
  expect(read("title: 'output: {probes: {no: {body: b}}}'\nevents:\n  probes: {no: {body: b}}\n") === "", "probes where there are none");
});

await test("every unit has an axis of its own, with SI prefixes, in the page and in the picture that is saved", async () => {
  const { prefixed, quantity } = await source("units");
  for (const [value, unit, text] of [[2.93e6, "Pa", "2.930 MPa"], [-0.0125, "m", "-12.50 mm"], [0.6, "m", "0.6000 m"], [1500, "N m", "1.500 kN m"], [2e-5, "s", "20.00 µs"], [9000, "s", "9000 s"], [5000, "kg", "5000 kg"], [0, "N", "0 N"], [2.5, "-", "2.500"],
    [1e-3, "m^2", "0.001000 m^2"], [3e7, "rad or m", "3.000e+7 rad or m"]])
    expect(quantity(value, unit) === text, `${value} ${unit} is ${quantity(value, unit)}, not ${text}`);
  expect(prefixed("J/m³", 5e5).unit === "kJ/m³" && prefixed("m³", 5e5).unit === "m³", "a prefix of a power is another unit");
  const { page } = await page_of(made("block"));
  await plotted(page, 2);
  await page.getByRole("tab", { name: "Plot" }).click();
  for (const name of ["loads.stay.force.z", "energy.kinetic"]) { await page.getByLabel("Channel to plot").fill(name); await page.getByRole("button", { name: "Add", exact: true }).click(); }
  await page.waitForFunction(() => document.querySelectorAll(".plot:last-child .series li").length === 5);
  await page.waitForTimeout(200);
  const own = channels("block", "bodies.arm.position", "loads.stay.force", "energy.kinetic"), force = Math.max(...own.map((row) => Math.abs(row[6])));
  expect(force > 1000, `the force is ${force} N`);
  const found = (await names(page))[1], svg = await saved(page, "SVG");
  expect(found[3] === "loads.stay.force.z [kN]" && found[4] === "energy.kinetic [J]", JSON.stringify(found));
  expect(await page.locator(".plot:last-child .u-axis").count() === 4, "not an axis for the time and for each of three units");
  for (const unit of ["[m]", "[kN]", "[J]"]) expect(svg.includes(`>${unit}</text>`), `the picture has no axis with ${unit}`);
  // The table has SI units, whatever is displayed.
  const csv = (await saved(page, "CSV")).trim().split("\n"), last = csv.at(-1).split(",").map(Number);
  expect(csv[0].includes("loads.stay.force.z [N]") && Math.abs(last[4] - own.at(-1)[6]) < 1e-3 * force, `${csv[0]}: ${last}`);
  await shot(page, "units");
  // Names of all curves are there, in full.
  for (const list of await page.locator(".series").all()) expect(await list.evaluate((e) => e.scrollHeight <= e.clientHeight + 1 && e.scrollWidth <= e.clientWidth + 1), "a legend is cut");
});

await test("coordinates of joints have the units of their freedoms", async () => {
  const { kFreedoms } = await source("series"), page_of_joints = readFileSync(join(root, "docs/reference/joints.md"), "utf8");
  const listed = [...page_of_joints.matchAll(/^\| `(\w+)` \| ([TR][xyz](?: [TR][xyz])*) \|/gm)].map(([, kind, freedoms]) => [kind, freedoms.replace(/[xyz ]/g, "")]);
  expect(listed.length > 8 && JSON.stringify(Object.entries(kFreedoms).sort()) === JSON.stringify(listed.sort()), `${JSON.stringify(kFreedoms)}, not ${listed.join(" ")}`);
  recorded("sleeve", `format: 1
bodies: {nut: {mass: 1, inertia: [1, 1, 1]}}
joints: {sleeve: {type: cylindrical, bodies: [ground, nut], at: [0, 0, 0], axis: x}}
loads: {thread: {type: screw, joint: sleeve, pitch: 0.3}, drive: {type: rotary_motor, joint: sleeve, speed: 2}}
analysis: {duration: 1 s, step: 2 ms}
output: {every: 20 ms, probes: {sleeve: {joint: sleeve}}}
`);
  const { page } = await page_of("sleeve.html");
  await plotted(page, 1);
  const found = await names(page), last = (await saved(page, "CSV")).trim().split("\n").at(-1).split(",").map(Number);
  expect(JSON.stringify(found) === JSON.stringify([["joints.sleeve.coordinates.0 [mm]", "joints.sleeve.coordinates.1 [rad]"]]), JSON.stringify(found));
  expect(Math.abs(Math.abs(last[1]) - 0.3 / Math.PI) < 1e-4 && Math.abs(last[2] - 2) < 1e-3, `after a second: ${last}`);
  expect(await page.locator(".u-axis").count() === 3, "one axis for angle and distance");
});

await test("plots are resized with the mouse and the keyboard, and stacked", async () => {
  const { page } = await page_of(made("block")), grip = page.getByRole("separator", { name: "Height of the plots" });
  await plotted(page, 2);
  const heights = () => page.evaluate(() => [".plots", ".plot .u-over", ".view"].map((s) => document.querySelector(s).offsetHeight));
  const before = await heights(), box = await grip.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y - 60, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction((high) => document.querySelector(".plot .u-over").clientHeight > high + 40, before[1]);
  const after = await heights();
  expect(Math.abs(after[0] - before[0] - 66) < 10 && Math.abs(before[2] - after[2] - 66) < 10, `${before} becomes ${after}`);
  await grip.press("ArrowDown");
  expect((await heights())[0] === after[0] - 24 && await grip.getAttribute("aria-valuenow") === String(after[0] - 24), `the keyboard makes it ${(await heights())[0]}`);
  const places = () => page.locator(".plot").evaluateAll((all) => all.map((plot) => plot.getBoundingClientRect()).map(({ x, y, width }) => ({ x, y, width })));
  const [a, b] = await places();
  expect(a.y === b.y && b.x > a.x, "the plots are not side by side");
  await page.getByRole("button", { name: "Stack" }).click();
  await page.waitForTimeout(200);
  const [c, d] = await places();
  expect(c.x === d.x && d.y > c.y && c.width > 1.8 * a.width, "the plots are not below each other");
  await shot(page, "stacked");
});

await test("the table of extremes has the numbers of the recording, and goes to their times", async () => {
  const { page } = await page_of(made("block"));
  await page.getByRole("tab", { name: "Extremes" }).click();
  await page.locator("table.extremes").nth(2).waitFor();
  expect((await page.locator("table.extremes caption").allTextContents()).join() === "In the plots,Probes,Reactions of joints,Loads", (await page.locator("table.extremes caption").allTextContents()).join());
  const own = channels("block", "joints.hinge.force"), size = own.map((row) => Math.hypot(row[1], row[2], row[3])), largest = Math.max(...size), k = size.indexOf(largest);
  // Mean and root mean square over time of a curve that is linear between frames.
  const length = own.at(-1)[0] - own[0][0], over = (f) => own.slice(1).reduce((sum, row, i) => sum + (row[0] - own[i][0]) * f(size[i], size[i + 1]), 0) / length;
  const mean = over((u, v) => (u + v) / 2), rms = Math.sqrt(over((u, v) => (u * u + u * v + v * v) / 3));
  const table = page.locator("table.extremes", { hasText: "Reactions of joints" }), row = table.locator("tr", { hasText: "joints.hinge.force.size" }).locator("xpath=following-sibling::tr[1]");
  expect((await table.locator("th", { hasText: "joints.hinge.force.size" }).textContent()) === "joints.hinge.force.size [kN]", "another unit");
  const shown = (await row.locator("td").allTextContents()).map(parseFloat);
  [largest, mean, rms].forEach((value, i) => expect(Math.abs(1000 * shown[i + 1] / value - 1) < 1e-3, `${shown} kN, not ${[largest, mean, rms]} N`));
  await row.getByRole("button").nth(1).click();
  expect(Math.abs(await clock(page) - own[k][0]) < 1e-6, `the time is ${await clock(page)}, not ${own[k][0]}`);
  await shot(page, "extremes");
});
