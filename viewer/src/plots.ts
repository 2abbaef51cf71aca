// SPDX-License-Identifier: Apache-2.0
import uPlot from "uplot";
import type { Scene } from "./data";
import { figure, h, save } from "./dom";
import { resampled, seriesOf, spectrum, type Series } from "./series";
import { largest, prefixed } from "./units";

const kColours = ["#3b7dc4", "#d1583a", "#3f9561", "#b98a1e", "#8163b8", "#2aa0a8", "#c2538f", "#7c8894"];
export type Mode = "time" | "spectrum" | "phase" | "stacked" | "difference";
/** A curve: of this recording, or of the one that it is compared with (dashed). */
interface Curve extends Series { ink: number; other: boolean }
/** What is drawn: curves in units with prefixes, each with its scale; one for each unit, with an axis of its own. */
interface Shown { x: ArrayLike<number>; label: string; curves: (Curve & { scale: string })[]; units: string[] }
const scaleOf = (k: number): string => (k === 0 ? "y" : `y${k}`);

/** Common units: factor from SI. */
const kUnits: Record<string, [string, number]> = {
  rad: ["deg", 180 / Math.PI], "rad/s": ["rpm", 30 / Math.PI], m: ["mm", 1e3], "m/s": ["mm/s", 1e3], N: ["kN", 1e-3], "N m": ["kN m", 1e-3], Pa: ["MPa", 1e-6], J: ["mJ", 1e3],
};

export interface Clock { time(): number; seek(t: number): void }

/** One diagram: several series over time with the time cursor, their spectrum, one over the other, or the difference of two recordings. */
export class Plot {
  readonly element: HTMLElement;
  private plot: uPlot | null = null;
  private series: Curve[] = [];
  private mode: Mode = "time";
  private otherUnits = false;
  private saving = false;
  private readonly now = h("div", { class: "now", hidden: true });
  private readonly field = h("div", { class: "field", role: "img" });
  private readonly legend = h("ul", { class: "series", "aria-label": "Series of this plot" });

  constructor(private readonly scene: Scene, private readonly clock: Clock, readonly names: string[], private readonly number: number, private readonly close: (plot: Plot) => void,
    private readonly changed: () => void, mode: Mode = "time", private readonly other: Scene | null = null) {
    this.mode = mode;
    const modes = h("select", { "aria-label": "Kind of plot", onchange: () => { this.mode = modes.value as Mode; this.draw(); } },
      ...(["time", "spectrum", "phase", "stacked", ...(other ? ["difference"] : [])] as Mode[]).map((m) => h("option", { value: m, selected: m === mode }, m)));
    const button = (label: string, title: string, act: () => void) => h("button", { type: "button", title, "aria-label": /\w/.test(label) ? `${label}: ${title}` : title, onclick: act }, label);
    const closing = button("✕", "Close this plot", () => this.close(this));
    closing.classList.add("close");
    this.element = h("section", { class: "plot", "aria-label": this.title },
      h("div", { class: "plotbar" }, this.legend, modes, button("unit", "Other units", () => { this.otherUnits = !this.otherUnits; this.draw(); }),
        button("1:1", "Whole range", () => this.draw()), button("CSV", "Save as CSV", () => save("plot.csv", this.csv(), "text/csv")),
        button("SVG", "Save as SVG", () => save("plot.svg", this.svg(), "image/svg+xml")), button("PNG", "Save as PNG", () => this.png()),
        closing), this.field);
    new ResizeObserver(() => this.fit()).observe(this.field);
    void this.load();
  }

  async add(name: string): Promise<boolean> {
    const found = await seriesOf(this.scene, name);
    if (found.length === 0) return false;
    if (!this.names.includes(name)) this.names.push(name);
    await this.load();
    return true;
  }

  private async load(): Promise<void> {
    const all = await Promise.all(this.names.map((name) => seriesOf(this.scene, name)));
    const own = all.flat().slice(0, 24).map((s, ink): Curve => ({ ...s, ink, other: false }));
    this.series = [...own, ...(await this.compared(own))];
    this.element.setAttribute("aria-label", this.title);
    this.field.setAttribute("aria-label", `Curves of ${this.series.map((s) => s.name).join(", ") || "nothing"} over time`);
    this.draw();
    this.changed();
  }
  /** Each plot has its number in its title, as two may show the same. */
  private get title(): string { return `Plot ${this.number} of ${this.names.join(", ")}`; }
  curves(): Series[] { return this.series; }

