// SPDX-License-Identifier: Apache-2.0
// The panel beside the picture: objects, display options, the model file.
import { Color, Plane, Vector3 } from "three";
import type { Scene } from "./data";
import { figure, h } from "./dom";
import { valuesAt } from "./poses";
import { quantitiesOf, seriesOf } from "./series";
import { mapped } from "./solids";
import { largest, prefixed } from "./units";
import type { Choice, View } from "./view";

export interface Actions { choose(choice: Choice | null): void; plot(name: string): void; refresh(): void }

interface Named extends Choice { name: string; about: string; line?: number }

export function objectsOf(scene: Scene): Named[] {
  const m = scene.manifest, list: Named[] = [];
  m.bodies.forEach((b, index) => { if (!b.node) list.push({ kind: "body", index, name: b.name, about: b.fixed ? "fixed body" : `body, ${figure(b.mass ?? NaN)} kg`, line: b.line }); });
  m.joints.forEach((j, index) => list.push({ kind: "joint", index, name: j.name, about: `${j.type ?? ""} joint`, line: j.line }));
  m.loads.forEach((l, index) => list.push({ kind: "load", index, name: l.name, about: l.type.replaceAll("_", " "), line: l.line }));
  m.solids.forEach((s, index) => list.push({ kind: "solid", index, name: s.name, about: `solid, ${s.elements} elements, ${s.nodes} nodes` }));
  m.beams.forEach((b, index) => list.push({ kind: "beam", index, name: b.name, about: `beam, section ${b.section ?? ""}`, line: b.line }));
  m.cables.forEach((c, index) => list.push({ kind: "cable", index, name: c.name, about: "cable", line: c.line }));
  m.contacts.forEach((name, index) => list.push({ kind: "contact", index, name, about: "contact" }));
  return list;
}

const kShownMost = 250;

/** Objects by name, with a search; the selected one with its values and its line of the model file. */
export class ObjectPanel {
  readonly element: HTMLElement;
  private readonly all: Named[];
  private readonly list = h("ul", { class: "objects", "aria-label": "Objects" });
  private readonly more = h("p", { class: "faint" });
  private readonly search: HTMLInputElement;
  private readonly details = h("div", { class: "details", "aria-live": "off" });
  private cells: { cell: HTMLElement; at: (frame: number, part: number) => string }[] = [];
  private shown: Choice | null = null;

  constructor(private readonly scene: Scene, private readonly view: View, private readonly actions: Actions) {
    this.all = objectsOf(scene);
    this.search = h("input", { type: "search", placeholder: "Search by name", "aria-label": "Search objects by name", oninput: () => this.fill() });
    this.element = h("div", { class: "panel" }, this.details, this.search, this.list, this.more);
    this.fill();
    void this.choose(null);
  }
  focus(): void { this.search.focus(); }

  private fill(): void {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = this.all.filter((o) => words.every((w) => `${o.name} ${o.about}`.toLowerCase().includes(w)));
    this.list.replaceChildren(...found.slice(0, kShownMost).map((o) => {
      const same = this.shown?.kind === o.kind && this.shown.index === o.index;
      return h("li", {}, h("button", { type: "button", class: "object", "aria-pressed": String(same), onclick: () => this.actions.choose({ kind: o.kind, index: o.index }) },
        h("b", {}, o.name), h("span", { class: "faint" }, ` ${o.about}`)));
    }));
    this.more.textContent = found.length > kShownMost ? `and ${found.length - kShownMost} more: search` : found.length === 0 ? "No object has this name." : "";
  }

