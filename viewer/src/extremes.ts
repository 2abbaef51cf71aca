// SPDX-License-Identifier: Apache-2.0
// A table of the extremes of curves: those of the plots, of probes, and of all reactions and loads.
import type { Scene } from "./data";
import { figure, h } from "./dom";
import type { Probe } from "./probes";
import { type Series, seriesOf } from "./series";
import { prefixed } from "./units";

export interface Extremes { least: number; leastTime: number; greatest: number; greatestTime: number; mean: number; rms: number }

/** Least and greatest value with their times, mean and root mean square over time of a curve that is linear between its points, as `polhode report` has them. */
export function extremesOf(t: ArrayLike<number>, values: ArrayLike<number>): Extremes {
  const e: Extremes = { least: NaN, leastTime: NaN, greatest: NaN, greatestTime: NaN, mean: NaN, rms: NaN };
  let length = 0, sum = 0, squares = 0;
  for (let k = 0; k < values.length; k++) {
    const v = values[k], before = k > 0 ? values[k - 1] : NaN;
    if (!Number.isFinite(v)) continue;
    if (!(v >= e.least)) { e.least = v; e.leastTime = t[k]; }
    if (!(v <= e.greatest)) { e.greatest = v; e.greatestTime = t[k]; }
    if (!Number.isFinite(before)) continue;
    const dt = t[k] - t[k - 1];
    length += dt;
    sum += dt * (before + v) / 2;
    squares += dt * (before * before + before * v + v * v) / 3;
  }
  e.mean = length > 0 ? sum / length : e.least;
  e.rms = length > 0 ? Math.sqrt(squares / length) : Math.abs(e.least);
  return e;
}

/** Most rows of a table: each reaction has four. */
const kMost = 240;

export class ExtremesPanel {
  readonly element = h("div", { class: "panel extremes" });
  private readonly holder = h("div", {});
  private shown = false;

  constructor(private readonly scene: Scene, private readonly probes: Probe[], private readonly plotted: () => Series[], private readonly seek: (t: number) => void) {
    this.element.append(this.holder, h("p", { class: "faint" }, "Over the recorded frames. Click a value to go to its time."));
  }

  /** Fills the table when it is looked at: that may load what no picture needs. */
  async show(on: boolean): Promise<void> {
    this.shown = on;
    if (on) await this.refresh();
  }

  async refresh(): Promise<void> {
    if (!this.shown) return;
    const m = this.scene.manifest, sized = (name: string, parts: Series[]): Series[] => {
      if (parts.length !== 3 || !parts[2].name.endsWith(".z")) return parts;
      return [...parts, { name: `${name}.size`, unit: parts[0].unit, values: parts[0].values.map((x, i) => Math.hypot(x, parts[1].values[i], parts[2].values[i])) }];
    };
    const of = async (names: string[]): Promise<Series[]> => {
      const all: Series[] = [];
      for (const name of names) {
        if (all.length >= kMost) break;
        all.push(...sized(name, await seriesOf(this.scene, name)));
      }
      return all;
    };
    const joints = m.joints.flatMap((j) => ["force", "moment"].map((q) => `joints.${j.name}.${q}`)), loads = m.loads.flatMap((l) => l.columns.map((c) => `loads.${l.name}.${c.name}`));
    const groups: [string, Series[]][] = [["In the plots", this.plotted()], ["Probes", await of(this.probes.map((p) => p.channel))], ["Reactions of joints", await of(joints)],
      ["Loads", await of(loads)], ["Contacts", await of(m.contacts.map((c) => `contacts.${c}.normal_force`))]];
    const full = groups.filter(([, list]) => list.length > 0);
    this.holder.replaceChildren(...full.map(([title, list]) => this.table(title, list)), ...(full.length === 0 ? [h("p", { class: "faint" }, "There is nothing to list: this recording has no probes, joints, loads or plots.")] : []));
  }

  private table(title: string, list: Series[]): HTMLElement {
    const time = this.scene.manifest.time, at = (value: number, t: number, factor: number): HTMLElement => h("td", { class: "number" },
      h("button", { type: "button", class: "value", title: `At ${figure(t)}: go there`, onclick: () => this.seek(t) }, figure(value * factor), h("small", {}, ` at ${figure(t)}`)));
    const rows = list.slice(0, kMost).flatMap(({ name, unit, values }) => {
      const e = extremesOf(time, values), as = prefixed(unit, Math.max(Math.abs(e.least), Math.abs(e.greatest)));
      return [h("tr", { class: "name" }, h("th", { scope: "rowgroup", colspan: 4 }, name, h("span", { class: "faint" }, unit === "-" ? "" : ` [${as.unit}]`))),
        h("tr", {}, at(e.least, e.leastTime, as.factor), at(e.greatest, e.greatestTime, as.factor), h("td", { class: "number" }, figure(e.mean * as.factor)), h("td", { class: "number" }, figure(e.rms * as.factor)))];
    });
    return h("table", { class: "extremes" }, h("caption", {}, list.length > kMost ? `${title}, the first ${kMost} of ${list.length}` : title),
      h("thead", {}, h("tr", {}, ...["minimum", "maximum", "mean", "RMS"].map((word) => h("th", { scope: "col" }, word)))), h("tbody", {}, ...rows));
  }
}
