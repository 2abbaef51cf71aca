// SPDX-License-Identifier: Apache-2.0
// Display options: fields of solids, axes, trails, sections, forces.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { build } from "esbuild";
import { channels, chosen, expect, folder, page_of, picture, recorded, root, run, shot, slide, test } from "./support.mjs";

await test("solids have colours, a legend and a choice of fields", async () => {
  const { page } = await page_of("tyre.html");
  expect(/von mises \[[kM]Pa\]/.test(await page.locator(".legend").textContent()), `the legend reads '${await page.locator(".legend").textContent()}'`);
  const before = await page.evaluate(() => document.querySelector(".view > canvas").toDataURL());
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Field in colours").selectOption({ label: "displacement (size)" });
  await page.waitForTimeout(300);
  expect((await page.locator(".legend").textContent()).includes("displacement (size) ["), "the legend stays");
  await page.keyboard.press("End");
  await page.waitForTimeout(300);
  expect(before !== await page.evaluate(() => document.querySelector(".view > canvas").toDataURL()), "the picture stays");
  await page.getByLabel("Section plane").selectOption("y");
  await page.waitForTimeout(200);
  await shot(page, "tyre");
});

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
  await page.waitForFunction(() => document.querySelector(".legend").textContent.includes("von mises by element ["));
  const flat = await picture(page);
  await page.getByLabel("Field in colours").selectOption({ label: "von mises" });
  await page.waitForTimeout(300);
  expect(await picture(page) !== flat, "elements and nodes have one picture");
});