  async choose(choice: Choice | null): Promise<void> {
    this.shown = choice;
    this.cells = [];
    this.fill();
    const object = choice && this.all.find((o) => o.kind === choice.kind && o.index === choice.index);
    if (!choice || !object) {
      this.details.replaceChildren(h("p", { class: "faint" }, "Click a body, joint or arrow, or a name below."));
      return;
    }
    const buttons = h("div", { class: "buttons" });
    const button = (label: string, act: () => void) => buttons.append(h("button", { type: "button", onclick: () => { act(); this.actions.refresh(); } }, label));
    if (choice.kind === "body") {
      const next = (s: "ghost" | "hidden") => () => this.view.show(choice.index, this.view.bodies.showing[choice.index] === s ? "shown" : s);
      button("Hide", next("hidden"));
      button("Ghost", next("ghost"));
      button("Isolate", () => this.view.isolate(choice.index));
    }
    if (choice.kind === "solid") button("Hide", () => { this.view.solids.hidden[choice.index] = !this.view.solids.hidden[choice.index]; this.view.update(); });
    if (!this.view.boxOf(choice).isEmpty()) button("Fit", () => this.view.fit());
    if (this.view.placeOf(choice)) button(this.view.follow ? "Do not follow" : "Follow", () => { this.view.setFollow(!this.view.follow); void this.choose(choice); });
    button("Show all", () => this.view.showAll());
    const table = h("table", {}, h("caption", { class: "hidden" }, `Values of ${object.name}`));
    const mark = choice.kind === "joint" ? this.scene.manifest.joints[choice.index].mark : choice.kind === "body" ? this.scene.manifest.bodies[choice.index].mark : undefined;
    this.details.replaceChildren(h("h2", {}, object.name), h("p", { class: "faint" }, object.about), ...(mark ? [h("p", { class: "warn" }, mark)] : []), buttons, table, this.source(object));
    const rows: HTMLElement[] = [];
    for (const name of quantitiesOf(this.scene, choice.kind, object.name)) {
      const series = await seriesOf(this.scene, name);
      if (series.length === 0 || this.shown !== choice) continue;
      const units = [...new Set(series.map((s) => s.unit))], { unit, factor } = units.length === 1 ? prefixed(units[0], largest(series.map((s) => s.values))) : { unit: units.join(", "), factor: 1 };
      const short = name.slice(name.lastIndexOf(".") + 1).replaceAll("_", " "), cell = h("td", { class: "number" });
      this.cells.push({ cell, at: (f, part) => series.map((s) => figure(factor * valuesAt(s.values as unknown as Float32Array, 1, 0, 1, f, part)[0])).join("  ") });
      rows.push(h("tr", {}, h("th", { scope: "row" }, short), cell, h("td", { class: "faint" }, unit === "-" ? "" : unit),
        h("td", {}, h("button", { type: "button", title: `Plot ${short}`, "aria-label": `Plot ${short} of ${object.name}`, onclick: () => this.actions.plot(name) }, "∿"))));
    }
    if (this.shown !== choice) return;
    table.append(h("tbody", {}, ...rows));
    this.tick();
  }

  private source(object: Named): HTMLElement {
    const lines = this.scene.manifest.source.text.split("\n");
    const group = { body: "bodies", joint: "joints", load: "loads", solid: "solids", beam: "beams", cable: "cables", contact: "contacts" }[object.kind];
    let at = object.line ?? 0;
    if (!at) {
      const from = lines.findIndex((l) => l.startsWith(`${group}:`));
      at = from < 0 ? 0 : lines.findIndex((l, i) => i > from && l.trim().startsWith(`${object.name}:`)) + 1;
    }
    if (at < 1 || at > lines.length) return h("p", {});
    return h("figure", {}, h("figcaption", { class: "faint" }, `${this.scene.manifest.source.file}, line ${at}`), h("pre", { tabindex: 0 }, lines.slice(at - 1, at + 3).join("\n")));
  }

  tick(): void { for (const { cell, at } of this.cells) cell.textContent = at(this.view.poses.frame, this.view.poses.part); }
}

