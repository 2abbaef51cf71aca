// SPDX-License-Identifier: Apache-2.0
// The documentation site in a headless Chromium without network: node site.mjs FOLDER. Skipped (77) without Chromium.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { launch } from "./browser.mjs";

const site = resolve(process.argv[2]), browser = await launch();
if (!browser) { console.log("skipped: there is no Chromium"); process.exit(77); }
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let failed = 0;
const expect = (condition, text) => { if (!condition) { failed++; console.log(`FAILED  ${text}`); } };

async function open(path, options, look) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 800 }, offline: true, ...options }), page = await context.newPage();
  context.setDefaultNavigationTimeout(180_000);  // a busy machine
  const faults = [];
  page.on("console", (m) => { if (["error", "warning"].includes(m.type()) && !/GL Driver Message|software WebGL/.test(m.text())) faults.push(m.text()); });
  page.on("pageerror", (e) => faults.push(String(e)));
  page.on("request", (r) => { if (/^(https?|wss?):/.test(r.url())) faults.push(`asks for ${r.url()}`); });
  await page.goto(pathToFileURL(join(site, path.split("?")[0])).href + (path.includes("?") ? "?" + path.split("?")[1] : ""));
  await look(page);
  expect(faults.length === 0, `${path}: ${faults.slice(0, 2).join(" | ")}`);
  if (process.env.SCREENSHOTS) await page.screenshot({ path: join(process.env.SCREENSHOTS, `site_${path.replace(/\W+/g, "_")}${options.colorScheme ?? ""}${options.isMobile ? "phone" : ""}.png`) });
  await context.close();
}
const phone = { viewport: { width: 390, height: 780 }, isMobile: true, hasTouch: true };
for (const path of ["index.html", "gallery.html", "theory/joints.html", "reference/conventions.html", "quick_start/robot.html", "api/python.html", "search.html?q=joint"])
  for (const options of [{}, { colorScheme: "dark" }, phone])
    await open(path, options, async (page) => {
      await page.evaluate(axe);
      const found = await page.evaluate(() => window.axe.run(document.querySelector("article"), { resultTypes: ["violations"], preload: false, rules: { "scrollable-region-focusable": { enabled: false } } }));
      const list = found.violations.map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 120)}`);
      expect(list.length === 0, `${path} ${JSON.stringify(options)}: ${list.join(" | ")}`);
      if (options.isMobile) expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${path} is wider than a phone`);
      expect(await page.evaluate(() => [...document.images].every((i) => !i.complete || i.naturalWidth > 0 || i.loading === "lazy")), `${path}: a picture is missing`);
    });
await open("theory/joints.html", {}, async (page) => expect(await page.locator("math").count() > 20 && await page.locator("#equation-joint-coincident math").count() === 1, "formulas are no formulas"));
// Rows of a formula stand under each other at their signs of equality, and brackets are as tall as what they hold.
for (const [path, id, count] of [["theory/rigid_body_dynamics.html", "equation-eq-td-newmark-com", 2], ["theory/rigid_body_dynamics.html", "equation-eq-td-newmark-mrot", 3]])
  await open(path, {}, async (page) => {
    const { rows, outside, label } = await page.evaluate((id) => {
      const formula = document.getElementById(id), table = formula.querySelector("mtable"), box = (e) => e.getBoundingClientRect();
      return { label: box(formula.querySelector(".label")).right, outside: formula.scrollWidth - formula.clientWidth,
        rows: [...(table?.querySelectorAll(":scope > mtr") ?? [])].map((row) => {
          const left = row.children[0].lastElementChild;
          return { y: box(row).y, height: box(row).height, sign: box([...row.querySelectorAll("mo")].find((mo) => mo.textContent === "=")).x, left: left && box(left).right };
        }) };
    }, id);
    expect(rows.length === count && rows.every((row, i) => i === 0 || (row.y >= rows[i - 1].y + rows[i - 1].height - 1 && Math.abs(row.sign - rows[0].sign) < 1)), `${id} has rows at ${JSON.stringify(rows)}`);
    expect(rows.every((row) => row.left === null || Math.abs(row.left - rows[0].left) < 1), `the left sides of ${id} do not end at the signs of equality: ${JSON.stringify(rows)}`);
    expect(outside <= 0 && label < 1200, `${id} is wider than its page`);
  });
