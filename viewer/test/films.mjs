// SPDX-License-Identifier: Apache-2.0
// Films and pictures by `polhode convert`.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { program } from "./browser.mjs";
import { browser, expect, folder, made, page_of, recorded, refusal, run, test } from "./support.mjs";

await test("a film has the pictures that were asked for", async () => {
  made("all.html");
  run("convert", "all.results", "film.gif", "--size", "160x120", "--rate", "8", "--to", "0.5", "--turn", "30");
  const { page } = await page_of("all.html");
  // Decoded by the browser, independently of Polhode.
  const found = await page.evaluate(async (text) => {
    const decoder = new ImageDecoder({ data: Uint8Array.from(atob(text), (c) => c.charCodeAt(0)), type: "image/gif" });
    await decoder.tracks.ready;
    await decoder.completed;
    const pictures = [];
    for (let k = 0; k < decoder.tracks.selectedTrack.frameCount; k++) {
      const { image } = await decoder.decode({ frameIndex: k }), canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight), context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const data = context.getImageData(0, 0, canvas.width, canvas.height).data, seen = new Set();
      for (let i = 0; i < data.length; i += 4) seen.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
      pictures.push({ size: `${canvas.width}x${canvas.height}`, colours: seen.size, sum: data.reduce((s, v, i) => (s + v * (i % 65521)) % 4294967291, 0) });
    }
    return pictures;
  }, readFileSync(join(folder, "film.gif")).toString("base64"));
  expect(found.length === 5 && found[0].size === "160x120" && found.every((p) => p.colours > 20), JSON.stringify(found));
  expect(new Set(found.map((p) => p.sum)).size === 5, "pictures are alike");
  run("convert", "all.results", "pictures", "--size", "64x48", "--rate", "2");
  expect(readFileSync(join(folder, "pictures/00002.png")).subarray(1, 4).toString() === "PNG", "no pictures in the folder");
  mkdirSync(join(folder, "made/film.gif"), { recursive: true });  // a folder of that name, so that writing fails after drawing
  for (const [words, text] of [[["film.avi"], "cannot write '.avi' files"], [["film.gif", "--size", "10"], "Write it as 640x400"], [["film.gif", "--from", "3"], "the recording goes from 0 to 1 s"],
    [["no/such/film.gif"], "no/such/film.gif: cannot be written: its folder does not exist. Make the folder first."], [["made/film.gif", "--to", "0.2"], "made/film.gif: is a folder. Name a file."]])
    expect(refusal(["convert", "all.results", ...words]).includes(text), refusal(["convert", "all.results", ...words]));
});

await test("the camera of a film goes round, and begins where a link says", async () => {
  recorded("cube", "format: 1\nbodies: {cube: {shape: {box: [1, 0.5, 1]}, density: 1000}}\nanalysis: {duration: 1 s, step: 0.1 s}\noutput: {every: 0.5 s}\n");
  const { page } = await page_of("cube.html"), at = (distance) => `#eye=0,-${distance},0&at=0,0,0`;
  /** Parts of the picture that have the cube's colour, which is blue. */
  const blue = (file) => page.evaluate(async (text) => {
    const drawn = Object.assign(new Image(), { src: `data:image/png;base64,${text}` });
    await drawn.decode();
    const flat = new OffscreenCanvas(drawn.width, drawn.height), context = flat.getContext("2d");
    context.drawImage(drawn, 0, 0);
    const { data } = context.getImageData(0, 0, flat.width, flat.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += data[i + 2] > data[i] + 30 ? 1 : 0;
    return count / (data.length / 4);
  }, readFileSync(join(folder, file)).toString("base64"));
  const film = (name, ...words) => run("convert", "cube.results", name, "--size", "240x240", "--rate", "4", ...words);
  film("round", "--turn", "360", "--link", at(5));
  const round = [];
  for (let k = 0; k < 5; k++) round.push(await blue(`round/0000${k}.png`));
  // Front, side, back, side, front of a box twice as wide as deep, in perspective.
  const [front, side] = [1 / (5 - 0.25) ** 2, 0.5 / (5 - 0.5) ** 2].map((area) => area / (4 * Math.tan(17.5 * Math.PI / 180) ** 2));
  [front, side, front, side, front].forEach((part, k) => expect(Math.abs(round[k] / part - 1) < 0.06, `picture ${k} has ${round[k]} of blue, not ${part}`));
  film("far", "--to", "0", "--link", at(10));
  expect(Math.abs(await blue("far/00000.png") / front / (4.75 / 9.75) ** 2 - 1) < 0.1, `from afar it has ${await blue("far/00000.png")} of blue`);
});

await test("what films need is told where it is missing", async () => {
  made("all.html");
  const told = (file, env) => refusal(["convert", "all.results", file], { PATH: "/nowhere", ...env });
  const film = told("film.mp4", { CHROMIUM: program });
  expect(film.includes("an .mp4 file is written by ffmpeg, which is missing. Install the Debian package ffmpeg, or write a .gif file"), film);
  const none = told("film.gif", { CHROMIUM: "" });
  expect(none.includes("films are drawn by Chromium, which is missing. Install the Debian package chromium, or name a Chromium or Chrome with CHROMIUM"), none);
});

await test("an .mp4 film has the size, the rate, the duration and the pictures that were asked for", async () => {
  if (spawnSync("ffmpeg", ["-version"]).error || spawnSync("ffprobe", ["-version"]).error) return console.log("        not looked at: there is no ffmpeg (Debian package ffmpeg)");
  made("all.html");
  const words = ["--size", "161x120", "--rate", "8", "--from", "0.25", "--to", "1", "--turn", "60"];
  run("convert", "all.results", "film.mp4", ...words);
  run("convert", "all.results", "same", ...words);
  const of = (name, ...words) => execFileSync(name, ["-v", "error", ...words], { cwd: folder, maxBuffer: 1 << 28 });
  const { streams: [film], format } = JSON.parse(of("ffprobe", "-count_frames", "-show_streams", "-show_format", "-of", "json", "film.mp4"));
  // Players need even numbers of pixels: 161 become 162.
  expect(film.codec_name === "h264" && film.pix_fmt === "yuv420p" && film.width === 162 && film.height === 120, JSON.stringify(film));
  expect(film.color_space === "bt709" && film.color_range === "tv", "players must guess its colours");
  expect(film.r_frame_rate === "8/1" && Number(film.nb_read_frames) === 7 && Math.abs(Number(format.duration) - 7 / 8) < 0.01, JSON.stringify([film, format]));
  // Its pictures are those of the folder up to compression losses, and differ more from the next ones.
  const raw = (...words) => of("ffmpeg", ...words, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"), pad = ["-vf", "pad=162:120"];
  const pictures = raw("-i", "film.mp4", "-vf", "scale=in_color_matrix=bt709:in_range=tv"), drawn = raw("-i", "same/%05d.png", ...pad), size = 162 * 120 * 3;
  expect(pictures.length === 7 * size && drawn.length === 7 * size, `${pictures.length} and ${drawn.length} bytes`);
  const apart = (a, i, b, j) => { let sum = 0; for (let k = 0; k < size; k++) if (k % 486 < 480) sum += Math.abs(a[i * size + k] - b[j * size + k]); return sum / size; };
  for (let i = 0; i < 7; i++) {
    const lost = apart(pictures, i, drawn, i), moved = Math.min(...[i - 1, i + 1].filter((j) => j >= 0 && j < 7).map((j) => apart(drawn, i, drawn, j)));
    expect(lost < 5 && lost < 0.5 * moved, `picture ${i}: ${lost} levels from the one that was drawn, ${moved} between two`);
  }
});