/** Switches and sliders of the picture. */
export function displayPanel(view: View, refresh: () => void, theme: (dark: boolean) => void): HTMLElement {
  const update = () => { view.update(); refresh(); };
  const check = (label: string, on: boolean, act: (on: boolean) => void) => {
    const input = h("input", { type: "checkbox", checked: on, onchange: () => { act(input.checked); update(); } });
    return h("label", { class: label.startsWith("Ghost of ") ? "ghost" : label.startsWith("Side by side") ? "beside" : undefined }, input, ` ${label}`);
  };
  const slide = (label: string, low: number, high: number, value: number, act: (x: number) => void) => {
    const input = h("input", { type: "range", min: low, max: high, step: (high - low) / 200, value, "aria-label": label, oninput: () => { act(input.valueAsNumber); update(); } });
    return h("label", { class: "slide" }, h("span", {}, label), input);
  };
  const m = view.scene.manifest, { contacts, reactions, loads } = view.forces;
  const all = [contacts, reactions, loads].filter((f) => f !== null);
  const part = (title: string, ...rows: (HTMLElement | null)[]) => h("fieldset", {}, h("legend", {}, title), ...rows);
  const sides = view.stage.sides();
  const look = (label: string, key: string, d: Vector3) => h("button", { type: "button", title: `${label} (${key})`, onclick: () => { view.stage.view(d.clone()); refresh(); } }, label);
  const camera = part("Camera", h("div", { class: "buttons" }, look("Front", "1", sides[1].clone().negate()), look("Side", "2", sides[0]), look("Top", "3", view.stage.up.clone().addScaledVector(sides[1], -1e-3)),
    look("Oblique", "4", new Vector3().addScaledVector(sides[0], 0.45).addScaledVector(sides[1], -0.85).addScaledVector(view.stage.up, 0.42)), look("First", "0", view.stage.firstLook())),
    check("Parallel projection (o)", false, (on) => view.stage.setParallel(on)));
  const sectionAxis = h("select", { "aria-label": "Section plane", onchange: () => section() }, ...["none", "x", "y", "z"].map((a) => h("option", { value: a }, a === "none" ? "No section" : `Across ${a}`)));
  let offset = 0;
  const section = () => {
    const k = ["x", "y", "z"].indexOf(sectionAxis.value), plane = view.stage.section as Plane;
    plane.normal.set(0, 0, 0);
    if (k >= 0) plane.normal.setComponent(k, -1);
    plane.constant = k >= 0 ? view.stage.controls.target.getComponent(k) + offset * view.stage.size : 0;
    if (view.stage.renderer) view.stage.renderer.clippingPlanes = k >= 0 ? [plane] : [];
    view.bodies.setOpen(k >= 0);
    update();
  };
  const shadows = check("Shadows", view.stage.shadows, (on) => { view.shadowsAsked = true; view.setShadows(on); });
  view.onshadows = () => { (shadows.firstChild as HTMLInputElement).checked = view.stage.shadows; };
  return h("div", { class: "panel" }, camera,
    part("Show", view.ghost ? check(`Ghost of ${view.ghost.name} (c)`, true, (on) => view.showGhost(on)) : null, view.ghost ? check(`Side by side with ${view.ghost.name} (v)`, false, (on) => void view.setBeside(on).then(update)) : null, check("Bodies as ghosts", false, (on) => { view.bodies.plain = on; }), check("Joints", true, (on) => { view.joints.group.visible = on; }),
      check("Springs and motors", true, (on) => { view.loads.group.visible = on; }), check("Ground grid", true, (on) => { view.stage.grid.visible = on; }), check("World axes", true, (on) => { view.stage.axes.visible = on; }), check("Edges and outlines", true, (on) => view.setEdges(on)), shadows,
      check("Trails", false, (on) => view.setTrails(on)), check("Centres of mass", false, (on) => { view.centres.visible = on; }), check("Body axes", false, (on) => { view.frames.visible = on; }),
      m.joints.length > 0 ? slide("Size of joints", 0.1, 5, 1, (x) => { view.joints.scale = view.loads.scale = x; }) : null),
    all.length > 0 ? part("Forces", contacts ? check("Contact forces", true, (on) => { contacts.group.visible = on; }) : null, reactions ? check("Reactions of joints", false, (on) => { reactions.group.visible = on; }) : null,
      loads ? check("Applied and spring forces", true, (on) => { loads.group.visible = on; }) : null, slide("Length of arrows", 0.1, 5, 1, (x) => all.forEach((f) => { f.scale = x; })),
      slide("Smallest shown, relative to the largest", 0, 0.5, 0.01, (x) => all.forEach((f) => { f.threshold = x; }))) : null,
    m.bodies.some((b) => !b.fixed) ? helicalPart(view, part, update) : null, m.solids.length > 0 ? solidPart(view, part, slide, update) : null,
    part("Section", sectionAxis, slide("Position of the section", -0.5, 0.5, 0, (x) => { offset = x; section(); })),
    part("Page", check("Dark", document.documentElement.dataset.theme === "dark", theme)));
}