  /** The same quantities of the other recording, at times of this one. */
  private async compared(own: Curve[]): Promise<Curve[]> {
    if (!this.other) return [];
    const found = (await Promise.all(this.names.map((name) => seriesOf(this.other as Scene, name)))).flat();
    const from = this.other.manifest.time, to = this.scene.manifest.time;
    return own.flatMap(({ name, ink }) => {
      const one = found.find((s) => s.name === name);
      return one ? [{ ...resampled(one, from, to), name: `${name} (${this.scene.manifest.compared})`, ink, other: true }] : [];
    });
  }

  private scaled(): Curve[] {
    if (!this.otherUnits) return this.series;
    return this.series.map((s) => {
      const unit = kUnits[s.unit];
      return unit ? { ...s, unit: unit[0], values: s.values.map((v) => v * unit[1]) } : s;
    });
  }

  /** Abscissa, curves and the name of the abscissa for the present mode. */
  private table(): { x: ArrayLike<number>; label: string; curves: Curve[] } {
    const time = this.scene.manifest.time, all = this.scaled(), curves = this.mode === "phase" || this.mode === "stacked" ? all.filter((s) => !s.other) : all;
    if (this.mode === "difference")
      return { x: time, label: this.timeLabel, curves: all.filter((s) => s.other).map((s) => {
        const own = all[s.ink];
        return { ...s, name: `Δ ${own.name}`, other: false, values: s.values.map((v, i) => v - own.values[i]) };
      }) };
    if (this.mode === "spectrum" && time.length > 3) {
      const found = curves.map((s) => spectrum(time, s.values));
      return { x: found[0]?.frequency ?? [], label: "frequency [Hz]", curves: curves.map((s, i) => ({ ...s, values: found[i].amplitude })) };
    }
    if (this.mode === "phase" && curves.length > 1) return { x: curves[0].values, label: `${curves[0].name} [${curves[0].unit}]`, curves: curves.slice(1) };
    if (this.mode === "stacked") {
      const sum = new Float64Array(time.length);
      const stacked = curves.map((s) => {
        let low = Infinity;
        for (const v of s.values) if (v < low) low = v;
        // Quantities that can be negative, such as potential energies, are relative to their minimum.
        const values = s.values.map((v, i) => (sum[i] += v - Math.min(0, low)));
        return { ...s, values: Float64Array.from(values) };
      });
      return { x: time, label: this.timeLabel, curves: stacked };
    }
    return { x: time, label: this.timeLabel, curves };
  }
  private get timeLabel(): string { return this.scene.manifest.statics ? "load factor [-]" : "t [s]"; }

