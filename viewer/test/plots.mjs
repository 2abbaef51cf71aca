// SPDX-License-Identifier: Apache-2.0
// Plots: linked to the time, zoomed, stacked, over one another, saved.
import { existsSync } from "node:fs";
import { join } from "node:path";
import { channels, clock, expect, folder, page_of, recorded, saved, shot, table, test } from "./support.mjs";

// A mass on a spring: k / m = (10 pi)^2, so 5 Hz, with an amplitude of 0.1 m about 1 m.
const tone = `format: 1
bodies: {bob: {point_mass: true, mass: 1, position: [1.1, 0, 0]}}
loads: {spring: {type: spring_damper, bodies: [ground, bob], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 986.96044, free_length: 1}}
analysis: {duration: 8 s, step: 2 ms}
output: {every: 10 ms}
`;

// A damped pendulum that falls below the height of zero potential energy.
const swing = `format: 1
gravity: [0, 0, -9.81]
bodies: {arm: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}}
loads: {damper: {type: spring_damper, bodies: [ground, arm], at: [[1, 0, -1], [1, 0, 0]], damping: 10}}
analysis: {duration: 1 s, step: 2 ms}
output: {every: 10 ms}
`;

// A tumbling block: its own axes and those of the world differ.
const tumble = `format: 1
bodies: {block: {shape: {box: [1, 0.6, 0.2]}, density: 1000, angular_velocity: [0.3, 4, 0.2]}}
analysis: {duration: 4 s, step: 10 ms, order: 4}
output: {every: 20 ms}
`;

/** A page with a plot of some channels. */
async function plotted(name, ...list) {
  for (const [own, text] of Object.entries({ tone, swing, tumble })) if (name === `${own}.html` && !existsSync(join(folder, name))) recorded(own, text);
  const { page } = await page_of(name);
  await page.getByRole("tab", { name: "Plot" }).click();
  for (const [k, channel] of list.entries()) {
    await page.getByLabel("Channel to plot").fill(channel);
    await page.getByRole("button", { name: k === 0 ? "New plot" : "Add", exact: true }).click();
    await page.waitForFunction((n) => document.querySelectorAll(".series li").length >= n, k + 1);
  }
  await page.locator(".plot .u-over").waitFor();
  return page;
}
/** Ends of the horizontal axis, as the plot is drawn in SVG now. */
const range = async (page) => {
  const ticks = [...(await saved(page, "SVG")).matchAll(/y="292\.0" text-anchor="middle">([^<]*)</g)].map((m) => Number(m[1]));
  return [ticks[0], ticks.at(-1)];
};
const within = (value, wanted, by, what) => expect(Math.abs(value - wanted) < by, `${what} is ${value}, not ${wanted}`);

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
    const text = await saved(page, button);
    expect(text.startsWith(head), `${button} begins with ${text.slice(0, 40)}`);
    if (button === "CSV") expect(text.trim().split("\n").length === 102, "not a row for each frame");
  }
  await page.getByLabel("Channel to plot").fill("bodies.nobody.position");
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await page.getByText("There is no channel 'bodies.nobody.position'.").waitFor();
  await shot(page, "plots");
});

await test("a drag zooms a plot; two clicks, or a button, show all of it again", async () => {
  const page = await plotted("all.html", "bodies.arm.position.z");
  const box = await page.locator(".plot .u-over").boundingBox(), at = (part) => [box.x + part * box.width, box.y + box.height / 2];
  /** The line of the present time, as a part of the plot's width; null while it is hidden. */
  const line = () => page.locator(".plot .now").evaluate((e) => { const over = e.parentElement.getBoundingClientRect(), { left, width } = e.getBoundingClientRect(); return e.hidden ? null : (left + width / 2 - over.left) / over.width; });
  const all = async () => { const [a, b] = await range(page); within(a, 0, 0.01, "the start of all"); within(b, 1, 0.01, "the end of all"); };
  const zoom = async () => {
    await page.mouse.move(...at(0.25));
    await page.mouse.down();
    await page.mouse.move(...at(0.4));
    await page.mouse.move(...at(0.5));
    await page.mouse.up();
    const [a, b] = await range(page);
    within(a, 0.25, 0.01, "the start of the part");
    within(b, 0.5, 0.01, "the end of the part");
  };
  await all();
  const t = await clock(page);
  within(await line(), t, 0.01, "the line before anything moves");
  await zoom();
  expect(await line() === null, "the line of a time that is not in the plot is shown");
  expect(await clock(page) === t, "a drag moves the time");
  // The time of a click is that of the visible range, and the curve is drawn over it.
  await page.mouse.click(...at(0.6));
  within(await clock(page), 0.4, 0.01, "the time");
  within(await line(), 0.6, 0.02, "the line in a part");
  await page.mouse.dblclick(...at(0.5));
  await all();
  within(await line(), await clock(page), 0.01, "the line in the whole range");
  await zoom();
  await page.getByRole("button", { name: "Whole range" }).click();
  await all();
});

