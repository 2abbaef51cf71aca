// SPDX-License-Identifier: Apache-2.0
// Opening and playback of the page: time, bookmark, phone, dark theme, accessibility.
import { clock, colours, expect, model, page_of, picture, recorded, run, shot, test, violations } from "./support.mjs";

await test("the saved file opens without network and shows a picture", async () => {
  const { page } = await page_of("all.html");
  expect(!(await page.evaluate(() => document.documentElement.dataset.failed)), await page.locator("#app").textContent());
  expect(await colours(page) > 40, "the picture is empty");
  expect((await page.locator(".drift").textContent()).includes("energy drift"), "no energy drift in view");
  await shot(page, "all");
});

// A stiff oscillator that numerical dissipation damps at a coarse step, not at a hundredth of it.
const stiff = (step) => `format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [1.1, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1.1, 0, 0]], stiffness: 1000, free_length: 1}}
analysis: {duration: 0.2 s, step: ${step}, rho_inf: 0}
`;

await test("the energy drift is that of the summary, in red above a thousandth", async () => {
  const colour = {};
  for (const [name, step] of [["coarse", "20 ms"], ["fine", "0.2 ms"]]) {
    recorded(name, stiff(step));
    const { energy_drift } = JSON.parse(run("run", `${name}.yaml`, "--json", "--quiet", "-o", "again"));
    const { page } = await page_of(`${name}.html`);
    const drift = page.locator(".drift"), text = await drift.textContent();
    expect(text.includes(`(${energy_drift.toExponential(1)} at the end)`), `the page says '${text}', the summary ${energy_drift}`);
    expect(energy_drift > 1e-3 === (name === "coarse"), `the drift is ${energy_drift}`);
    expect(await drift.evaluate((e) => e.classList.contains("bad")) === energy_drift > 1e-3, `${name}: the wrong colour`);
    colour[name] = await drift.evaluate((e) => getComputedStyle(e).color);
  }
  const [red, green, blue] = colour.coarse.match(/\d+/g).map(Number);
  expect(red > green + 100 && red > blue + 100 && colour.fine !== colour.coarse, `the colours are ${JSON.stringify(colour)}`);
});

await test("it plays when it is opened, unless a link names a time or less motion is wanted", async () => {
  const moving = { reducedMotion: "no-preference" }, { page } = await page_of("all.html", moving);
  await page.getByRole("button", { name: "Pause", exact: true }).waitFor();
  await page.waitForFunction(() => parseFloat(document.querySelector("output.clock").textContent) > 0.02);
  for (const [name, options, t] of [["all.html", {}, 0], ["all.html#t=0.4", moving, 0.4]]) {
    const { page } = await page_of(name, options);
    await page.waitForTimeout(300);
    expect(await clock(page) === t && await page.getByRole("button", { name: "Play", exact: true }).isVisible(), `${name} stands at ${await clock(page)}`);
  }
});

await test("space plays after a click on any control; a control reached with the keyboard takes it for itself", async () => {
  const { page } = await page_of("all.html"), playing = () => page.getByRole("button", { name: "Pause", exact: true }).isVisible();
  await page.getByRole("tab", { name: "Display" }).click();
  for (const control of [page.getByRole("button", { name: "Loop" }), page.getByLabel("Trails"), page.getByLabel("Time", { exact: true }), page.getByRole("button", { name: "Top" })]) {
    await control.click();
    const state = (await control.getAttribute("aria-pressed")) ?? (await control.evaluate((e) => e.checked));
    for (const wanted of [true, false]) {
      await page.keyboard.press(" ");
      expect(await playing() === wanted, `after ${control} space does not ${wanted ? "play" : "pause"}`);
    }
    expect(((await control.getAttribute("aria-pressed")) ?? (await control.evaluate((e) => e.checked))) === state, `space presses ${control}, too`);
  }
  const trails = page.getByLabel("Trails");
  await page.keyboard.press("Tab");
  await trails.focus();
  await page.keyboard.press(" ");
  expect(!await trails.isChecked() && !await playing(), "the keyboard cannot switch trails off");
});