await test("the helical axis of a body is the axis of its hinge, of a screw with its pitch, relative to the ground and to a body", async () => {
  const screwed = `format: 1
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
`;
  const axis_of = async (page) => {
    const text = await page.locator(".helical").textContent(), number = "-?[\\d.]+(?:e[+-]?\\d+)?";
    const found = text.match(new RegExp(`^(${number}) rad/s about (.*) through (.*) m; pitch (${number}) m/rad`));
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
  recorded("screw", screwed);
  const other = await page_of("screw.html");
  await other.page.getByRole("tab", { name: "Display" }).click();
  await other.page.getByLabel("Time", { exact: true }).fill("25");
  await other.page.getByLabel("Body of the helical axis").selectOption("nut");
  await other.page.getByLabel("Helical axis relative to").selectOption("table");
  await other.page.waitForFunction(() => document.querySelector(".helical").textContent.includes("rad/s"));
  // The table has turned by 0.5 rad: the screw's axis is its x, through its middle; its pitch per radian is the lead over one turn.
  const screw = await axis_of(other.page), t = 0.5;
  expect(near(screw.rate, 2, 1e-3) && near(Math.abs(screw.along[0]), Math.cos(t), 2e-3) && near(Math.abs(screw.along[1]), Math.sin(t), 2e-3), JSON.stringify(screw));
  expect(near(Math.abs(screw.pitch), 0.3 / (2 * Math.PI), 1e-4) && near(screw.point[1] * Math.cos(t) - screw.point[0] * Math.sin(t), 0, 2e-3) && near(screw.point[2], 0, 2e-3), JSON.stringify(screw));
  await other.page.getByLabel("Helical axis relative to").selectOption("ground");
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
  for (const label of ["Trails", "Centres of mass", "Body axes", "Parallel projection (o)", "Reactions of joints", "Ground grid", "World axes", "Edges and outlines", "Springs and motors", "Bodies as ghosts"]) {
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
  // The followed arm stays at its position in the picture while everything else moves: its centre projects to one point.
  await page.keyboard.press("f");
  const eye = async () => { await page.keyboard.press("b"); return page.evaluate(() => location.hash.match(/at=([^&]*)/)[1].split(",").map(Number)); };
  const first = await eye();
  await page.getByLabel("Time", { exact: true }).fill("80");
  const moved = await eye();
  const rows = channels("all", "bodies.arm.position");
  for (let k = 0; k < 3; k++) expect(Math.abs(moved[k] - first[k] - rows[80][k + 1] + rows[40][k + 1]) < 1e-3, `the camera goes from ${first} to ${moved}`);
});

await test("bodies throw shadows of parallel light on the ground, and none when shadows are off", async () => {
  recorded("plate", `format: 1
bodies:
  floor: {fixed: true, shape: {plane: z}}
  plate: {shape: {box: [1, 1, 0.02]}, density: 1000, position: [-2, 0, 2], velocity: [0, 0, 1]}
  ball: {shape: {sphere: 0.5}, density: 1000, position: [2, 0, 2], velocity: [0, 0, 1]}
analysis: {duration: 1 s, step: 0.1 s}
output: {every: 1 s}
`);
  const distance = 20, { page } = await page_of(`plate.html#eye=0,-0.02,${distance}&at=0,0,0`);
  await page.getByRole("tab", { name: "Display" }).click();
  for (const label of ["Ground grid", "World axes", "Joints", "Edges and outlines"]) await page.getByLabel(label, { exact: true }).click();
  const shadows = page.getByLabel("Shadows", { exact: true });
  expect(!await shadows.isChecked(), "without a graphics processor there are shadows that nobody wanted");
  /** Seen from above: area and centre, in metres on the ground, of what is not as bright as the empty ground, left and right of the middle. */
  const dark = async (except) => page.evaluate(async ([url, except, distance]) => {
    const read = async (url) => {
      const drawn = Object.assign(new Image(), { src: url });
      await drawn.decode();
      const flat = new OffscreenCanvas(drawn.width, drawn.height), context = flat.getContext("2d");
      context.drawImage(drawn, 0, 0);
      return context.getImageData(0, 0, flat.width, flat.height);
    };
    const { data, width, height } = await read(url), behind = except && await read(except), scale = height / 2 / (distance * Math.tan(17.5 * Math.PI / 180)), ground = 4 * ((height >> 1) * width + (width >> 1));
    const differs = ({ data }, i) => [0, 1, 2].some((k) => Math.abs(data[i + k] - data[ground + k]) > 6), found = [0, 1].map(() => ({ area: 0, x: 0, y: 0, light: 0 }));
    for (let y = 0; y < height; y++)
      for (let x = 0, i = 4 * y * width; x < width; x++, i += 4) {
        if (Math.max(Math.abs(x - width / 2), Math.abs(y - height / 2)) > 4 * scale || !differs({ data }, i) || (behind && differs(behind, i))) continue;
        const side = found[x > width / 2 ? 1 : 0];
        side.area += 1;
        side.x += x + 0.5 - width / 2;
        side.y += height / 2 - y - 0.5;
        side.light += (data[i] + data[i + 1] + data[i + 2]) / (data[ground] + data[ground + 1] + data[ground + 2]);
      }
    return found.map(({ area, x, y, light }) => ({ area: area / scale ** 2, x: x / area / scale, y: y / area / scale, light: light / area }));
  }, [await picture(page), except, distance]);
  const seen = {};
  for (const [time, height] of [["Home", 2], ["End", 3]]) {
    await page.keyboard.press(time);
    const off = await picture(page), bodies = await dark(null);
    // The bodies alone, nearer to the camera than the ground: of the size by perspective.
    expect(Math.abs(bodies[0].area - (distance / (distance - height - 0.01)) ** 2) < 0.05, `without shadows there is ${JSON.stringify(bodies)}`);
    await shadows.click();
    seen[height] = await dark(off);
    await shot(page, `shadows_${time}`);
    await shadows.click();
    expect(await picture(page) === off, "shadows do not go");
  }
  for (const height of [2, 3]) {
    const [plate, ball] = seen[height];
    // Shadows by parallel light on a horizontal ground: that of a horizontal plate has its size, that of a ball is longer by the slope of the light.
    const dx = (plate.x + 2) / height, dy = plate.y / height, slant = Math.hypot(1, dx, dy);
    expect(Math.abs(plate.area - 1) < 0.04 && Math.abs(ball.area - Math.PI * 0.25 ** 2 * slant) < 0.02, `${height}: ${JSON.stringify(seen[height])}`);
    expect(Math.hypot(dx, dy) > 0.3 && Math.abs((ball.x - 2) / height - dx) < 0.02 && Math.abs(ball.y / height - dy) < 0.02, `${height}: ${JSON.stringify(seen[height])}`);
    expect(plate.light < 0.96 && ball.light < 0.96, `${height}: ${JSON.stringify(seen[height])}`);
  }
  for (const k of [0, 1]) for (const axis of ["x", "y"]) {  // its distance from the foot of the object is the object's height
    const foot = axis === "y" ? 0 : k ? 2 : -2;
    expect(Math.abs((seen[3][k][axis] - foot) / (seen[2][k][axis] - foot) - 1.5) < 0.04, JSON.stringify(seen));
  }
});

await test("forces are scaled and filtered", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("tab", { name: "Display" }).click();
  await page.getByLabel("Time", { exact: true }).fill("60");
  const plain = await picture(page);
  await slide(page, "Length of arrows", 2.5);
  const long = await picture(page);
  await slide(page, "Smallest shown, relative to the largest", 0.5);
  expect(plain !== long && await picture(page) !== long, "arrows stay as they are");
});

await test("every kind of joint has a shape of its own, and links a rod between their points", async () => {
  const { outputFiles: [{ text }] } = await build({ entryPoints: [join(root, "viewer/src/joint_shapes.ts")], bundle: true, write: false, format: "esm", logLevel: "error" });
  writeFileSync(join(folder, "joint_shapes.mjs"), text);
  const { jointShape } = await import(pathToFileURL(join(folder, "joint_shapes.mjs"))), kinds = JSON.parse(run("info", "--kinds", "joints", "--json")).map(({ name }) => name);
  const seen = new Map();
  for (const kind of kinds) {
    const key = jointShape(kind).getAttribute("position").array.join();
    expect(!seen.has(key), `'${kind}' looks like '${seen.get(key)}'`);
    seen.set(key, kind);
  }
  expect(kinds.length > 14 && kinds.filter((kind) => jointShape(kind).type === "OctahedronGeometry").join() === "generic", `kinds without a shape: ${kinds.filter((kind) => jointShape(kind).type === "OctahedronGeometry")}`);
  recorded("rod", "format: 1\nbodies: {bob: {point_mass: true, mass: 1, shape: {sphere: 0.05}, position: [1, 0, 0]}}\njoints: {link: {type: distance, bodies: [ground, bob], at: [[0, 0, 0], [1, 0, 0]]}}\nanalysis: {duration: 0.1 s, step: 0.1 s}\n");
  const { page } = await page_of("rod.html");
  await page.keyboard.press("1");
  await page.waitForTimeout(200);
  // The middle of the picture is between both points: only the rod is there.
  const { x, y, width, height } = await page.locator(".view > canvas").boundingBox();
  let name = "";
  for (let k = -10; k <= 10 && !name; k++) {
    await page.mouse.click(x + width / 2, y + height / 2 + k);
    name = await chosen(page);
  }
  expect(name === "link", `between the points there is '${name}'`);
});

await test("joints, arrows, beams, cables and springs are drawn, and met by their names", async () => {
  const { page } = await page_of("all.html");
  await page.getByLabel("Time", { exact: true }).fill("40");
  await page.getByRole("tab", { name: "Display" }).click();
  for (const label of ["Joints", "Contact forces", "Applied and spring forces"]) {
    const before = await picture(page);
    await page.getByLabel(label, { exact: true }).click();
    expect(await picture(page) !== before, `${label} changes nothing`);
    await page.getByLabel(label, { exact: true }).click();
    expect(await picture(page) === before, `${label} does not go back`);
  }
  await page.getByRole("tab", { name: "Objects" }).click();
  for (const [name, about] of [["hinge", "revolute joint"], ["spring", "spring damper"], ["mast", "beam, section rod"], ["stay", "cable"], ["floor+ball", "contact"]]) {
    await page.getByRole("button", { name: new RegExp(`^${name.replace("+", "\\+")} `) }).first().click();
    await page.waitForFunction((name) => document.querySelector(".details h2")?.textContent === name, name);
    expect((await page.locator(".details").textContent()).includes(about), `${name} is no ${about}: ${await page.locator(".details").textContent()}`);
    await page.locator(".details td.number").first().waitFor();
  }
});