for (const path of ["theory/rigid_body_dynamics.html", "theory/surface_contact.html", "theory/loads.html"])
  await open(path, {}, async (page) => {
    const low = await page.evaluate(() => [...document.querySelectorAll("article math mo[stretchy=true]")].filter((mo) => !mo.hasAttribute("maxsize") && mo.textContent.trim()).map((mo) => {
      // The parts of its row beside it, up to its own bracket.
      const all = [...mo.parentElement.children].filter((e) => e.localName === "mfrac" || e.localName === "munder" || e.localName === "mtable"), height = Math.max(0, ...all.map((e) => e.getBoundingClientRect().height));
      return { text: mo.textContent, height: mo.getBoundingClientRect().height, held: height };
    }).filter(({ height, held }) => height < 0.8 * held));
    const count = await page.locator("article math mo[stretchy=true]").count();
    expect(count > 10 && low.length === 0, `${path}: of ${count} brackets these are too low: ${JSON.stringify(low.slice(0, 4))}`);
    expect(await page.locator("article math").evaluateAll((all) => all.every((m) => !m.textContent.includes("&"))), `${path}: a formula has a sign of columns`);
  });
// Tables give the room to what they mean: source files are short links, with their paths as titles.
for (const [path, column] of [["reference/joints.html", "meaning"], ["reference/numerics.html", "reason"], ["theory/index.html", "code"]])
  await open(path, {}, async (page) => {
    const found = await page.evaluate(() => {
      const table = document.querySelector("article table"), names = [...table.querySelectorAll("th")].map((th) => th.textContent);
      return { shown: table.clientWidth, whole: table.scrollWidth, widths: Object.fromEntries(names.map((name, i) => [name, table.querySelector("tbody tr").children[i].clientWidth])),
        paths: [...table.querySelectorAll("td")].map((td) => td.innerText).filter((text) => /(src|tests)\/[\w/]+\.(hpp|cpp)/.test(text)).slice(0, 3), titled: table.querySelectorAll('a.code[title^="src/"]').length };
    });
    expect(found.paths.length === 0 && found.titled > 10, `${path} has paths in a table: ${found.paths}, ${found.titled} with titles`);
    expect(found.whole <= found.shown && found.widths[column] >= 0.24 * found.shown, `${path}: its table is ${found.whole} of ${found.shown} wide, columns ${JSON.stringify(found.widths)}`);
  });
await open("reference/joints.html", {}, async (page) => {
  const widths = await page.evaluate(() => [...document.querySelector("article table tbody tr").children].map((td) => td.clientWidth));
  expect(widths[2] === Math.max(...widths), `the meaning of joints is not the widest column of ${widths}`);
});
// Contents of the site: five quick starts, every example with its picture, help, terms of other programs, interfaces, the theory as one file.
const examples = join(dirname(fileURLToPath(import.meta.url)), "../../examples"), all = readdirSync(examples).filter((name) => existsSync(join(examples, name, "model.yaml")));
await open("gallery.html", {}, async (page) => {
  await page.evaluate(() => Promise.all([...document.querySelectorAll(".card img")].map((img) => { img.loading = "eager"; return img.decode(); })));
  const cards = await page.locator(".gallery .card").evaluateAll((all) => all.map((card) => ({ link: card.querySelector("a:has(img)")?.getAttribute("href"), live: card.querySelector("a.play")?.getAttribute("href"), topics: card.querySelector(".topics")?.textContent,
    picture: card.querySelector("img").naturalWidth === 480 && card.querySelector("img").src.split("/").at(-1) })));
  const missing = all.filter((name) => !cards.some((card) => card.link?.includes(`examples/${name}/`) && card.picture === `${name}.webp` && card.topics));
  expect(all.length > 30 && missing.length === 0 && cards.length === all.length, `the gallery of ${cards.length} cards has no picture or topics of ${missing}`);
  if (existsSync(join(site, "live"))) {
    const wanted = process.env.LIVE === undefined ? all : process.env.LIVE.split(" "), dead = wanted.filter((name) => !cards.some((card) => card.live === `live/${name}.html`) || !existsSync(join(site, `live/${name}.html`)));
    expect(dead.length === 0, `the gallery does not play ${dead}`);
  }
  const shown = async () => page.locator(".gallery .card:visible").evaluateAll((found) => found.map((card) => card.querySelector("a:has(img)").getAttribute("href").split("/")[1]));
  const field = page.locator("#gallery-filter input"), topic = (name) => page.locator(`#gallery-filter button[data-topic="${name}"]`);
  await field.fill("gears");
  const gears = await shown();
  expect(["gear_pair", "planetary_gearbox"].every((name) => gears.includes(name)) && gears.length < 6, `'gears' leaves ${gears}`);
  await field.fill("");
  await topic("solids").click();
  const solids = await shown();
  expect(solids.includes("knee") && solids.includes("tyre_on_kerb") && !solids.includes("stack") && solids.length < 15, `the topic solids leaves ${solids}`);
  await topic("contact").click();
  const both = await shown();
  expect(both.includes("tyre_on_kerb") && !both.includes("knee") && both.length > 1 && await topic("contact").getAttribute("aria-pressed") === "true", `solids with contact are ${both}`);
  expect((await page.locator("#gallery-filter [role=status]").innerText()).startsWith(`${both.length} of ${all.length}`), "the number of examples is not that shown");
  const address = page.url();
  await page.goto("about:blank");
  await page.goto(address);
  expect(String(await shown()) === String(both), "the filter is not in the address");
  await topic("solids").click();
  await topic("contact").click();
  expect((await shown()).length === all.length, "examples stay hidden without a filter");
});
for (const path of [...["mechanism", "spacecraft", "tissue", "robot", "classroom"].map((name) => `quick_start/${name}`), "how_to/step_does_not_converge", "how_to/is_my_result_right", "how_to/coming_from_another_program", "how_to/what_is_not_there",
  "reference/conventions", "reference/model_file", "api/python", "api/cpp/index", "validation", "benchmarks"]) expect(existsSync(join(site, `${path}.html`)), `there is no ${path}.html`);
