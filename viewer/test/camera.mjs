// SPDX-License-Identifier: Apache-2.0
// The camera: zoom to the cursor, to the selected object, and along with it; boxes of inertia do not count for it.
import { channels, chosen, expect, page_of, picture, recorded, shot, test } from "./support.mjs";

/** Place and target of the camera. */
const camera = async (page) => {
  await page.keyboard.press("b");
  return page.evaluate(() => ["eye", "at"].map((key) => location.hash.match(new RegExp(`${key}=([^&]*)`))[1].split(",").map(Number)));
};
const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));
/** Name of the object at a part of the picture. */
const at = async (page, x, y) => {
  const box = await page.locator(".view > canvas").boundingBox();
  await page.keyboard.press("Escape");
  await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  return chosen(page);
};
/** A place of the picture in the middle of an object. */
async function find(page, name) {
  const mean = (list) => list.reduce((a, b) => a + b, 0) / list.length;
  for (let x = 0.03; x < 1; x += 0.03)
    for (let y = 0.04; y < 1; y += 0.04) {
      if (await at(page, x, y) !== name) continue;
      const met = [];
      for (let k = -5; k <= 5; k++) for (let i = 0; i <= 5; i++) if (await at(page, x + 0.012 * i, y + 0.02 * k) === name) met.push([x + 0.012 * i, y + 0.02 * k]);
      return [mean(met.map(([u]) => u)), mean(met.map(([, v]) => v))];
    }
  throw new Error(`no click meets '${name}'`);
}

await test("the wheel zooms to what is under the cursor", async () => {
  const { page } = await page_of("all.html"), [x, y] = await find(page, "ball"), [eye] = await camera(page);
  const box = await page.locator(".view > canvas").boundingBox();
  await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
  for (let k = 0; k < 8; k++) {
    await page.mouse.wheel(0, -120);
    await page.waitForTimeout(60);  // as a hand turns it
  }
  expect(await at(page, x, y) === "ball", `after zooming there is '${await at(page, x, y)}' under the cursor`);
  const [near] = await camera(page), ball = channels("all", "bodies.ball.position")[0].slice(1);
  expect(distance(near, ball) < 0.7 * distance(eye, ball), `the camera goes from ${eye} to ${near}`);
});

await test("the selected object, and all, fit into the picture", async () => {
  const { page } = await page_of("all.html"), all = await picture(page), far = await camera(page);
  await page.getByRole("button", { name: /^ball/ }).first().click();
  await page.locator(".details").getByRole("button", { name: "Fit" }).click();
  const ball = channels("all", "bodies.ball.position")[0].slice(1), [eye, target] = await camera(page);
  expect(distance(target, ball) < 1e-3 && distance(eye, ball) < 0.4 * distance(far[0], ball), `${eye} looks at ${target}`);
  await shot(page, "fit");
  for (const [x, y] of [[0.5, 0.5], [0.5, 0.36], [0.5, 0.64]]) expect(await at(page, x, y) === "ball", `at ${x}, ${y} there is '${await at(page, x, y)}'`);
  await page.keyboard.press("Escape");
  await page.keyboard.press("z");
  expect(await picture(page) === all, "all is shown from elsewhere");
});

await test("the camera goes along with a solid, and with a beam", async () => {
  const { page } = await page_of("tyre.html");
  await page.getByRole("button", { name: /solid, / }).first().click();
  await page.locator(".details").getByRole("button", { name: "Follow" }).click();
  const [, from] = await camera(page);
  await page.keyboard.press("End");
  const [, to] = await camera(page);
  expect(distance(from, to) > 0.01, `the camera stays at ${from} while the tyre rolls`);
  await page.getByRole("button", { name: "Do not follow" }).click();
  const all = await page_of("all.html");
  await all.page.getByRole("button", { name: /^mast beam/ }).first().click();
  await all.page.keyboard.press("f");
  const [, mast] = await camera(all.page);
  expect(distance(mast, [-1, 0, 0.5]) < 0.05, `a mast from -1, 0, 0 to -1, 0, 1 is followed at ${mast}`);
});

// Two links of 0.3 m: the inertia of one says nothing about its size, that of the other is a slender rod's.
await test("boxes of inertia are small and do not count for the camera, except links between their joints", async () => {
  recorded("links", `format: 1
bodies:
  lump: {mass: 1, inertia: [1, 1, 1], position: [0.15, 0, 0]}
  rod: {mass: 1, inertia: [0.0001, 0.0075, 0.0075], position: [0.45, 0, 0]}
joints:
  a: {type: revolute, bodies: [ground, lump], at: [0, 0, 0], axis: y}
  b: {type: revolute, bodies: [lump, rod], at: [0.3, 0, 0], axis: y}
  c: {type: revolute, bodies: [rod, ground], at: [0.6, 0, 0], axis: y}
analysis: {duration: 0.1 s, step: 0.01 s}
`);
  const { page } = await page_of("links.html"), [eye, target] = await camera(page);
  // The lump's box would be 4 m from corner to corner.
  expect(distance(eye, target) < 2 && Math.abs(target[0] - 0.3) < 0.05, `${eye} looks at ${target}`);
  await page.getByRole("button", { name: /^lump/ }).first().click();
  await page.keyboard.press("z");
  const [lump, middle] = await camera(page);
  expect(distance(middle, [0.15, 0, 0]) < 1e-3 && distance(lump, middle) < 0.6, `${lump} looks at ${middle}`);
  await page.getByRole("button", { name: /^rod/ }).first().click();
  await page.keyboard.press("z");
  const [rod, centre] = await camera(page);
  expect(distance(centre, [0.45, 0, 0]) < 1e-3 && distance(rod, centre) > 0.4, `${rod} looks at ${centre}`);
  await shot(page, "links");
  // Beside shapes boxes of inertia count not at all, not even their centres.
  recorded("beside", "format: 1\nbodies: {ball: {fixed: true, shape: {sphere: 0.1}}, lump: {mass: 1, inertia: [1, 1, 1], position: [5, 0, 0]}}\nanalysis: {duration: 0.1 s, step: 0.01 s}\n");
  const beside = await page_of("beside.html"), [near, ball] = await camera(beside.page);
  expect(distance(near, ball) < 1 && distance(ball, [0, 0, 0]) < 1e-3, `${near} looks at ${ball}`);
});
