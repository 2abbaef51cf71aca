// SPDX-License-Identifier: Apache-2.0
// Sizes of the boxes of mass and inertia, which stand for bodies without shapes.
import type { Box3 } from "three";
import { Vector3 } from "three";
import type { Bodies } from "./bodies";
import type { Scene, Triple } from "./data";

/** Whether the scene has shapes or solids, which boxes of inertia would hide. */
export const shaped = ({ manifest: m }: Scene): boolean => m.solids.length > 0 || m.meshes.some((mesh) => mesh.type !== "inertia");

/** Distance of the farthest joint or load from the centre of mass of each body; 0 without any. */
function reaches(scene: Scene): number[] {
  const m = scene.manifest, far = m.bodies.map(() => 0);
  const see = (body: number | undefined, Z: Triple | undefined): void => { if (body !== undefined && body >= 0 && Z) far[body] = Math.max(far[body] ?? 0, Math.hypot(...Z)); };
  for (const { a, b, Za, Zb } of [...m.joints, ...m.loads]) { see(a, Za); see(b, Zb); }
  return far;
}

/**
 * Sizes the boxes of inertia: that of a slender link between its joints keeps its size, if no body has a shape; others, whose sizes say nothing, are
 * small. `all` is the extent of everything else. Returns whether the boxes count for the camera, as there is hardly anything else.
 */
export function sizeInertia(scene: Scene, bodies: Bodies, all: Box3): boolean {
  const size = all.isEmpty() ? 0 : all.getSize(new Vector3()).length(), boxes = bodies.inertiaBoxes();
  const far = reaches(scene), shapes = shaped(scene);
  if (size === 0 || (!shapes && boxes.length === 1 && size < 0.5 * boxes[0].diagonal)) return boxes.length > 0;
  for (const { body, diagonal, slender, local } of boxes) {
    const reach = far[body], link = !shapes && slender && diagonal < 2.4 * reach;
    if (!link) local.scale(new Vector3().setScalar(Math.min(1, (reach > 0 ? Math.min(0.8 * reach, 0.12 * size) : 0.08 * size) / diagonal)));
  }
  return false;
}
