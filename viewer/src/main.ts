// SPDX-License-Identifier: Apache-2.0
import { bookmarkOf, follow } from "./bookmark";
import { Scene } from "./data";
import { figure, h, save } from "./dom";
import { ExtremesPanel } from "./extremes";
import { filmWanted, shoot } from "./film";
import { Ghost } from "./ghost";
import { displayPanel, Legend, ObjectPanel, objectsOf } from "./panels";
import { Player } from "./player";
import { PlotArea } from "./plot_area";
import type { Mode } from "./plots";
import { firstPlots, probesOf } from "./probes";
import { offered, seriesOf } from "./series";
import { quantity } from "./units";
import { View, type Choice } from "./view";

const kKeys: [string, string][] = [["Space", "play or pause"], ["← →", "frame by frame"], ["Home End", "start or end"], ["+ −", "faster or slower"], ["1 2 3 4 0", "front, side, top, oblique, initial view"],
  ["o", "parallel projection"], ["f", "follow the selected object"], ["z", "zoom to the selected object, or to all"], ["h g i a", "hide, ghost, isolate, show all"], ["m", "measure: click two or three points"], ["t", "trails"], ["p", "plots"], ["c", "show or hide the compared recording"], ["v", "compared recording side by side"], ["/", "search"],
  ["d", "dark or light"], ["b", "write camera and time into the address"], ["Esc", "clear the selection"], ["?", "this list"]];

/** Speed at which a recording takes about ten seconds, from 1, 2, 5 times a power of ten; real time if that is near. */
function pleasantSpeed(duration: number): number {
  if (duration >= 2 && duration <= 30) return 1;
  const wanted = duration / 10, power = 10 ** Math.floor(Math.log10(wanted));
  return [1, 2, 5, 10].map((k) => k * power).reduce((a, b) => (Math.abs(Math.log(b / wanted)) < Math.abs(Math.log(a / wanted)) ? b : a));
}

