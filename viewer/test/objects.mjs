// SPDX-License-Identifier: Apache-2.0
// Search, selection, values, hiding and measuring of objects.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { channels, chosen, expect, folder, model, page_of, picture, recorded, run, shot, test } from "./support.mjs";

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
  const row = channels("all", "bodies.arm.position")[30];
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
      found = await chosen(page);
    }
  expect(found !== "", "no click meets anything");
  await page.keyboard.press("Escape");
  expect(await page.locator(".details h2").count() === 0, "Escape keeps the choice");
});

await test("hidden, ghost and isolated bodies change the picture", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("button", { name: /^arm/ }).first().click();
  const pictures = [await picture(page)];
  for (const key of ["h", "a", "g", "i"]) { await page.keyboard.press(key); pictures.push(await picture(page)); }
  expect(pictures[0] !== pictures[1] && pictures[1] !== pictures[3] && pictures[0] === pictures[2] && pictures[3] !== pictures[4], "pictures do not differ as they should");
});

await test("two clicks measure a distance, three an angle", async () => {
  // Points on two sides of a cube of 1 m, in parallel projection from its front, at a known distance.
  recorded("cube", "format: 1\nbodies: {cube: {fixed: true, shape: {box: [1, 1, 1]}}, far: {shape: {box: [1, 1, 1]}, density: 1, position: [3, 0, 0]}}\nanalysis: {duration: 0.1 s, step: 0.1 s}\n");
  const { page } = await page_of("cube.html");
  await page.keyboard.press("1");
  await page.keyboard.press("o");
  const { x, y, width, height } = await page.locator(".view > canvas").boundingBox(), ruler = page.locator(".measure");
  // Edges of both cubes in the picture: the first and last click along a row that hits an object.
  await page.waitForTimeout(300);
  const name = async (u, v) => { await page.mouse.click(u, v); return chosen(page); };
  const edge = async (from, to, wanted) => {  // bisection between a point within and one outside
    for (let k = 0; k < 9; k++) { const m = (from + to) / 2; if (await name(m, y + height / 2) === wanted) from = m; else to = m; }
    return from;
  };
  let middle = 0;
  for (let i = 1; i < 40 && !middle; i++) if (await name(x + width * i / 40, y + height / 2) === "cube") middle = x + width * i / 40;
  const left = await edge(middle, x, "cube"), right = await edge(middle, x + width, "cube"), scale = right - left;  // pixels in a metre
  expect(scale > 20, `the cube is ${scale} pixels wide`);
  await page.keyboard.press("Escape");
  await page.keyboard.press("m");
  expect(await ruler.isVisible() && (await ruler.textContent()).includes("Click two points"), "no ruler");
  const at = (a, b) => page.mouse.click((left + right) / 2 + a * scale, y + height / 2 - b * scale);
  await at(-0.3, 0);
  await at(0.3, 0);
  const distance = parseFloat(await ruler.textContent());
  expect(Math.abs(distance - 0.6) < 0.03 && / m$/.test(await ruler.textContent()), `0.6 m reads '${await ruler.textContent()}'`);
  await at(0.3, 0.3);
  const angle = (await ruler.textContent()).match(/, ([\d.]+)°/);
  expect(angle && Math.abs(Number(angle[1]) - 90) < 3, `a right angle reads '${await ruler.textContent()}'`);
});

await test("measuring snaps to corners, centres, joints and nodes, which move with their objects", async () => {
  recorded("snap", "format: 1\nbodies: {cube: {fixed: true, shape: {box: [1, 1, 1]}}, far: {shape: {box: [1, 1, 1]}, density: 1, position: [3, 0, 0], velocity: [0, 0, -1]}}\njoints: {rail: {type: prismatic, bodies: [ground, far], at: [1.5, 0, 0], axis: z}}\nanalysis: {duration: 0.1 s, step: 0.1 s}\n");
  const { page } = await page_of("snap.html"), { x, y, width, height } = await page.locator(".view > canvas").boundingBox(), ruler = page.locator(".measure");
  await page.keyboard.press("1");
  await page.keyboard.press("o");
  // The scene is 4.04 m from corner to corner at most; its middle is that of the picture. A metre has as many pixels as one between the cubes' outer edges.
  const name = async (u, v) => { await page.keyboard.press("Escape"); await page.mouse.click(u, v); return chosen(page); };
  const edge = async (from, to, wanted) => { for (let k = 0; k < 9; k++) { const m = (from + to) / 2; if (await name(m, y + height / 2) === wanted) from = m; else to = m; } return from; };
  let inside = 0;
  for (let i = 1; i < 40 && !inside; i++) if (await name(x + width * i / 40, y + height / 2) === "cube") inside = x + width * i / 40;
  const left = await edge(inside, x, "cube"), right = await edge(inside, x + width / 2, "cube"), scale = right - left, middle = (left + right) / 2;
  const bottom = await (async () => { let [from, to] = [y + height / 2, y + height]; for (let k = 0; k < 9; k++) { const m = (from + to) / 2; if (await name(middle, m) === "cube") from = m; else to = m; } return from; })();
  await page.keyboard.press("Escape");
  await page.keyboard.press("m");
  const reads = async (wanted) => { const text = await ruler.textContent(); expect(wanted.test(text), `the ruler reads '${text}'`); };
  // A few pixels within the corner, and without it.
  await page.mouse.click(left + 5, bottom - 4);
  await page.mouse.click(right + 5, bottom + 4);
  await reads(/^1\.000 m \(corner of cube – corner of cube\)$/);
  await page.keyboard.press("m");
  await page.keyboard.press("m");
  await page.mouse.click(left + 5, bottom - 4);
  await page.mouse.click(middle + 3 * scale - 5, bottom - scale / 2 + 3);
  await reads(/^3\.571 m \(corner of cube – centre of mass of far\)$/);
  await shot(page, "snap");
  // The mark moves along: 0.1 m down in the whole time. The corner is the one in front, at -0.5, -0.5, -0.5.
  await page.keyboard.press("End");
  await page.waitForTimeout(200);
  const moved = parseFloat(await ruler.textContent());
  expect(Math.abs(moved - Math.hypot(3.5, 0.5, 0.4)) < 1e-3, `the distance becomes ${moved} m`);
  await page.keyboard.press("Home");
  await page.keyboard.press("m");
  await page.keyboard.press("m");
  await page.mouse.click(middle + 1.5 * scale + 5, bottom - scale / 2 - 5);
  await page.mouse.click(right - 3, bottom - 4);
  await reads(/\(rail – corner of cube\)$/);
  const solid = await page_of("tyre.html");
  await solid.page.keyboard.press("m");
  const box = await solid.page.locator(".view > canvas").boundingBox();
  for (let i = 2; i < 19 && !(await solid.page.locator(".measure").textContent()).includes("a node of"); i++)
    for (let j = 2; j < 19 && !(await solid.page.locator(".measure").textContent()).includes("a node of"); j += 2) await solid.page.mouse.click(box.x + box.width * i / 20, box.y + box.height * j / 20);
  await solid.page.locator(".measure", { hasText: "a node of" }).waitFor({ timeout: 2000 });
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
