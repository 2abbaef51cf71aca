// SPDX-License-Identifier: Apache-2.0
// Pages and scenes as files: archives, notebooks, truncated files, glTF.
import { execFileSync } from "node:child_process";
import { copyFileSync, readFileSync, statSync, truncateSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { clock, colours, expect, folder, made, page_of, run, test } from "./support.mjs";

await test("recordings in an archive share the player", async () => {
  made("all.html");
  made("tyre.html");
  run("view", "all.results", "tyre.results", "--zip", "both.zip", "--quiet");
  execFileSync("python3", ["-m", "zipfile", "-e", "both.zip", "both"], { cwd: folder });
  expect(statSync(join(folder, "both.zip")).size < statSync(join(folder, "all.html")).size, "the archive of two is larger than one page");
  for (const name of ["all", "tyre"]) {
    const { page } = await page_of(`both/${name}.html`);
    expect(!(await page.evaluate(() => document.documentElement.dataset.failed)), await page.locator("#app").textContent());
    expect(await colours(page) > 30, "the picture is empty");
  }
  const player = readFileSync(join(folder, "both/player.js"), "utf8");
  for (const notice of ["three.js authors", "Leon Sorokin", "Permission is hereby granted"]) expect(player.includes(notice), `player.js lacks '${notice}'`);
  const list = readFileSync(join(folder, "both/index.html"), "utf8");
  expect(list.includes('<a href="all.html">all</a> Everything, 101 frames') && list.includes('href="tyre.html"'), list);
});

await test("a page in the frame of a notebook plays", async () => {
  made("all.html");
  // A frame as in python/polhode/_show.py: without origin, scripts and downloads only.
  const text = readFileSync(join(folder, "all.html"), "utf8").replaceAll("&", "&amp;").replaceAll('"', "&quot;");
  writeFileSync(join(folder, "notebook.html"), `<!doctype html><title>Notebook</title><iframe srcdoc="${text}" width="100%" height="600" sandbox="allow-scripts allow-downloads"></iframe><script>document.documentElement.dataset.ready = "1"</script>`);
  const { page } = await page_of("notebook.html");
  const frame = page.frameLocator("iframe");
  await frame.getByRole("button", { name: "Play", exact: true }).click({ timeout: 60000 });
  await frame.locator("output.clock").filter({ hasText: /0\.0[2-9]|0\.[1-9]/ }).waitFor({ timeout: 20000 });
});

await test("truncated results are shown up to the last complete frame", async () => {
  made("all.html");
  const file = join(folder, "cut.h5");
  run("run", "all.yaml", "--quiet", "-o", "long.results", "--set", "analysis.step=0.5 ms", "--set", "output.every=0.5 ms");
  copyFileSync(join(folder, "long.results/results.h5"), file);
  truncateSync(file, Math.floor(0.8 * statSync(file).size));
  run("view", "cut.h5", "--html", "cut.html", "--quiet");
  const { page } = await page_of("cut.html");
  expect((await page.locator(".notes").textContent({ timeout: 2000 })).includes("cut short"), "no note");
  await page.keyboard.press("End");
  const end = await clock(page);
  // Frames are written in blocks, of which the first has those of a twentieth of a second of the run.
  expect(end > 0.005 && end < 1, `the last frame is at ${end}`);
});

await test("a page that has lost its end says so", async () => {
  made("all.html");
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
  made("all.html");
  const { default: validator } = await import("gltf-validator");
  run("convert", "all.results", "all.glb");
  const bytes = new Uint8Array(readFileSync(join(folder, "all.glb"))), report = await validator.validateBytes(bytes);
  expect(report.issues.numErrors + report.issues.numWarnings === 0, JSON.stringify(report.issues.messages.slice(0, 3)));
  expect(report.info.animationCount === 1 && report.info.totalVertexCount > 100, "no animation or no shapes");
});
