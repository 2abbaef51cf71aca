// SPDX-License-Identifier: Apache-2.0
// Builds dist/viewer.html: one page with script and style inside, and a security policy that admits only these two by
// their hashes. With --check it changes nothing and fails if the page in dist/ differs.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync, mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const root = dirname(fileURLToPath(import.meta.url));
const options = { absWorkingDir: root, bundle: true, minify: true, write: false, charset: "ascii", target: "es2022",
  legalComments: "none", logLevel: "error" };
const script = await build({ ...options, entryPoints: ["src/main.ts"], format: "iife" });
const style = await build({ ...options, entryPoints: ["src/style.css"], loader: { ".css": "css" } });
const parts = ["three", "uplot"].map((name) => {
  const file = (path) => readFileSync(join(root, "node_modules", name, path), "utf8");
  return { name, about: JSON.parse(file("package.json")), licence: file("LICENSE").replaceAll("\u00a9", "(c)").trim() };
});
const licences = parts.map(({ name, about }) => `${name} ${about.version} (${about.license})`).join(", ");
// Both licences require their text in every copy. It is a part of the script, which may be stored apart from the page.
const notices = parts.map(({ name, about, licence }) => `/*! ${name} ${about.version}\n\n${licence}\n*/\n`).join("");

const js = notices + script.outputFiles[0].text.replaceAll("</script", "<\\/script").trim();
const css = style.outputFiles[0].text.trim();
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const policy = `default-src 'none'; script-src ${hash(js)}; style-src ${hash(css)}; img-src data: blob:; connect-src 'self'; ` +
  "base-uri 'none'; form-action 'none'";
const page = readFileSync(join(root, "src/page.html"), "utf8")
  .replace("<!--POLICY-->", () => `<meta http-equiv="Content-Security-Policy" content="${policy}">`)
  .replace("<!--LICENCES-->", () => `<!-- Polhode viewer, Apache-2.0; with ${licences} -->`)
  .replace("<!--STYLE-->", () => `<style>${css}</style>`)
  .replace("<!--SCRIPT-->", () => `<script>${js}</script>`);
const file = join(root, "dist/viewer.html");
if (process.argv.includes("--check")) {
  if (readFileSync(file, "utf8") !== page) {
    console.error("viewer/dist/viewer.html is not the build of viewer/src. Run 'npm run build' in viewer/ and commit it.");
    process.exit(1);
  }
  console.log("viewer/dist/viewer.html is the build of viewer/src.");
} else {
  mkdirSync(join(root, "dist"), { recursive: true });
  writeFileSync(file, page);
  console.log(`dist/viewer.html ${(page.length / 1e3).toFixed(0)} KB`);
}
