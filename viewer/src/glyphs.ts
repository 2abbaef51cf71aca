// SPDX-License-Identifier: Apache-2.0
// Joints by kind, springs, motors, and arrows of forces.
import {
  BufferGeometry, CatmullRomCurve3, Color, ConeGeometry, CylinderGeometry, DoubleSide, Group, InstancedMesh, Matrix4, Quaternion, TorusGeometry, TubeGeometry, Vector3,
} from "three";
import { quaternion } from "./bodies";
import type { JointEntry, LoadEntry, Scene, Triple } from "./data";
import { alongZ, jointShape, kLinks, merged } from "./joint_shapes";
import { surface } from "./materials";
import { valuesAt, type Poses } from "./poses";

const kNothing = new Matrix4().makeScale(0, 0, 0);
const kZ = new Vector3(0, 0, 1);

/** A coil along z from 0 to 1, of radius 1. Springs are about 20 times as long as wide, so their wire is thin along z. */
function coil(): BufferGeometry {
  const turns = 9, long = 20, points: Vector3[] = [new Vector3(0, 0, 0), new Vector3(0, 0, 0.06 * long)];
  for (let i = 0; i <= 12 * turns; i++) {
    const a = 2 * Math.PI * i / 12;
    points.push(new Vector3(Math.cos(a), Math.sin(a), long * (0.1 + 0.8 * i / (12 * turns))));
  }
  points.push(new Vector3(0, 0, 0.94 * long), new Vector3(0, 0, long));
  return new TubeGeometry(new CatmullRomCurve3(points), 30 * turns, 0.13, 6).scale(1, 1, 1 / long);
}

class Glyphs {
  readonly mesh: InstancedMesh;
  constructor(geometry: BufferGeometry, colour: string, readonly indices: number[], kind: string) {
    this.mesh = new InstancedMesh(geometry, surface({ color: colour, roughness: 0.5, side: DoubleSide }), indices.length);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.mesh.userData = { pick: (instance: number) => ({ kind, index: indices[instance] }) };
  }
  done(): void {
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.boundingSphere = null;
  }
}

const byKind = (types: string[]): Map<string, number[]> => {
  const map = new Map<string, number[]>();
  types.forEach((type, i) => map.set(type, [...(map.get(type) ?? []), i]));
  return map;
};

/** Joints, each kind with its own shape, links with a rod between their points; those with a note are highlighted. */
export class Joints {
  readonly group = new Group();
  private readonly kinds: Glyphs[] = [];
  private readonly rods: Glyphs;
  private readonly arm: number;
  chosen = -1;
  scale = 1;
  constructor(private readonly list: JointEntry[], private readonly poses: Poses) {
    for (const [type, indices] of byKind(list.map((j) => j.type ?? ""))) {
      const own = indices.filter((i) => list[i].Za);
      if (own.length === 0) continue;
      const glyphs = new Glyphs(jointShape(type), "#ffffff", own, "joint");
      this.kinds.push(glyphs);
      this.group.add(glyphs.mesh);
    }
    const links = list.flatMap((j, i) => (kLinks.includes(j.type ?? "") && j.Za && j.Zb ? [i] : []));
    this.rods = new Glyphs(alongZ(new CylinderGeometry(0.16, 0.16, 1, 12)).translate(0, 0, 0.5), "#ffffff", links, "joint");
    this.group.add(this.rods.mesh);
    // Size of joints from the bodies that they connect.
    const arms = list.filter((j) => j.Za && j.Zb).map((j) => Math.max((j.a ?? -1) < 0 ? 0 : Math.hypot(...j.Za!), (j.b ?? -1) < 0 ? 0 : Math.hypot(...j.Zb!))).filter((x) => x > 0).sort((x, y) => x - y);
    this.arm = arms.length > 0 ? arms[arms.length >> 1] : Infinity;
    this.colours();
  }
  colours(): void {
    for (const kind of [...this.kinds, this.rods]) {
      kind.indices.forEach((j, i) => kind.mesh.setColorAt(i, new Color(j === this.chosen ? "#ffd23f" : this.list[j].mark ? "#d9822b" : "#42505c")));
      if (kind.mesh.instanceColor) kind.mesh.instanceColor.needsUpdate = true;
    }
  }
  point(index: number, out: Vector3): Vector3 {
    const joint = this.list[index];
    return this.poses.point(joint.a ?? -1, joint.Za ?? [0, 0, 0], out);
  }
  turn(index: number, out: Quaternion): Quaternion {
    const joint = this.list[index];
    return this.poses.q_of(joint.a ?? -1, out).multiply(quaternion(joint.q));
  }
  update(size: number): void {
    const matrix = new Matrix4(), at = new Vector3(), turn = new Quaternion(), scale = new Vector3().setScalar(this.scale * Math.min(0.018 * size, Math.max(0.005 * size, 0.13 * this.arm)));
    for (const kind of this.kinds) {
      kind.indices.forEach((j, i) => {
        this.point(j, at);
        this.turn(j, turn);
        kind.mesh.setMatrixAt(i, matrix.compose(at, turn, scale));
      });
      kind.done();
    }
    this.rods.indices.forEach((j, i) => {
      const { b, Zb } = this.list[j];
      this.point(j, at);
      const along = this.poses.point(b ?? -1, Zb as Triple, new Vector3()).sub(at), length = along.length();
      turn.setFromUnitVectors(kZ, along.divideScalar(length || 1));
      this.rods.mesh.setMatrixAt(i, length > 0 ? matrix.compose(at, turn, new Vector3(scale.x, scale.y, length)) : kNothing);
    });
    this.rods.done();
  }
}

