// SPDX-License-Identifier: Apache-2.0
// A second recording, drawn as a ghost over the first one at the same time.
import { type Box3, Color, Group, Mesh, type Object3D } from "three";
import { Bodies } from "./bodies";
import type { Scene } from "./data";
import { Joints, Loads } from "./glyphs";
import { shaped, sizeInertia } from "./inertia";
import { Lines } from "./lines";
import type { Surface } from "./materials";
import { Poses } from "./poses";
import { Solids } from "./solids";
import type { View } from "./view";

const kTint = "#e8590c";
const kOpacity = 0.42;

function faint(object: Object3D, on: boolean): void {
  object.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    const material = part.material as Surface;
    material.transparent = on;
    material.opacity = on ? kOpacity : 1;
    material.depthWrite = !on;
    material.polygonOffset = true;
    material.polygonOffsetFactor = material.polygonOffsetUnits = on ? 4 : 1;  // behind the same surface of the first recording
    material.needsUpdate = true;
    part.castShadow = part.receiveShadow = !on;
  });
}

export class Ghost {
  readonly group = new Group();
  private constructor(readonly scene: Scene, readonly name: string, private readonly poses: Poses, private readonly bodies: Bodies, private readonly solids: Solids,
    private readonly lines: Lines, private readonly joints: Joints, private readonly loads: Loads) {}
  private size = 1;
  private alone = false;

  /** @param view  the recording that it is compared with: objects of equal names have equal colours, and lines equal widths. */
  static async of(scene: Scene, name: string, view: View): Promise<Ghost> {
    const m = scene.manifest, poses = await Poses.of(scene), bodies = await Bodies.of(scene, poses), solids = await Solids.of(scene, poses);
    const lines = await Lines.of(scene, poses, () => view.width);
    const joints = new Joints(m.joints, poses), ghost = new Ghost(scene, name, poses, bodies, solids, lines, joints, new Loads(m.loads, m.joints, joints, poses));
    const first = view.scene, places = new Map(first.manifest.bodies.map((body, i) => [body.name, i]));
    m.bodies.forEach((body, i) => { bodies.hues[i] = places.get(body.name) ?? first.manifest.bodies.length + i; });
    await ghost.setAlone(false);
    ghost.group.add(bodies.group, solids.group, lines.group, ghost.joints.group, ghost.loads.group);
    ghost.set(m.time[0]);
    return ghost;
  }

  /** Drawn as a picture of its own, beside the first recording, or as a ghost over it. */
  async setAlone(on: boolean, field = ""): Promise<void> {
    const { bodies, solids, lines } = this, m = this.scene.manifest;
    this.alone = this.joints.group.visible = this.loads.group.visible = on;
    bodies.tint = on ? null : new Color(kTint);
    bodies.plain = !on;
    // Fixed objects are the same in both; boxes of inertia would hide bodies with shapes.
    const shapes = shaped(this.scene);
    m.bodies.forEach((body, i) => {
      const part = body.parts?.[0]?.mesh, inertia = shapes && part !== undefined && m.meshes[part].type === "inertia";
      bodies.showing[i] = on ? (inertia ? "ghost" : "shown") : body.fixed || inertia ? "hidden" : "shown";
    });
    this.setFaintLight(!on);
    bodies.colours();
    solids.plain = on ? "#5b8bb8" : kTint;
    await solids.choose(on ? solids.choices.findIndex((c) => c.label === field) : -1);
    for (const group of [solids.group, lines.group]) faint(group, !on);
  }
  setRange(range: [number, number]): void { this.solids.range = range; this.solids.fixedRange = true; }
  setShadows(on: boolean): void { this.bodies.setShadows(on); }
  setFaintLight(on: boolean): void { this.bodies.setGhostLook(on ? kOpacity : 0.16, on ? kTint : "#101820", on ? 1 : 0.3, on); }
  setEdges(on: boolean): void { this.bodies.setEdges(on); }
  /** Objects for picking. */
  get objects(): Object3D[] { return [this.bodies.group, this.solids.group, this.lines.group]; }

  get end(): number { return this.scene.manifest.time[this.scene.manifest.time.length - 1]; }

  set(t: number): void {
    if (!this.group.visible) return;
    this.poses.set(t);
    this.bodies.update();
    this.solids.update();
    this.lines.update();
    if (!this.alone) return;
    this.joints.update(this.size);
    this.loads.update(this.size);
  }

  /** Extent of both recordings, for the size of planes and joints. */
  setSize(size: number, box: Box3): void {
    this.size = size;
    sizeInertia(this.scene, this.bodies, box);
    this.bodies.sizePlanes(size);
  }

  show(on: boolean, t: number): void {
    this.group.visible = on;
    this.set(t);
  }
}
