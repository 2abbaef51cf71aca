// SPDX-License-Identifier: Apache-2.0
// Camera, time and selection in the address, so that a link shows the same picture.
import type { Player } from "./player";
import type { Choice, View } from "./view";

const round = (x: number): string => String(+x.toPrecision(5));

export function bookmarkOf(view: View, player: Player): string {
  const { camera, controls, parallel } = view.stage, p = camera.position, c = controls.target;
  const parts = [`t=${round(player.t)}`, `eye=${[p.x, p.y, p.z].map(round).join(",")}`, `at=${[c.x, c.y, c.z].map(round).join(",")}`];
  if (camera === parallel) parts.push(`zoom=${round(parallel.zoom)}`);
  if (view.chosen) parts.push(`chosen=${view.chosen.kind},${view.chosen.index}`);
  return `#${parts.join("&")}`;
}

/** Sets camera and time from the address; returns its selection. */
export function follow(hash: string, view: View, player: Player): Choice | null {
  const values = new Map(hash.slice(1).split("&").map((part) => { const [key, ...rest] = part.split("="); return [key, rest.join("=")] as const; }));
  const triple = (key: string): [number, number, number] | null => {
    const numbers = (values.get(key) ?? "").split(",").map(Number);
    return numbers.length === 3 && numbers.every(Number.isFinite) ? [numbers[0], numbers[1], numbers[2]] : null;
  };
  const eye = triple("eye"), at = triple("at"), { stage } = view;
  if (values.has("zoom")) {
    stage.setParallel(true);
    stage.parallel.zoom = Number(values.get("zoom")) || 1;
    stage.parallel.updateProjectionMatrix();
  }
  if (eye && at) {
    stage.looking = null;
    stage.controls.target.set(...at);
    stage.camera.position.set(...eye);
    stage.controls.update();
  }
  const t = Number(values.get("t"));
  if (values.has("t") && Number.isFinite(t)) player.seek(t);
  const [kind, index] = (values.get("chosen") ?? "").split(",");
  return kind && Number.isInteger(Number(index)) ? { kind: kind as Choice["kind"], index: Number(index) } : null;
}