await test("an angular velocity along the axes of its body, and its size, are those of the tables", async () => {
  const page = await plotted("tumble.html", "bodies.block.angular_velocity_body", "bodies.block.angular_velocity_body.size");
  await page.waitForFunction(() => document.querySelectorAll(".series li").length === 4);
  const rows = table(await saved(page, "CSV")), own = channels("tumble", "bodies.block.angular_velocity_body", "bodies.block.angular_velocity_body.size"), world = channels("tumble", "bodies.block.angular_velocity");
  expect(rows.length === own.length && own[0].length === 5, `${rows.length} rows of ${own[0].length} numbers`);
  rows.forEach((row, k) => own[k].forEach((value, i) => within(row[i], value, 1e-5, `row ${k}, column ${i}`)));
  expect(own.some((row, k) => Math.abs(row[1] - world[k][1]) > 3), "both axes give the same, so that the test says little");
});

await test("the ledger stacks the energies, and its upper edge is constant as energy is conserved", async () => {
  const page = await plotted("swing.html", "energy.kinetic");
  await page.getByRole("button", { name: "Close this plot" }).click();
  await page.getByRole("button", { name: "Ledger" }).click();
  await page.locator(".plot .u-over").waitFor();
  const rows = table(await saved(page, "CSV")), own = channels("swing", "energy.kinetic", "energy.potential", "energy.dissipated"), low = Math.min(0, ...own.map((row) => row[2]));
  expect(rows.length === own.length && low < 0, `${rows.length} rows, lowest potential energy ${low}`);
  const scale = Math.max(...own.map((row) => row[1] + row[2] - low));
  rows.forEach((row, k) => {
    const [, kinetic, potential, dissipated] = own[k];
    [kinetic, kinetic + potential - low, kinetic + potential - low + dissipated].forEach((sum, i) => within(row[i + 1], sum, 1e-5 * scale, `row ${k}, layer ${i}`));
    within(row[3], rows[0][3], 1e-5 * scale, `the upper edge of row ${k}`);  // no energy is supplied, so only losses change the sum
  });
  expect(own.at(-1)[3] > 1e-3 * scale, "nothing is lost, so that the test says little");
  // Layers are filled; as curves over time the same numbers leave the area empty.
  const inked = () => page.evaluate(() => {
    const canvas = document.querySelector(".plot canvas"), { width, height } = canvas, context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    let count = 0;
    for (let i = 3; i < data.length; i += 4) count += data[i] > 0 ? 1 : 0;
    return count / (data.length / 4);
  });
  await page.waitForTimeout(100);
  const filled = await inked();
  await shot(page, "ledger");
  await page.getByLabel("Kind of plot").selectOption("time");
  await page.waitForTimeout(100);
  expect(filled > 0.3 && await inked() < 0.7 * filled, `${filled} of the field is filled, ${await inked()} without layers`);
});

await test("a phase plot of an oscillator is an ellipse", async () => {
  const page = await plotted("tone.html", "bodies.bob.position.x", "bodies.bob.velocity.x");
  await page.getByLabel("Kind of plot").selectOption("phase");
  const text = await saved(page, "CSV"), rows = table(text);
  expect(text.startsWith("bodies.bob.position.x [m],bodies.bob.velocity.x [m/s]\n"), text.slice(0, 80));
  // Over 40 periods of 100 steps the amplitude is constant; the method shifts the phase and conserves energy.
  for (const [x, v] of rows) within(((x - 1) / 0.1) ** 2 + (v / (0.1 * 10 * Math.PI)) ** 2, 1, 1e-3, "the radius");
  expect(rows.some(([x]) => x < 0.905) && rows.some(([, v]) => v > 3), "only a part of the ellipse");
  await shot(page, "phase");
});

await test("other units multiply the numbers and name themselves", async () => {
  const page = await plotted("tone.html", "bodies.bob.position.x");
  const metres = table(await saved(page, "CSV"));
  await page.getByRole("button", { name: "Other units" }).click();
  const text = await saved(page, "CSV"), other = table(text);
  expect(text.startsWith("t [s],bodies.bob.position.x [mm]") && (await page.locator(".series").textContent()).includes("[mm]"), text.slice(0, 60));
  other.forEach((row, k) => within(row[1], 1000 * metres[k][1], 1e-9, `row ${k}`));
});

await test("a spectrum peaks where it should", async () => {
  const page = await plotted("tone.html", "bodies.bob.position.x");
  await page.getByLabel("Kind of plot").selectOption("spectrum");
  const [frequency, amplitude] = table(await saved(page, "CSV")).reduce((a, b) => (b[1] > a[1] ? b : a));
  expect(Math.abs(frequency - 5) < 0.13 && Math.abs(amplitude - 0.1) < 0.02, `the peak is ${amplitude} m at ${frequency} Hz`);
});