  private shown(): Shown {
    const { x, label, curves } = this.table(), units = [...new Set(curves.map((s) => s.unit))];
    const as = units.map((unit) => (this.otherUnits ? { unit, factor: 1 } : prefixed(unit, largest(curves.filter((s) => s.unit === unit).map((s) => s.values)))));
    return { x, label, units: as.map(({ unit }) => unit), curves: curves.map((s) => {
      const k = units.indexOf(s.unit), { unit, factor } = as[k];
      return { ...s, unit, scale: scaleOf(k), values: factor === 1 ? s.values : s.values.map((v) => v * factor) };
    }) };
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = null;
    const { x, label, curves, units } = this.shown();
    const head = (s?: Curve): string => (s ? `${s.name.slice(0, s.name.lastIndexOf(".") + 1)} ${s.unit} ${s.other}` : "");
    this.legend.replaceChildren(...curves.map((s, i) => {
      const dot = h("span", { class: s.other ? "dot other" : "dot", "aria-hidden": "true" });
      dot.style.background = kColours[s.ink % kColours.length];
      const full = `${s.name} [${s.unit}]`, cut = s.name.lastIndexOf(".");
      // Further components of the same vector show their last part only.
      if (s.other || i === 0 || head(s) !== head(curves[i - 1])) return h("li", { title: full }, dot, full);
      return h("li", { title: full }, dot, h("span", { class: "hidden" }, s.name.slice(0, cut)), s.name.slice(cut), h("span", { class: "hidden" }, ` [${s.unit}]`));
    }));
    const ink = getComputedStyle(document.documentElement).getPropertyValue("--ink").trim() || "#22303c";
    const faint = getComputedStyle(document.documentElement).getPropertyValue("--rule").trim() || "#ddd";
    const phase = this.mode === "phase" && this.series.length > 1;
    const axis = (label: string, size: number): uPlot.Axis => ({ stroke: ink, grid: { stroke: faint, width: 1 }, ticks: { stroke: faint }, label, labelSize: 18, size,
      font: "11px system-ui", labelFont: "11px system-ui" });
    // The first unit has its axis on the left, all others theirs on the right.
    const ordinates = units.map((unit, k): uPlot.Axis => ({ ...axis(`[${unit}]`, 56), scale: scaleOf(k), side: k === 0 ? 3 : 1, ...(k > 0 ? { grid: { show: false } } : {}),
      values: (_, ticks) => ticks.map((v) => (v === null ? "" : String(+v.toPrecision(6)))) }));
    const options: uPlot.Options = {
      width: Math.max(120, this.field.clientWidth), height: Math.max(90, this.field.clientHeight), mode: phase ? 2 : 1, legend: { show: false },
      cursor: { drag: { x: true, y: phase, uni: 20 }, y: false }, scales: { x: { time: false } },
      axes: [{ ...axis(label, 26) }, ...ordinates],
      series: [phase ? null as unknown as uPlot.Series : {}, ...curves.map((s): uPlot.Series => ({ label: s.name, scale: s.scale, stroke: kColours[s.ink % kColours.length], width: 1.4, points: { show: false },
        ...(s.other ? { dash: [6, 4] } : {}), ...(this.mode === "stacked" ? { fill: kColours[s.ink % kColours.length] + "55" } : {}), ...(phase ? { facets: [{ scale: "x", auto: true }, { scale: s.scale, auto: true }], paths: path } : {}) }))],
      // A layer is filled down to the one below it, the lowest down to zero.
      ...(this.mode === "stacked" ? { bands: curves.slice(1).map((_, i): uPlot.Band => ({ series: [i + 2, i + 1] })) } : {}),
      hooks: { draw: [(u) => { this.cursor(u); this.place(u); }], ready: [(u) => this.listen(u)] },
    };
    const data = phase ? [null, ...curves.map((s) => [x, s.values])] : [x, ...curves.map((s) => s.values)];
    if (curves.length > 0 && x.length > 0) this.plot = new uPlot(options, data as unknown as uPlot.AlignedData, this.field);
    this.now.remove();
    if (this.plot && !phase) this.plot.over.append(this.now);
  }

  private listen(u: uPlot): void {
    let down = 0;
    u.over.addEventListener("pointerdown", (e) => { down = e.clientX; });
    u.over.addEventListener("pointerup", (e) => {
      if (Math.abs(e.clientX - down) < 4 && this.mode !== "spectrum" && this.mode !== "phase")
        this.clock.seek(u.posToVal(e.clientX - u.over.getBoundingClientRect().left, "x"));
    });
  }

