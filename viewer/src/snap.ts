// SPDX-License-Identifier: Apache-2.0
// Points that measuring snaps to: corners and middles of edges of bodies, their centres of mass, joints, nodes of solids.
import { Vector3 } from "three";
import type { Choice, View } from "./view";

/** A point that moves with its object; `what` names it if it was snapped to. */
export interface Spot { choice: Choice; what: string; at: () => Vector3 }
interface Hit { choice: Choice; point: Vector3; node: number }

const kNear = 12;     // pixels
const kMost = 20000;  // edge points that are looked at where the cursor meets nothing

/** The spot under the cursor: the nearest special point within some pixels, otherwise the point that was met; null if there is neither. */
export function spotAt(view: View, x: number, y: number, hit: Hit | null): Spot | null {
  const { poses, bodies, joints, scene, stage } = view, m = scene.manifest, found: { spot: Spot; far: number; deep: number; through: boolean }[] = [];
  const offer = (choice: Choice, what: string, at: () => Vector3, through = false): void => {
    const place = at(), p = stage.pixel(place), far = p ? Math.hypot(p.x - x, p.y - y) : Infinity;
    if (far < kNear) found.push({ spot: { choice, what, at }, far: Math.round(far / 2), deep: place.distanceTo(stage.camera.position), through });
  };
  const onBody = (index: number): void => {
    const choice: Choice = { kind: "body", index }, { name } = m.bodies[index];
    for (const { local, what } of bodies.specialPoints(index)) offer(choice, `${what} of ${name}`, () => poses.point(index, local.toArray(), new Vector3()));
    if (!m.bodies[index].fixed) offer(choice, `centre of mass of ${name}`, () => poses.r_of(index, new Vector3()), true);
  };
  if (hit?.choice.kind === "body") onBody(hit.choice.index);
  else if (!hit && bodies.specialCount < kMost) m.bodies.forEach((_, i) => { if (bodies.showing[i] === "shown") onBody(i); });
  if (hit?.choice.kind === "solid" && hit.node >= 0) {
    const { index } = hit.choice, node = view.solids.shownNode(index, hit.node);
    offer(hit.choice, `a node of ${m.solids[index].name}`, () => view.solids.node(index, node, new Vector3()), true);
  }
  if (joints.group.visible) m.joints.forEach((joint, index) => { if (joint.Za) offer({ kind: "joint", index }, joint.name, () => joints.point(index, new Vector3()), true); });
  found.sort((a, b) => a.far - b.far || a.deep - b.deep);  // the nearest of several points behind one another
  for (const { spot, through } of found) if (through || view.sees(spot.at())) return spot;
  if (!hit) return null;
  const { choice, point } = hit, body = choice.kind === "body" ? choice.index : -1;
  const local = point.clone().sub(poses.r_of(body, new Vector3())).applyQuaternion(poses.q_of(body, stage.camera.quaternion.clone()).invert()).toArray();
  return { choice, what: "", at: () => poses.point(body, local, new Vector3()) };
}