await test("a long title can be read, on a phone as well", async () => {
  recorded("titled", model.replace("title: Everything", "title: A slider-crank on a bench, driven by a motor"));
  for (const options of [{}, { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true }]) {
    const { page } = await page_of("titled.html", options), title = page.getByRole("heading", { level: 1 });
    expect(await title.evaluate((e) => e.scrollWidth <= e.clientWidth && e.scrollHeight <= e.clientHeight + 1 && e.clientWidth > 150), "the title is cut");
    const { x, width, height } = await title.boundingBox();
    expect(x >= 0 && x + width <= page.viewportSize().width && height < 60, `the title is at ${x}, ${width} wide and ${height} high`);
    if (options.isMobile) await shot(page, "phone_title");
  }
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

await test("speed and loop do what they say", async () => {
  const { page } = await page_of("all.html");
  await page.getByLabel("Speed").selectOption("10×");
  await page.getByRole("button", { name: "Loop" }).click();
  await page.keyboard.press("End");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.getByRole("button", { name: "Play", exact: true }).waitFor({ timeout: 20000 });
  expect(await clock(page) === 1, `without a loop it stops at ${await clock(page)}`);
});

await test("a link keeps camera, time and choice", async () => {
  const { page } = await page_of("all.html");
  await page.getByRole("button", { name: /^arm/ }).first().click();
  await page.getByLabel("Time", { exact: true }).fill("25");
  const link = async (page) => { await page.keyboard.press("b"); return page.evaluate(() => location.hash); };
  const first = await link(page);
  await page.keyboard.press("2");
  const hash = await link(page), again = await page_of("all.html" + hash);
  expect(first !== hash, "the camera is not in the address");
  expect(await link(again.page) === hash && await picture(again.page) === await picture(page), `another camera: ${await link(again.page)} is not ${hash}`);
  expect(Math.abs(await clock(again.page) - 0.25) < 1e-6, "another time");
  expect(await again.page.locator(".details h2").textContent() === "arm", "another choice");
});

for (const [name, options] of [["wide and light", {}], ["dark", { colorScheme: "dark" }], ["on a phone", { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true }]])
  await test(`nothing stands in the way of anyone, ${name}`, async () => {
    const { page } = await page_of("all.html", options);
    expect(await colours(page) > 30, "the picture is empty");
    if (options.isMobile) await page.getByRole("button", { name: "Panel" }).click();
    for (const tab of ["Plot", "Display", "Extremes", "Objects"]) {
      await page.getByRole("tab", { name: tab }).click();
      if (tab === "Plot") for (let k = 0; k < 2; k++) await page.getByRole("button", { name: "Ledger" }).click();  // two of the same
      if (tab === "Extremes") await page.locator("table.extremes").nth(2).waitFor();
      const found = await violations(page);
      expect(found.length === 0, found.join(" | "));
    }
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the window");
    // The energy drift is visible with any panel.
    const drift = await page.locator(".drift").boundingBox(), { width, height } = page.viewportSize();
    expect(drift && drift.x >= 0 && drift.y >= 0 && drift.x + drift.width <= width && drift.y + drift.height <= height, `the drift stands at ${JSON.stringify(drift)}`);
    if (options.colorScheme) expect(await page.evaluate(() => getComputedStyle(document.body).backgroundColor) === "rgb(20, 25, 31)", "not dark");
    await shot(page, name.replaceAll(" ", "_"));
  });

await test("the picture follows the size of the window", async () => {
  const { page } = await page_of("all.html");
  await page.setViewportSize({ width: 1100, height: 500 });
  await page.waitForFunction(() => document.querySelector(".view > canvas").clientWidth === 770);
  expect(await colours(page) > 30, "the picture is empty");
});

await test("every key of the list does what the list says", async () => {
  const { page } = await page_of("compared.html");
  await page.keyboard.press("?");
  const listed = (await page.locator("dialog kbd").allTextContents()).join(" ").split(/\s+/);
  await page.keyboard.press("Escape");
  expect(!await page.locator("dialog").isVisible(), "the list stays");
  const done = new Set(["?", "Esc"]), press = async (key, name = key) => { done.add(name); await page.keyboard.press(key); };
  const speed = () => page.getByLabel("Speed").inputValue().then(Number), near = async (t) => expect(Math.abs(await clock(page) - t) < 1e-6, `time is ${await clock(page)}, not ${t}`);
  await press("End"); await near(1);
  await press("ArrowLeft", "←"); await near(0.99);
  await press("ArrowRight", "→"); await near(1);
  await press("Home"); await near(0);
  const usual = await speed();
  await press("+"); expect(await speed() > usual, "not faster");
  await press("-", "−"); expect(await speed() === usual, "not slower");
  await press("d"); expect(await page.evaluate(() => document.documentElement.dataset.theme) === "dark", "not dark");
  await press("d");
  await press("p"); await page.locator(".plot .u-over").waitFor();
  await press("p"); expect(!await page.locator(".plot").isVisible(), "the plot stays");
  await press("m"); expect(await page.locator(".measure").isVisible(), "no ruler");
  await press("m");
  await press("b"); expect((await page.evaluate(() => location.hash)).includes("eye="), "no address");
  await press("/"); expect(await page.evaluate(() => document.activeElement.type) === "search", "no search");
  await page.keyboard.type("arm");
  await page.getByRole("button", { name: /^arm/ }).first().click();
  const pressed = async (...keys) => {  // each key must change the picture
    for (const key of keys) { const before = await picture(page); await press(key); expect(await picture(page) !== before, `${key} changes nothing`); }
  };
  await page.getByLabel("Time", { exact: true }).fill("40");
  await pressed("1", "2", "3", "4");
  await pressed("o"); await page.keyboard.press("o");
  await pressed("h", "a", "g", "i", "a", "t", "c", "v");
  await page.keyboard.press("v");
  await page.keyboard.press("0");
  await pressed("z");
  await page.keyboard.press("0");
  await press("f"); await page.locator(".details").getByRole("button", { name: "Follow" }).waitFor();
  const still = await picture(page);
  await page.keyboard.press("End");
  expect(await picture(page) !== still, "nothing moves");
  await press("f");
  await press("0");
  await page.locator(".view > canvas").focus();
  await press(" ", "Space");
  await page.getByRole("button", { name: "Pause", exact: true }).waitFor();
  const forgotten = listed.filter((key) => !done.has(key));
  expect(forgotten.length === 0, `not tried: ${forgotten}`);
});
