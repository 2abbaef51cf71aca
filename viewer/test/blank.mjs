// SPDX-License-Identifier: Apache-2.0
// The page without a picture: in a browser without WebGL, and while its context is lost.
import { chmodSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { launch, program } from "./browser.mjs";
import { clock, colours, expect, folder, made, page_of, picture, refusal, saved, shot, slide, table, test, violations } from "./support.mjs";

const kOff = ["--disable-gpu", "--disable-3d-apis"], message = (page) => page.locator(".view > [role=alert]");

/** What needs no WebGL: time, values, plots and their files. */
async function rest(page) {
  await page.getByLabel("Time", { exact: true }).fill("50");
  expect(Math.abs(await clock(page) - 0.5) < 1e-6, `time is ${await clock(page)}`);
  await page.getByRole("button", { name: /^arm/ }).first().click();
  await page.locator(".details td.number").nth(2).waitFor();
  const value = await page.locator(".details td.number").first().textContent();
  await page.keyboard.press("End");
  expect(await clock(page) === 1, `End goes to ${await clock(page)}`);
  expect(await page.locator(".details td.number").first().textContent() !== value, "the values stand still");
  await page.keyboard.press("p");
  await page.locator(".plot .u-over").waitFor();
  expect(table(await saved(page, "CSV")).length === 101, "the table of the plot is not whole");
  await page.keyboard.press("Home");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.waitForFunction(() => parseFloat(document.querySelector("output.clock").textContent) > 0.02);
  await page.getByRole("button", { name: "Pause", exact: true }).click();
}

for (const [name, options] of [["wide and light", {}], ["dark", { colorScheme: "dark" }], ["on a phone", { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true }]])
  await test(`without WebGL a text says so, and all else works, ${name}`, async () => {
    const other = await launch(kOff);
    try {
      const { page, faults } = await page_of("all.html", options, other);
      expect(!(await page.evaluate(() => document.documentElement.dataset.failed)), await page.locator("#app").textContent());
      expect(await page.evaluate(() => document.createElement("canvas").getContext("webgl2")) === null, "the browser has WebGL");
      const text = await message(page).textContent();
      expect(text.includes("cannot draw in 3D: WebGL 2 is off or not available. Turn on hardware acceleration"), text);
      const [inner, outer] = [await message(page).boundingBox(), await page.locator(".view").boundingBox()];
      expect(inner && inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width && inner.y + inner.height <= outer.y + outer.height, `the text stands at ${JSON.stringify(inner)}`);
      expect(!await page.locator(".view > canvas").isVisible(), "an empty picture is shown");
      if (options.isMobile) await page.getByRole("button", { name: "Panel" }).click();
      else expect(await page.getByRole("button", { name: "Picture" }).isDisabled(), "an empty picture can be saved");
      for (const tab of ["Plot", "Display", "Objects"]) {
        await page.getByRole("tab", { name: tab }).click();
        const found = await violations(page);
        expect(found.length === 0, found.join(" | "));
      }
      await rest(page);
      // Settings of the picture are without effect, not faults.
      await page.getByRole("tab", { name: "Display" }).click();
      await page.getByLabel("Section plane").selectOption("x");
      await slide(page, "Position of the section", 0.1);
      for (const key of ["1", "o", "f", "h", "i", "a", "t", "m", "b", "d"]) await page.keyboard.press(key);
      await page.waitForTimeout(200);
      expect(!await page.locator(".measure").isVisible(), "the ruler is visible without a picture");
      expect(faults.length === 0, faults.join(" | "));
      await shot(page, `blank_${name.replaceAll(" ", "_")}`);
    } finally { await other.close(); }
  });

await test("a picture that is lost is replaced by a text, and returns", async () => {
  for (const name of ["all.html", "tyre.html"]) {
    const { page } = await page_of(name), lost = (on) => page.evaluate((lose) => {
      window.extension ??= document.querySelector(".view > canvas").getContext("webgl2").getExtension("WEBGL_lose_context");
      if (lose) window.extension.loseContext(); else window.extension.restoreContext();
    }, on);
    // Shadows and a section have objects of their own on the graphics processor.
    await page.getByRole("tab", { name: "Display" }).click();
    await page.getByLabel("Shadows").check();
    await page.getByLabel("Section plane").selectOption("y");
    await page.getByRole("tab", { name: "Objects" }).click();
    const legend = page.locator(".legend"), before = await picture(page), scale = await legend.isVisible();
    expect(await colours(page) > 30 && !await message(page).isVisible(), "there is no picture to lose");
    for (let k = 0; k < 2; k++) {
      await lost(true);
      await message(page).filter({ hasText: "stopped drawing in 3D" }).waitFor({ timeout: 10000 });
      expect(!await page.locator(".view > canvas").isVisible() && !await legend.isVisible(), "an empty picture is shown");
      expect(await page.getByRole("button", { name: "Picture" }).isDisabled(), "an empty picture can be saved");
      if (name === "all.html" && k === 0) { await rest(page); await shot(page, "lost"); await page.getByRole("button", { name: "Close this plot" }).click(); await page.keyboard.press("Escape"); }
      await page.keyboard.press("Home");
      await lost(false);
      await message(page).waitFor({ state: "hidden", timeout: 10000 });
      expect(await page.getByRole("button", { name: "Picture" }).isEnabled() && await legend.isVisible() === scale, "the picture cannot be saved, or its colours have no scale");
      expect(await picture(page) === before, "it returns as another picture");
    }
    await page.keyboard.press("End");
    expect(await picture(page) !== before, "the picture stands still");
  }
});

await test("a film without WebGL ends with a message", async () => {
  made("all.html");
  const blind = join(folder, "blind");  // a Chromium that cannot draw in 3D
  writeFileSync(blind, `#!/bin/sh\nexec ${program} ${kOff.join(" ")} "$@"\n`);
  chmodSync(blind, 0o755);
  const told = refusal(["convert", "all.results", "film.gif", "--to", "0.2"], { CHROMIUM: blind });
  expect(told.includes("this browser cannot draw in 3D: WebGL 2 is off, not available, or has stopped; name another Chromium with CHROMIUM"), told);
});
