// SPDX-License-Identifier: Apache-2.0
// The plots under the picture: side by side or below each other, at a height that the user sets.
import type { Scene } from "./data";
import { h } from "./dom";
import { type Clock, type Mode, Plot } from "./plots";
import type { Series } from "./series";

const kLowest = 110;

export class PlotArea {
  readonly element: HTMLElement;
  readonly open: Plot[] = [];
  private readonly list = h("div", { class: "plotlist" });
  private readonly grip: HTMLElement;
  private readonly stacked: HTMLButtonElement;
  private count = 0;
  private height = 0;

  /** @param changed  called when curves have come or gone */
  constructor(private readonly scene: Scene, private readonly clock: Clock, private readonly other: Scene | null, private readonly changed: () => void) {
    this.grip = h("div", { class: "grip", role: "separator", tabindex: 0, "aria-orientation": "horizontal", "aria-label": "Height of the plots", title: "Drag to resize the plots" });
    this.stacked = h("button", { type: "button", "aria-pressed": "false", title: "Plots below each other", onclick: () => this.stack(!this.list.classList.contains("stacked")) }, "Stack");
    this.element = h("section", { class: "plots", "aria-label": "Plots", hidden: true }, h("div", { class: "plothead" }, this.grip, this.stacked), this.list);
    this.grip.addEventListener("pointerdown", (e) => {
      e.preventDefault();
      this.grip.setPointerCapture(e.pointerId);
      const from = e.clientY, high = this.element.offsetHeight, move = (m: PointerEvent): void => this.resize(high + from - m.clientY);
      this.grip.addEventListener("pointermove", move);
      const end = (): void => this.grip.removeEventListener("pointermove", move);
      for (const name of ["pointerup", "pointercancel"]) this.grip.addEventListener(name, end, { once: true });
    });
    this.grip.addEventListener("keydown", (e) => {
      const by = { ArrowUp: 24, ArrowDown: -24 }[e.key];
      if (!by) return;
      e.preventDefault();
      e.stopPropagation();
      this.resize(this.element.offsetHeight + by);
    });
    this.describe();
  }

  private resize(height: number): void {
    this.height = Math.round(Math.min(0.8 * innerHeight, Math.max(kLowest, height)));
    this.element.style.height = `${this.height}px`;
    this.describe();
  }
  private describe(): void {
    const most = Math.round(0.8 * innerHeight);
    for (const [key, value] of [["valuemin", kLowest], ["valuemax", most], ["valuenow", Math.min(most, this.height || 230)]]) this.grip.setAttribute(`aria-${key}`, String(value));
  }

  private stack(on: boolean): void {
    this.list.classList.toggle("stacked", on);
    this.stacked.setAttribute("aria-pressed", String(on));
    // Room for two plots below each other, if nobody has chosen another height.
    if (on && !this.height && this.open.length > 1) this.resize(Math.min(0.5 * innerHeight, 190 * this.open.length));
  }

  openPlot(names: string[], mode: Mode = "time"): void {
    const plot = new Plot(this.scene, this.clock, names, ++this.count, (p) => {
      this.open.splice(this.open.indexOf(p), 1);
      p.element.remove();
      this.refresh();
    }, this.changed, mode, this.other);
    this.open.push(plot);
    this.list.append(plot.element);
    this.refresh();
  }
  private refresh(): void {
    this.element.hidden = this.open.length === 0;
    this.stacked.hidden = this.open.length < 2;
    this.changed();
  }

  async add(name: string, own: boolean): Promise<void> {
    const last = this.open[this.open.length - 1];
    if (own || !last) this.openPlot([name]); else await last.add(name);
  }
  /** All curves of the plots. */
  curves(): Series[] { return this.open.flatMap((plot) => plot.curves()); }
  toggle(): void { this.element.hidden = !this.element.hidden; }
  tick(): void { for (const plot of this.open) plot.tick(); }
  redraw(): void { for (const plot of this.open) plot.redraw(); }
}