/** Springs and dampers as coils and cylinders, motors and torsional springs as rings. */
export class Loads {
  readonly group = new Group();
  private readonly coils: Glyphs;
  private readonly pots: Glyphs;
  private readonly rings: Glyphs;
  private readonly jointOf: number[];
  scale = 1;
  constructor(private readonly list: LoadEntry[], joints: JointEntry[], private readonly placed: Joints, private readonly poses: Poses) {
    this.jointOf = list.map((l) => (l.joint ? joints.findIndex((j) => j.name === l.joint) : -1));
    const all = list.map((_, i) => i);
    const springs = all.filter((i) => list[i].type === "spring_damper" && list[i].Za);
    this.coils = new Glyphs(coil(), "#3d8a55", springs.filter((i) => list[i].coil), "load");
    this.pots = new Glyphs(merged(alongZ(new CylinderGeometry(0.6, 0.6, 0.4, 16)).translate(0, 0, 0.35), alongZ(new CylinderGeometry(0.16, 0.16, 1, 10)).translate(0, 0, 0.5)),
      "#7a8791", springs.filter((i) => list[i].damper), "load");
    this.rings = new Glyphs(merged(new TorusGeometry(1, 0.12, 8, 36, 5), alongZ(new ConeGeometry(0.3, 0.5, 12)).rotateX(-Math.PI / 2).rotateZ(5).translate(Math.cos(5), Math.sin(5), 0)),
      "#b3402e", all.filter((i) => this.jointOf[i] >= 0), "load");
    for (const glyphs of [this.coils, this.pots, this.rings]) this.group.add(glyphs.mesh);
  }
  update(size: number): void {
    const a = new Vector3(), b = new Vector3(), matrix = new Matrix4(), turn = new Quaternion(), d = 0.012 * size * this.scale;
    for (const glyphs of [this.coils, this.pots]) {
      glyphs.indices.forEach((l, i) => {
        const load = this.list[l];
        this.poses.point(load.a ?? -1, load.Za as Triple, a);
        this.poses.point(load.b ?? -1, load.Zb as Triple, b);
        const length = b.sub(a).length();
        turn.setFromUnitVectors(kZ, b.divideScalar(length || 1));
        glyphs.mesh.setMatrixAt(i, length > 0 ? matrix.compose(a, turn, new Vector3(d, d, length)) : kNothing);
      });
      glyphs.done();
    }
    this.rings.indices.forEach((l, i) => {
      const joint = this.jointOf[l];
      this.placed.point(joint, a);
      this.rings.mesh.setMatrixAt(i, matrix.compose(a, this.placed.turn(joint, turn), new Vector3().setScalar(2 * d)));
    });
    this.rings.done();
  }
}

/** Arrows: one instanced shaft and one instanced head. */
class Arrows {
  readonly group = new Group();
  readonly shaft: Glyphs;
  readonly head: Glyphs;
  constructor(count: number, colour: string, kind: string) {
    const all = Array.from({ length: count }, (_, i) => i);
    this.shaft = new Glyphs(alongZ(new CylinderGeometry(1, 1, 1, 10)).translate(0, 0, 0.5), colour, all, kind);
    this.head = new Glyphs(alongZ(new ConeGeometry(1, 1, 14)).translate(0, 0, 0.5), colour, all, kind);
    this.group.add(this.shaft.mesh, this.head.mesh);
    for (const { mesh } of [this.shaft, this.head]) {
      // Arrows are visible through bodies, since forces act inside them.
      Object.assign(mesh.material, { depthTest: false, transparent: true, opacity: 0.9 });
      mesh.renderOrder = 4;
      mesh.castShadow = false;
    }
  }
  begin(): void { this.shaft.mesh.count = this.head.mesh.count = 0; }
  /** Adds an arrow for the force with an index. Unused arrows cost nothing. */
  add(index: number, at: Vector3, along: Vector3, length: number, thick: number): void {
    if (!(length > 0)) return;
    const i = this.shaft.mesh.count;
    this.shaft.mesh.count = this.head.mesh.count = i + 1;
    this.shaft.indices[i] = this.head.indices[i] = index;
    const turn = new Quaternion().setFromUnitVectors(kZ, along), tip = Math.min(0.35 * length, 5 * thick);
    this.shaft.mesh.setMatrixAt(i, new Matrix4().compose(at, turn, new Vector3(thick, thick, length - tip)));
    this.head.mesh.setMatrixAt(i, new Matrix4().compose(at.clone().addScaledVector(along, length - tip), turn, new Vector3(2.4 * thick, 2.4 * thick, tip)));
  }
  done(): void { this.shaft.done(); this.head.done(); }
}

