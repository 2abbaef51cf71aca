// SPDX-License-Identifier: Apache-2.0
// A second recording, drawn as a ghost over the first one at the same time.
import { Color, Group, Mesh, type Object3D, Vector3 } from "three";
import { Bodies } from "./bodies";
import type { Scene } from "./data";
import { Lines } from "./lines";
import type { Surface } from "./materials";
import { Poses } from "./poses";
import { Solids } from "./solids";

const kTint = "#e8590c";
const kOpacity = 0.42;

function faint(object: Object3D): void {
  object.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    const material = part.material as Surface;
    material.transparent = true;
    material.opacity = kOpacity;
    material.depthWrite = false;
    part.castShadow = part.receiveShadow = false;
  });
}

export class Ghost {
  readonly group = new Group();
  private constructor(readonly scene: Scene, readonly name: string, private readonly poses: Poses, private readonly bodies: Bodies, private readonly solids: Solids,
    private readonly lines: Lines) {}

  static async of(scene: Scene, name: string): Promise<Ghost> {
    const m = scene.manifest, poses = await Poses.of(scene), bodies = await Bodies.of(scene, poses), solids = await Solids.of(scene, poses);
    const lines = await Lines.of(scene, poses, () => bodies.box().getSize(new Vector3()).length() || 1);
    const ghost = new Ghost(scene, name, poses, bodies, solids, lines);
    bodies.tint = new Color(kTint);
    bodies.plain = true;
    bodies.setGhostOpacity(kOpacity);
    // What never moves is in both; boxes that stand for mass alone would hide what has a shape.
    const shapes = m.solids.length > 0 || m.meshes.some((mesh) => mesh.type !== "inertia");
    m.bodies.forEach((body, i) => {
      const part = body.parts?.[0]?.mesh;
      if (body.fixed || (shapes && part !== undefined && m.meshes[part].type === "inertia")) bodies.showing[i] = "hidden";
    });
    bodies.colours();
    solids.plain = kTint;
    await solids.choose(-1);
    for (const group of [solids.group, lines.group]) faint(group);
    ghost.group.add(bodies.group, solids.group, lines.group);
    ghost.set(m.time[0]);
    return ghost;
  }

  get end(): number { return this.scene.manifest.time[this.scene.manifest.time.length - 1]; }

  set(t: number): void {
    if (!this.group.visible) return;
    this.poses.set(t);
    this.bodies.update();
    this.solids.update();
    this.lines.update();
  }

  show(on: boolean, t: number): void {
    this.group.visible = on;
    this.set(t);
  }
}