async function start(app: HTMLElement): Promise<void> {
  const begun = performance.now();
  const scene = await Scene.load(), m = scene.manifest;
  if (m.time.length === 0) throw new Error("These results contain no complete frame. Run the model, or run it longer.");
  document.title = `${m.title || "Model"} – Polhode`;
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.dataset.theme = dark ? "dark" : "light";

  const holder = h("main", { class: "view", "aria-label": "Animation" });
  const drift = h("span", { class: "drift", title: "Largest error of the energy balance so far, over the largest energy; the same number as in the summary of the run" });
  const title = m.title || m.source.file || "Model", head = h("header", {}, h("h1", { title }, title), drift);
  const side = h("aside", { "aria-label": "Objects and display" });
  const bar = h("footer", { class: "time" });
  app.replaceChildren(head, holder, side, bar);
  if (innerWidth <= 720) app.classList.add("wide");

  const view = await View.of(scene, holder);
  const other = m.compared ? await Scene.load(true) : null;
  if (other) view.compare(await Ghost.of(other, m.compared ?? "", view));
  const { canvas } = view.stage;
  canvas.setAttribute("tabindex", "0");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${m.title || "Model"}: ${m.bodies.length} bodies, ${m.joints.length} joints in motion. Drag to rotate, scroll to zoom.`);
  const player = new Player(m.time[0], m.time[m.time.length - 1]);
  player.speed = pleasantSpeed(player.end - player.begin || 1);

  const theme = (on: boolean): void => {
    document.documentElement.dataset.theme = on ? "dark" : "light";
    view.stage.theme(on);
    plots.redraw();
  };
  const probes = probesOf(scene);
  const plots: PlotArea = new PlotArea(scene, { time: () => player.t, seek: (t: number) => player.seek(t) }, other, () => void extremes.refresh());
  const extremes = new ExtremesPanel(scene, probes, () => plots.curves(), (t) => player.seek(t));
  bar.before(plots.element);
  const choose = (choice: Choice | null): void => {
    view.choose(choice);
    void objects.choose(choice);
  };
  const objects = new ObjectPanel(scene, view, { choose, plot: (name) => void plots.add(name, false), refresh: () => { view.stage.dirty = true; } });
  const legend = new Legend(view);
  holder.append(legend.element);

  const search = h("input", { type: "text", list: "channels", placeholder: "bodies.NAME.position.z", "aria-label": "Channel to plot" });
  const trouble = h("p", { class: "warn", role: "status" });
  const tryPlot = async (own: boolean): Promise<void> => {
    const found = await seriesOf(scene, search.value);
    trouble.textContent = found.length === 0 ? `There is no channel '${search.value}'.` : "";
    if (found.length > 0) await plots.add(search.value, own);
  };
  const has = (path: string): boolean => scene.entry(path) !== undefined;
  const preset = (label: string, names: string[], mode: Mode = "time") =>
    names.every((n) => has(n.replaceAll(".", "/"))) ? h("button", { type: "button", onclick: () => plots.openPlot([...names], mode) }, label) : null;
  const plotPanel = h("div", { class: "panel" }, h("datalist", { id: "channels" }, ...offered(scene).slice(0, 1500).map((name) => h("option", { value: name }))),
    h("div", { class: "addplot" }, search, h("button", { type: "button", onclick: () => void tryPlot(false) }, "Add"), h("button", { type: "button", onclick: () => void tryPlot(true) }, "New plot")), trouble,
    h("div", { class: "buttons" }, preset("Energy drift", ["energy.drift"]), preset("Ledger", ["energy.kinetic", "energy.potential", "energy.dissipated"], "stacked"),
      preset("Work and losses", ["energy.put_in", "energy.dissipated"]), preset("Momentum", ["momentum.linear", "momentum.angular"]), preset("Step length", ["solver.dt"])),
    h("p", { class: "faint" }, "Click a plot to set the time; drag to zoom, double-click for the whole range. A phase plot draws the other curves over the first. "
      + "The ledger stacks energies; those with negative values are relative to their minimum."));
  search.addEventListener("keydown", (e) => { if (e.key === "Enter") void tryPlot(false); });

  const display = displayPanel(view, () => { tick(); view.stage.dirty = true; }, theme);
  const panels = [["Objects", objects.element], ["Display", display], ["Plot", plotPanel], ["Extremes", extremes.element]] as const;
  const tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Panels" });
  panels.forEach(([label, panel], i) => {
    panel.id = `panel-${i}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-label", label);
    tabs.append(h("button", { type: "button", role: "tab", id: `tab-${i}`, "aria-controls": panel.id, onclick: () => tab(i) }, label));
  });
  const tab = (k: number): void => panels.forEach(([, panel], i) => {
    panel.hidden = i !== k;
    tabs.children[i].setAttribute("aria-selected", String(i === k));
    if (panel === extremes.element) void extremes.show(i === k);
  });
  tab(0);
  side.append(tabs, ...panels.map(([, panel]) => panel));

  const togglePanel = h("button", { type: "button", "aria-pressed": String(!app.classList.contains("wide")), onclick: () => {
    app.classList.toggle("wide");
    togglePanel.setAttribute("aria-pressed", String(!app.classList.contains("wide")));
  } }, "Panel");
  const help = h("dialog", { "aria-label": "Keyboard" }, h("h2", {}, "Keyboard"), h("table", {}, h("tbody", {}, ...kKeys.map(([key, what]) => h("tr", {}, h("th", { scope: "row" }, h("kbd", {}, key)), h("td", {}, what))))),
    h("p", { class: "faint" }, `Polhode ${m.source.version}. ${m.frames} frames${m.frames < m.file_frames ? ` of ${m.file_frames} in the file` : ""}.`), h("button", { type: "button", onclick: () => help.close() }, "Close"));
  document.body.append(help);
  const picture = (): void => { view.stage.draw(); canvas.toBlob((blob) => { if (blob) save("picture.png", blob); }); };
  const pictureButton = h("button", { type: "button", class: "optional", onclick: picture }, "Picture");
  (view.stage.onblank = () => { pictureButton.disabled = view.stage.blank; })();
  head.append(pictureButton, h("button", { type: "button", class: "optional", onclick: () => link() }, "Link"), togglePanel, h("button", { type: "button", "aria-label": "Keyboard help", onclick: () => help.showModal() }, "?"));
  const link = (): void => { location.hash = bookmarkOf(view, player); void navigator.clipboard?.writeText(location.href).catch(() => undefined); };

  const play = h("button", { type: "button", "aria-label": "Play", onclick: () => player.toggle() }, "▶");
  const scrub = h("input", { type: "range", min: 0, max: Math.max(1, m.frames - 1), step: "any", value: 0, "aria-label": m.statics ? "Load factor" : "Time", oninput: () => {
    const x = scrub.valueAsNumber, k = Math.min(m.frames - 1, Math.floor(x));
    player.seek(m.time[k] + (x - k) * ((m.time[k + 1] ?? m.time[k]) - m.time[k]));
  } });
  const shown = h("output", { class: "clock", "aria-label": "Current time" });
  const speeds = [...new Set([player.speed, ...[1e-4, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 100, 1000]])].sort((a, b) => a - b);
  const speed = h("select", { "aria-label": "Speed", onchange: () => { player.speed = Number(speed.value); } }, ...speeds.map((s) => h("option", { value: s, selected: s === player.speed }, `${s}×`)));
  const loop = h("button", { type: "button", class: "optional", "aria-pressed": "true", title: "Repeat the recording", onclick: () => { player.loop = !player.loop; loop.setAttribute("aria-pressed", String(player.loop)); } }, "Loop");
  bar.append(play, scrub, shown, speed, loop);
  if (m.frames < 2) for (const control of [play, scrub, speed, loop]) control.disabled = true;

  // Data that are loaded later may be missing in a truncated page.
  addEventListener("unhandledrejection", (event) => {
    event.preventDefault();
    const message = event.reason instanceof Error ? event.reason.message : String(event.reason);
    if (holder.querySelector(".trouble")?.textContent === message) return;
    holder.append(h("p", { class: "notes trouble", role: "alert" }, message));
  });
  const notes = [...m.notes];
  if (m.cut_short) notes.unshift(`The results file is cut short: shown up to its last complete frame, ${m.statics ? "load factor" : "t ="} ${figure(player.end)}${m.statics ? "" : " s"}.`);
  if (notes.length > 0) {
    const box = h("div", { class: "notes", role: "note" }, h("button", { type: "button", "aria-label": "Close the notes", onclick: () => box.remove() }, "✕"), h("ul", {}, ...notes.map((note) => h("li", {}, note))));
    holder.append(box);
  }
  if (view.ghost) {
    const { ghost } = view, ends = ghost.end < player.end - 1e-9 * (player.end - player.begin) ? `, which ends at ${figure(ghost.end)}${m.statics ? "" : " s"}` : "";
    holder.append(h("div", { class: "sides", "aria-hidden": "true", hidden: true }, h("span", {}, m.name ?? ""), h("span", {}, ghost.name)));
    holder.append(h("div", { class: "compared", role: "note" }, h("span", { class: "dot", "aria-hidden": "true" }), `${m.name}, and as a ghost ${ghost.name}${ends}`));
  }
  const ruler = h("div", { class: "measure", role: "status", hidden: true });
  holder.append(ruler);

  const balance = await scene.channel("energy/drift");
  const drift_of_run = m.energy_drift ?? 0;
  const tick = (): void => {
    view.set(player.t);
    const f = view.poses.frame + view.poses.part;
    if (document.activeElement !== scrub || player.playing) scrub.valueAsNumber = f;
    scrub.setAttribute("aria-valuetext", `${figure(player.t)}${m.statics ? "" : " s"}`);
    shown.textContent = m.statics ? figure(player.t) : `${player.t.toFixed(Math.max(2, Math.min(6, 3 - Math.floor(Math.log10(player.end - player.begin || 1)))))} s`;
    play.textContent = player.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", player.playing ? "Pause" : "Play");
    if (balance && !m.statics) {
      drift.textContent = `energy drift ${balance[view.poses.frame].toExponential(1)} (${drift_of_run.toExponential(1)} at the end)`;
      drift.classList.toggle("bad", drift_of_run > 1e-3);
    }
    objects.tick();
    legend.tick();
    const sides = holder.querySelector<HTMLElement>(".sides"), note = holder.querySelector<HTMLElement>(".compared");
    if (sides && note) { sides.hidden = !view.beside; note.hidden = view.beside; }
    plots.tick();
    const measured = view.measured();
    ruler.hidden = !view.measuring && !measured;
    if (!ruler.hidden) ruler.textContent = measured ? `${quantity(measured.distance, "m")}${Number.isFinite(measured.angle) ? `, ${figure(measured.angle * 180 / Math.PI)}°` : ""}${measured.between ? ` (${measured.between})` : ""}` : "Click two points, or three for an angle.";
  };
  player.onchange(tick);
  let turning = 0;  // a timer, as each step of a wheel is a movement of its own
  const moving = (): void => view.stage.setMoving(player.playing || turning !== 0);
  player.onchange(moving);
  view.stage.controls.addEventListener("start", () => { clearTimeout(turning); turning = -1; moving(); });
  view.stage.controls.addEventListener("end", () => { turning = window.setTimeout(() => { turning = 0; moving(); }, 300); });

  let down = [0, 0];
  canvas.addEventListener("pointerdown", (e) => { down = [e.clientX, e.clientY]; });
  canvas.addEventListener("pointerup", (e) => {
    if (Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return;
    const spot = view.measuring ? view.spot(e.clientX, e.clientY) : null;
    if (spot) { view.addMark(spot); tick(); } else choose(view.pick(e.clientX, e.clientY)?.choice ?? null);
  });
  canvas.addEventListener("pointermove", (e) => { if (view.measuring && e.buttons === 0) view.point(view.spot(e.clientX, e.clientY)); });

  const chosenBody = (): number => (view.chosen?.kind === "body" ? view.chosen.index : -1);
  const keys: Record<string, () => void> = {
    " ": () => player.toggle(), ArrowRight: () => player.seek(m.time[Math.min(m.frames - 1, view.poses.frame + 1)]), ArrowLeft: () => player.seek(m.time[Math.max(0, view.poses.part > 0 ? view.poses.frame : view.poses.frame - 1)]),
    Home: () => player.seek(player.begin), End: () => player.seek(player.end), "+": () => changeSpeed(1), "-": () => changeSpeed(-1), Escape: () => { view.measuring = false; view.clearMarks(); choose(null); tick(); },
    f: () => view.setFollow(!view.follow), z: () => view.fit(), m: () => { view.measuring = !view.measuring; view.clearMarks(); tick(); }, t: () => view.setTrails(!view.trailsOn), a: () => view.showAll(), "?": () => help.showModal(), b: () => link(),
    d: () => theme(document.documentElement.dataset.theme !== "dark"), p: () => { if (plots.open.length === 0) plots.openPlot(has("energy/kinetic") ? ["energy.kinetic", "energy.potential"] : [offered(scene)[0]]); else plots.toggle(); },
    "/": () => { app.classList.remove("wide"); tab(0); objects.focus(); }, o: () => view.stage.setParallel(view.stage.camera !== view.stage.parallel),
    c: () => { if (view.ghost) display.querySelector<HTMLInputElement>(".ghost input")?.click(); },
    v: () => { if (view.ghost) display.querySelector<HTMLInputElement>(".beside input")?.click(); },
    h: () => { if (chosenBody() >= 0) view.show(chosenBody(), "hidden"); }, g: () => { if (chosenBody() >= 0) view.show(chosenBody(), "ghost"); }, i: () => { if (chosenBody() >= 0) view.isolate(chosenBody()); },
  };
  [..."12340"].forEach((key, i) => { keys[key] = () => display.querySelectorAll<HTMLButtonElement>(".buttons button")[i].click(); });
  const changeSpeed = (by: number): void => {
    speed.selectedIndex = Math.min(speeds.length - 1, Math.max(0, speed.selectedIndex + by));
    player.speed = Number(speed.value);
  };
  // Space plays, also after a click on a control; one that was reached with the keyboard takes it for itself.
  let byKeyboard = false;
  addEventListener("pointerdown", () => { byKeyboard = false; }, true);
  addEventListener("keydown", (e) => { if (e.key === "Tab") byKeyboard = true; }, true);
  addEventListener("keyup", (e) => { if (e.key === " " && !byKeyboard && (e.target as HTMLElement).matches("button, input[type=checkbox]")) e.preventDefault(); });
  addEventListener("keydown", (e) => {
    const target = e.target as HTMLElement;
    if (e.ctrlKey || e.metaKey || e.altKey || help.open || target.matches(`input:not([type=range]):not([type=checkbox])${e.key === " " && !byKeyboard ? "" : ", select"}`) || (e.key === " " && byKeyboard && target.matches("button, input, pre"))) return;
    if (target.matches("input[type=range]") && e.key.startsWith("Arrow")) return;
    const act = keys[e.key];
    if (!act) return;
    e.preventDefault();
    act();
    view.stage.dirty = true;
  });

  if (!filmWanted()) for (const names of firstPlots(probes, holder.clientWidth < 540 ? 1 : 2)) plots.openPlot(names);
  theme(dark);
  const bookmarked = follow(location.hash, view, player);
  if (bookmarked && objectsOf(scene).some((o) => o.kind === bookmarked.kind && o.index === bookmarked.index)) choose(bookmarked);
  addEventListener("hashchange", () => { const choice = follow(location.hash, view, player); if (choice) choose(choice); });
  tick();
  view.stage.draw();
  document.documentElement.dataset.ready = String(Math.round(performance.now() - begun));

  if (filmWanted()) return shoot(view, player, app, holder);
  // A link to a time shows that time; who wants less motion starts it.
  if (m.frames > 1 && !/[#&]t=/.test(location.hash) && !matchMedia("(prefers-reduced-motion: reduce)").matches) player.toggle();
  let last = performance.now(), frames = 0, slow = 0;
  const loopFrame = (now: number): void => {
    // Three slow pictures in a row during playback: the rendering effort is reduced.
    slow = player.playing && now - last > 120 ? slow + 1 : 0;
    if (slow >= 3) { view.lighten(); slow = 0; }
    player.advance(Math.min(0.25, (now - last) / 1000));
    last = now;
    if (view.stage.dirty) { view.stage.draw(); document.documentElement.dataset.frames = String(++frames); }
    requestAnimationFrame(loopFrame);
  };
  requestAnimationFrame(loopFrame);
  if (scene.served) watchFile();
}

/** Reloads the page when its file is saved. */
function watchFile(): void {
  const look = (): void => void Scene.askStamp().then((stamp) => {
    if (Scene.stamp && stamp !== Scene.stamp && stamp !== "gone") location.reload();
  }).catch(() => undefined);
  look();
  setInterval(look, 1000);
}

const app = document.getElementById("app") as HTMLElement;
start(app).catch((error: unknown) => {
  app.replaceChildren(h("pre", { class: "failed", role: "alert" }, error instanceof Error ? error.message : String(error)));
  document.documentElement.dataset.failed = "yes";
  if (location.protocol !== "file:") watchFile();
});