/** Forces of contacts, joints or loads, scaled to the largest of the run; small ones may be left out. */
export class Forces {
  readonly group: Group;
  private readonly arrows: Arrows;
  largest = 0;
  scale = 1;
  threshold = 0.01;
  private data: Float32Array | null = null;
  private filling = false;
  /** Called when newly loaded data are available. */
  onfilled: () => void = () => undefined;
  private constructor(private readonly count: number, private readonly width: number, private readonly source: () => Promise<Float32Array>,
    private readonly offset: (i: number) => number, private readonly place: (i: number, frame: number, part: number, out: Vector3) => Vector3,
    colour: string, kind: string) {
    this.arrows = new Arrows(count, colour, kind);
    this.group = this.arrows.group;
  }
  /** Loads the data when they are first shown, which takes long for large recordings. */
  async fill(): Promise<void> {
    if (this.filling) return;
    this.filling = true;
    const data = await this.source(), { width, count } = this, frames = width > 0 ? data.length / width : 0;
    for (let f = 0; f < frames; f++)
      for (let i = 0; i < count; i++) {
        const at = f * width + this.offset(i), size = Math.hypot(data[at], data[at + 1], data[at + 2]);
        if (size > this.largest) this.largest = size;
      }
    this.data = data;
    this.onfilled();
  }
  update(size: number, frame: number, part: number): void {
    const at = new Vector3(), force = new Vector3(), longest = 0.16 * size * this.scale;
    if (!this.data) return void this.fill();
    this.arrows.begin();
    for (let i = 0; i < this.count; i++) {
      force.fromArray(valuesAt(this.data, this.width, this.offset(i), 3, frame, part));
      const amount = force.length() / (this.largest || 1);
      if (!(amount > this.threshold)) continue;
      this.arrows.add(i, this.place(i, frame, part, at), force.normalize(), longest * amount, 0.0025 * size);
    }
    this.arrows.done();
  }

  static async contacts(scene: Scene): Promise<Forces | null> {
    const n = scene.manifest.contacts.length;
    const [force, point] = await Promise.all([scene.channel("packed/contacts/force"), scene.channel("packed/contacts/point")]);
    if (!force || !point || n === 0) return null;
    // A point jumps to the origin when a contact opens, so positions are not interpolated.
    return new Forces(n, 3 * n, async () => force, (i) => 3 * i, (i, frame, _, out) => out.fromArray(point, frame * 3 * n + 3 * i), "#c2185b", "contact");
  }
  static async reactions(scene: Scene, joints: Joints): Promise<Forces | null> {
    const n = scene.manifest.joints.length, entry = scene.entry("packed/joints/force");
    if (!entry || n === 0) return null;
    return new Forces(n, 3 * n, () => scene.floats(entry.data), (i) => 3 * i, (i, _f, _p, out) => joints.point(i, out), "#6a3fb5", "joint");
  }
  static async loads(scene: Scene, poses: Poses): Promise<Forces | null> {
    const entry = scene.entry("packed/loads/values"), values = await scene.channel("packed/loads/values");
    const loads = scene.manifest.loads.map((load, index) => ({ load, index })).filter(({ load }) => load.columns[0]?.name === "force" && load.columns[0].size === 3 && load.Zb);
    if (!entry || !values || loads.length === 0) return null;
    const forces = new Forces(loads.length, entry.data.w, async () => values, (i) => loads[i].load.first,
      (i, _f, _p, out) => poses.point(loads[i].load.b ?? -1, loads[i].load.Zb as Triple, out), "#c46a00", "load");
    for (const mesh of [forces.arrows.shaft.mesh, forces.arrows.head.mesh])
      mesh.userData = { pick: (instance: number) => ({ kind: "load", index: loads[forces.arrows.shaft.indices[instance]].index }) };
    return forces;
  }
}