const terms = readFileSync(join(site, "how_to/coming_from_another_program.html"), "utf8");
for (const program of ["FEBio", "Chrono", "MuJoCo", "Adams", "Exudyn", "Simscape Multibody", "OpenSim", "Drake", "Pinocchio", "Basilisk"]) expect(new RegExp(`<h2>${program}<a`).test(terms), `terms of ${program} are missing`);
expect(readFileSync(join(site, "theory.pdf")).subarray(0, 5).toString() === "%PDF-", "the theory is no PDF");
// The search: the page that is meant comes first, with excerpts that show the words and links to their sections.
for (const [words, at, place] of [["joint friction", "reference/joints.html", "friction-and-limits"], ["bushing", "reference/connectors.html", "bushings"], ["step does not converge", "how_to/step_does_not_converge.html"],
  ["rotary_motor", "reference/model_file.html", "load-rotary-motor"], ["muscle", "reference/beams.html", "muscles"], ["units", "reference/conventions.html", "units"], ["osim", "how_to/what_is_not_there.html", "files"], ["reactionWheelStateEffector", "how_to/coming_from_another_program.html", "basilisk"], ["planetary gears", "examples/planetary_gearbox/index.html"]])
  await open(`search.html?q=${encodeURIComponent(words)}`, {}, async (page) => {
    await page.locator("#search-results li a").first().waitFor();
    const first = page.locator("#search-results > li").first(), links = await first.locator("a").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
    expect(links[0] === at && (!place || links.includes(`${at}#${place}`)), `a search for '${words}' finds ${links} first, not ${at}`);
    const text = await first.innerText(), marked = (await first.locator("mark").allTextContents()).map((word) => word.toLowerCase());
    const shown = [...marked, ...(await first.locator("a").allTextContents()).join(" ").toLowerCase().split(" ")];
    expect(marked.length > 0 && words.split(" ").every((word) => shown.some((mark) => mark.startsWith(word.slice(0, 6)))), `the excerpts for '${words}' mark ${marked}`);
    expect(text.length > 120 && text.length < 1200, `the excerpts for '${words}' have ${text.length} letters`);
  });
await open("search.html?q=quaternion%20order", {}, async (page) => {
  await page.locator("#search-results li a").first().waitFor();
  const links = async () => (await page.locator("#search-results > li > a").evaluateAll((all) => all.map((a) => a.getAttribute("href"))));
  expect((await links()).includes("reference/conventions.html"), "a search for 'quaternion order' does not find the conventions");
  const before = (await links()).length;
  await page.locator("#search-status button").click();
  expect((await links()).length > before, "the other pages are not shown");
  await page.locator('input[name="q"]').first().fill("zzzq");
  await page.waitForFunction(() => document.querySelectorAll("#search-results > li").length === 0);
  expect((await page.locator("#search-status").innerText()).includes("No page holds “zzzq”"), "a search without results does not say so");
});
if (existsSync(join(site, "live")))
  await open("examples/heavy_top/index.html", {}, async (page) => {
    await page.locator("iframe.live").scrollIntoViewIfNeeded();
    const frame = await (await page.locator("iframe.live").elementHandle()).contentFrame();
    await frame.waitForFunction(() => document.documentElement.dataset.ready, null, { timeout: 60000 });
  });
if (existsSync(join(site, "../versions.js")))
  await open("theory/joints.html", {}, async (page) => {
    await page.locator(".versions select").waitFor();
    const name = site.split("/").at(-1), names = await page.locator(".versions option").allTextContents();
    expect(await page.locator(".versions select").inputValue() === name && names.includes(name), `version ${name} is not chosen out of ${names}`);
    await page.locator(".versions select").evaluate((select) => select.dispatchEvent(new Event("change")));
    await page.waitForURL(/index\.html$/);
  });
await browser.close();
console.log(failed ? `${failed} faults` : "the site opens, searches and plays without network");
process.exit(failed ? 1 : 0);