/** Choice of the two bodies of a helical axis, and its present values. */
function helicalPart(view: View, part: (title: string, ...rows: HTMLElement[]) => HTMLElement, update: () => void): HTMLElement {
  const list = view.scene.manifest.bodies.map((b, i) => ({ ...b, i })).filter((b) => !b.node), options = (first: string, all: typeof list) => [h("option", { value: -1 }, first), ...all.slice(0, 2000).map((b) => h("option", { value: b.i }, b.name))];
  const choose = () => void view.helical.choose(Number(body.value), Number(from.value)).then(update);
  const body = h("select", { "aria-label": "Body of the helical axis", onchange: choose }, ...options("none", list.filter((b) => !b.fixed)));
  const from = h("select", { "aria-label": "Helical axis relative to", onchange: choose }, ...options("ground", list));
  const text = h("p", { class: "faint helical", role: "status" });
  view.onupdate = () => {
    const { now, group } = view.helical;
    text.textContent = !group.visible ? "" : !now ? "The bodies have no relative rotation." : `${figure(now.rate)} rad/s about ${now.along.toArray().map((x) => x.toFixed(3)).join(", ")} through ${now.point.toArray().map((x) => x.toFixed(4)).join(", ")} m; pitch ${figure(now.pitch)} m/rad`;
  };
  return part("Helical axis", h("label", {}, "of ", body), h("label", {}, "relative to ", from), text);
}

function solidPart(view: View, part: (title: string, ...rows: HTMLElement[]) => HTMLElement, slide: (l: string, a: number, b: number, v: number, act: (x: number) => void) => HTMLElement, update: () => void): HTMLElement {
  const { solids } = view;
  const low = h("input", { type: "number", step: "any", "aria-label": "Lowest value in colours" }), high = h("input", { type: "number", step: "any", "aria-label": "Highest value in colours" });
  const show = () => { low.value = String(+solids.range[0].toPrecision(4)); high.value = String(+solids.range[1].toPrecision(4)); };
  const typed = () => { solids.range = [low.valueAsNumber || 0, high.valueAsNumber || 0]; solids.fixedRange = true; update(); };
  low.addEventListener("change", typed);
  high.addEventListener("change", typed);
  const field = h("select", { "aria-label": "Field in colours", onchange: async () => { solids.fixedRange = false; await solids.choose(Number(field.value)); show(); update(); } },
    h("option", { value: -1, selected: solids.choice < 0 }, "plain"), ...solids.choices.map((c, i) => h("option", { value: i, selected: i === solids.choice }, c.label.replaceAll("_", " "))));
  show();
  return part("Solids", h("label", {}, "Colour by ", field), h("div", { class: "range" }, low, " to ", high, h("button", { type: "button", onclick: () => { solids.fixedRange = false; solids.range = solids.fullRange(true); show(); update(); } }, "Peaks")),
    slide("Displacement factor", 1, 50, 1, (x) => { solids.enlarge = x; }));
}

/** Scale of colours of solids. */
export class Legend {
  readonly element = h("div", { class: "legend", role: "img" });
  private readonly bar = h("canvas", { width: 12, height: 120 });
  private readonly text = h("div", { class: "ticks" });
  private readonly title = h("div", {});
  constructor(private readonly view: View) {
    this.element.append(this.title, h("div", { class: "scale" }, this.bar, this.text));
    const ctx = this.bar.getContext("2d"), colour = new Color();
    for (let y = 0; ctx && y < 120; y++) {
      mapped(1 - y / 119, colour);
      ctx.fillStyle = `#${colour.getHexString()}`;
      ctx.fillRect(0, y, 12, 1);
    }
    this.tick();
  }
  tick(): void {
    const { solids } = this.view, on = this.view.scene.manifest.solids.length > 0 && solids.choice >= 0;
    this.element.hidden = !on;
    if (!on) return;
    const label = solids.choices[solids.choice].label.replaceAll("_", " "), [low, high] = solids.range, { unit, factor } = prefixed(solids.unit, Math.max(Math.abs(low), Math.abs(high)));
    this.title.textContent = `${label} [${unit}]`;
    const ticks = [4, 3, 2, 1, 0].map((k) => figure(factor * (low + k / 4 * (high - low))));
    if (this.text.textContent !== ticks.join("")) this.text.replaceChildren(...ticks.map((s) => h("span", {}, s)));
    this.element.setAttribute("aria-label", `Colours: ${label} from ${figure(factor * low)} to ${figure(factor * high)} ${unit}`);
  }
}
