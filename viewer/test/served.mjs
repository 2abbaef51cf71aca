// SPDX-License-Identifier: Apache-2.0
// Models and results are served, and loaded again when they are saved.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { expect, folder, model, page_of, served, test } from "./support.mjs";

await test("a model is served, and loaded again when it is saved", async () => {
  writeFileSync(join(folder, "served.yaml"), model);
  await served(["served.yaml"], async (address) => {
    const { page } = await page_of(address);
    expect((await page.locator(".notes").textContent()).includes("mobility"), "no mobility");
    await page.waitForTimeout(500);
    writeFileSync(join(folder, "served.yaml"), model.replace("title: Everything", "title: Saved again"));
    await page.getByRole("heading", { name: "Saved again" }).waitFor({ timeout: 60000 });
    // A fault of the model is shown with its location, and the page returns when it is corrected; redundant joints are marked.
    const save = async (text) => { await page.waitForTimeout(1200); writeFileSync(join(folder, "served.yaml"), text); };
    await save(model.replace("restitution: 0.5", "restituton: 0.5"));
    await page.locator(".failed").waitFor({ timeout: 60000 });
    expect(/served\.yaml:\d+:\d+.*restituton[^]*restitution/.test(await page.locator(".failed").textContent()), await page.locator(".failed").textContent());
    await save(model.replace("joints:\n", "joints:\n  second: {type: revolute, bodies: [ground, arm], at: [0, 1.5, 1], axis: y}\n"));
    await page.locator(".notes").waitFor({ timeout: 60000 });
    expect((await page.locator(".notes").textContent()).includes("5 redundant"), await page.locator(".notes").textContent());
    await page.getByRole("button", { name: /^second/ }).first().click();
    expect((await page.locator(".details .warn").textContent()).includes("redundant"), "the joint has no mark");
  });
});