  /** The present time in pictures that are saved, and on the curves of phase plots; on the page a line over the plot shows it. */
  private cursor(u: uPlot): void {
    if (this.mode === "spectrum" || (this.mode !== "phase" && !this.saving)) return;
    const ctx = u.ctx, t = this.clock.time();
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = "#d1281e";
    ctx.lineWidth = 1.5;
    ctx.setLineDash([]);  // the last curve may have left its own
    if (this.mode === "phase" && this.series.length > 1) {
      const { x, curves } = this.shown(), time = this.scene.manifest.time;
      const f = Math.max(0, time.findIndex((s) => s >= t - 1e-12));
      for (const s of curves) {
        ctx.beginPath();
        ctx.arc(u.valToPos(x[f], "x", true), u.valToPos(s.values[f], s.scale, true), 5, 0, 7);
        ctx.fill();
      }
    } else {
      const at = u.valToPos(t, "x", true);
      if (at >= u.bbox.left && at <= u.bbox.left + u.bbox.width) {
        ctx.beginPath();
        ctx.moveTo(at, u.bbox.top);
        ctx.lineTo(at, u.bbox.top + u.bbox.height);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  /** Moves the line of the present time. Only phase plots are drawn again. */
  tick(): void {
    const u = this.plot;
    if (!u) return;
    if (this.mode === "phase") u.redraw(false); else this.place(u);
  }
  private place(u: uPlot): void {
    const at = u.valToPos(this.clock.time(), "x");
    this.now.hidden = this.mode === "spectrum" || !(at >= 0 && at <= u.over.clientWidth);
    this.now.style.transform = `translateX(${at}px)`;
  }
  redraw(): void { this.draw(); }
  private fit(): void {
    const width = this.field.clientWidth, height = this.field.clientHeight;
    if (this.plot && width > 60 && height > 60) this.plot.setSize({ width, height });
  }

  csv(): string {
    const { x, label, curves } = this.table();
    const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const rows = [[label, ...curves.map((s) => `${s.name} [${s.unit}]`)].map(quoted).join(",")];
    for (let i = 0; i < x.length; i++) rows.push([x[i], ...curves.map((s) => s.values[i])].join(","));
    return rows.join("\n") + "\n";
  }

  /** The visible range of the plot as a vector picture. */
  svg(): string {
    const { x, label, curves, units } = this.shown(), width = 640, height = 320, left = 70, right = units.length > 1 ? 70 * (units.length - 1) : 14, top = 30 + 16 * curves.length, bottom = 44;
    const u = this.plot, x0 = u?.scales.x.min ?? 0, x1 = u?.scales.x.max ?? 1, ends = (scale: string): [number, number] => [u?.scales[scale]?.min ?? 0, u?.scales[scale]?.max ?? 1];
    const px = (v: number) => left + (v - x0) / (x1 - x0 || 1) * (width - left - right);
    const py = (v: number, scale: string) => { const [y0, y1] = ends(scale); return height - bottom - (v - y0) / (y1 - y0 || 1) * (height - top - bottom); };
    const text = (a: number, b: number, s: string, more = "") => `<text x="${a.toFixed(1)}" y="${b.toFixed(1)}" ${more}>${s.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`)}</text>`;
    let out = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="12" fill="#22303c">` +
      `<rect width="100%" height="100%" fill="#fff"/><clipPath id="f"><rect x="${left}" y="${top}" width="${width - left - right}" height="${height - top - bottom}"/></clipPath>`;
    const [low, high] = ends("y");
    for (let k = 0; k <= 4; k++) {
      const vx = x0 + k / 4 * (x1 - x0), vy = low + k / 4 * (high - low);
      out += `<path d="M${px(vx).toFixed(1)} ${top}V${height - bottom}M${left} ${py(vy, "y").toFixed(1)}H${width - right}" stroke="#e3e8ec"/>` +
        text(px(vx), height - bottom + 16, figure(vx), 'text-anchor="middle"') + text(left - 6, py(vy, "y") + 4, figure(vy), 'text-anchor="end"');
      units.slice(1).forEach((_, i) => { const [y0, y1] = ends(scaleOf(i + 1)), v = y0 + k / 4 * (y1 - y0); out += text(width - right + 6 + 70 * i, py(v, scaleOf(i + 1)) + 4, figure(v)); });
    }
    units.forEach((unit, i) => { out += i === 0 ? text(left - 6, top - 8, `[${unit}]`, 'text-anchor="end"') : text(width - right + 6 + 70 * (i - 1), top - 8, `[${unit}]`); });
    curves.forEach((s, i) => {
      let d = "", pen = "M";
      for (let k = 0; k < x.length; k++) {
        if (!Number.isFinite(s.values[k])) { pen = "M"; continue; }
        d += `${pen}${px(x[k]).toFixed(2)} ${py(s.values[k], s.scale).toFixed(2)}`;
        pen = "L";
      }
      out += `<path clip-path="url(#f)" fill="none" stroke="${kColours[s.ink % kColours.length]}" stroke-width="1.4" ${s.other ? 'stroke-dasharray="6 4" ' : ""}d="${d}"/>` +
        `<rect x="${left}" y="${6 + 16 * i}" width="12" height="3" fill="${kColours[s.ink % kColours.length]}"/>` + text(left + 18, 12 + 16 * i, `${s.name} [${s.unit}]`);
    });
    return out + text((left + width) / 2, height - 8, label, 'text-anchor="middle"') + "</svg>\n";
  }

  private png(): void {
    const u = this.plot;
    if (!u) return;
    this.saving = true;
    u.redraw(false);
    // The plot is drawn in a microtask.
    setTimeout(() => {
      u.ctx.canvas.toBlob((blob) => { if (blob) save("plot.png", blob); });
      this.saving = false;
      u.redraw(false);
    });
  }
}

/** Path builder of phase plots: points joined in the order of time. */
const path: uPlot.Series.PathBuilder = (u, index) => {
  const [xs, ys] = u.data[index] as unknown as [ArrayLike<number>, ArrayLike<number>];
  const stroke = new Path2D();
  for (let i = 0; i < xs.length; i++) {
    const x = u.valToPos(xs[i], "x", true), y = u.valToPos(ys[i], "y", true);
    if (i === 0) stroke.moveTo(x, y); else stroke.lineTo(x, y);
  }
  return { stroke, fill: null, clip: null, band: null, gaps: null, flags: 0 } as unknown as uPlot.Series.Paths;
};
