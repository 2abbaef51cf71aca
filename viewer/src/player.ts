// SPDX-License-Identifier: Apache-2.0
/** The clock of the page: time of the recording as a function of wall time. */
export class Player {
  t: number;
  playing = false;
  speed = 1;
  loop = true;
  private readonly listeners: (() => void)[] = [];
  constructor(readonly begin: number, readonly end: number) { this.t = begin; }
  onchange(listener: () => void): void { this.listeners.push(listener); }
  private changed(): void { for (const listener of this.listeners) listener(); }
  seek(t: number): void {
    this.t = Math.min(this.end, Math.max(this.begin, t));
    this.changed();
  }
  toggle(): void {
    if (!this.playing && this.t >= this.end) this.t = this.begin;
    this.playing = !this.playing && this.end > this.begin;
    this.changed();
  }
  advance(seconds: number): void {
    if (!this.playing) return;
    let t = this.t + seconds * this.speed;
    if (t >= this.end) {
      if (this.loop) t = this.begin + (t - this.end) % (this.end - this.begin);
      else { t = this.end; this.playing = false; }
    }
    this.t = t;
    this.changed();
  }
}
