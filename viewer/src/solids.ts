// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group, LineBasicMaterial, LineSegments, Mesh } from "three";
import type { Scene, SolidEntry } from "./data";
import { surface } from "./materials";
import type { Poses } from "./poses";

/** Cool to warm (after Moreland, "Diverging color maps for scientific visualization", 2009), in nine colours. */
const kMap = ["#3b4cc0", "#6282ea", "#8db0fe", "#b8d0f9", "#dddddd", "#f5c4ad", "#f49a7b", "#de604d", "#b40426"].map((c) => new Color(c));

export function mapped(x: number, out: Color): Color {
  const at = Math.min(0.9999, Math.max(0, x)) * (kMap.length - 1), k = Math.floor(at);
  return out.lerpColors(kMap[k], kMap[k + 1], at - k);
}

interface Choice { label: string; field: number; component: number }  // component −1: size
interface Own { entry: SolidEntry; reference: Float32Array; displacement: Float32Array | null; mesh: Mesh; lines: LineSegments; geometry: BufferGeometry }

const kTensor = ["xx", "yy", "zz", "xy", "yz", "xz"];

/** Deformable solids with a nodal field in colours. */
export class Solids {
  readonly group = new Group();
  readonly choices: Choice[] = [];
  readonly hidden: boolean[];
  choice = -1;
  range: [number, number] = [0, 1];
  fixedRange = false;
  enlarge = 1;
  plain = "#5b8bb8";
  private readonly own: Own[] = [];
  private fields: (Float32Array | null)[] = [];

  private constructor(private readonly scene: Scene, private readonly poses: Poses) {
    this.hidden = scene.manifest.solids.map(() => false);
    const first = scene.manifest.solids[0];
    first?.fields.forEach((field, k) => {
      if (field.size === 1) this.choices.push({ label: field.name, field: k, component: -1 });
      else {
        const parts = field.size === 6 ? kTensor : ["x", "y", "z"];
        if (field.size === 3) this.choices.push({ label: `${field.name} (size)`, field: k, component: -1 });
        parts.forEach((part, c) => this.choices.push({ label: `${field.name} ${part}`, field: k, component: c }));
      }
    });
  }
  get unit(): string { return this.choice < 0 ? "" : this.scene.manifest.solids[0].fields[this.choices[this.choice].field].unit; }

  static async of(scene: Scene, poses: Poses): Promise<Solids> {
    const solids = new Solids(scene, poses);
    for (const [index, entry] of scene.manifest.solids.entries()) await solids.add(entry, index);
    const mises = solids.choices.findIndex((c) => c.label === "von_mises");
    await solids.choose(mises >= 0 ? mises : solids.choices.length - 1);
    return solids;
  }

  private async add(entry: SolidEntry, index: number): Promise<void> {
    const reference = await this.scene.floats(entry.reference);
    const moved = entry.fields.find((f) => f.name === "displacement");
    const displacement = moved ? await this.scene.floats(moved.data) : null;
    const geometry = new BufferGeometry();
    const points = new BufferAttribute(new Float32Array(reference), 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", points);
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(reference.length), 3).setUsage(DynamicDrawUsage));
    geometry.setIndex(new BufferAttribute(await this.scene.integers(entry.triangles), 1));
    const mesh = new Mesh(geometry, surface({ vertexColors: true, side: DoubleSide, roughness: 0.7, flatShading: false,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    const outline = new BufferGeometry();
    outline.setAttribute("position", points);
    outline.setIndex(new BufferAttribute(await this.scene.integers(entry.edges), 1));
    const lines = new LineSegments(outline, new LineBasicMaterial({ color: 0x101820, transparent: true, opacity: 0.45 }));
    for (const object of [mesh, lines]) object.frustumCulled = false;
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.userData = { pick: () => ({ kind: "solid", index }) };
    this.group.add(mesh, lines);
    this.own.push({ entry, reference, displacement, mesh, lines, geometry });
  }

  async choose(choice: number): Promise<void> {
    this.choice = choice;
    if (choice < 0) return;
    const { field } = this.choices[choice];
    this.fields = await Promise.all(this.own.map(({ entry }) => (entry.fields[field] ? this.scene.floats(entry.fields[field].data) : null)));
    if (!this.fixedRange) this.range = this.fullRange();
  }

  /** Range of nearly all values of all frames: the highest half per cent, peaks at edges, are left out unless `peaks`. */
  fullRange(peaks = false): [number, number] {
    const all: number[] = [];
    this.own.forEach(({ entry }, s) => {
      const data = this.fields[s], size = this.width(entry);
      if (!data) return;
      const count = data.length / size, step = Math.max(1, Math.floor(count / 200000));
      for (let i = 0; i < count; i += step) {
        const v = this.value(data, i, size);
        if (Number.isFinite(v)) all.push(v);
      }
    });
    if (all.length === 0) return [0, 1];
    const sorted = Float64Array.from(all).sort(), cut = peaks ? 0 : Math.floor(0.005 * sorted.length);
    const low = sorted[0] >= 0 ? 0 : sorted[cut], high = sorted[sorted.length - 1 - cut];
    return [low, high > low ? high : low + 1e-30];
  }
  private width(entry: SolidEntry): number { return entry.fields[this.choices[this.choice].field].size; }
  private value(data: Float32Array, i: number, size: number): number {
    const { component } = this.choices[this.choice];
    if (size === 1) return data[i];
    if (component >= 0) return data[size * i + component];
    let sum = 0;
    for (let k = 0; k < size; k++) sum += data[size * i + k] ** 2;
    return Math.sqrt(sum);
  }

  /** Value and place of the node nearest to a point of a picked face. */
  nodeValue(solid: number, shown: number): { node: number; value: number } {
    const own = this.own[solid], data = this.fields[solid];
    const n = own.entry.shown.length;
    return { node: own.entry.shown[shown], value: data ? this.value(data, this.poses.frame * n + shown, this.width(own.entry)) : NaN };
  }

  box(out: { expandByPoint(p: { x: number; y: number; z: number }): unknown }): void {
    for (const { geometry } of this.own) {
      const p = geometry.getAttribute("position").array;
      for (let i = 0; i < p.length; i += 3) out.expandByPoint({ x: p[i], y: p[i + 1], z: p[i + 2] });
    }
  }

  update(): void {
    const colour = new Color(), { frame, part } = this.poses;
    this.own.forEach(({ entry, reference, displacement, mesh, lines, geometry }, s) => {
      mesh.visible = lines.visible = !this.hidden[s];
      if (this.hidden[s]) return;
      const points = geometry.getAttribute("position") as BufferAttribute, at = points.array, width = reference.length;
      if (displacement) {
        const a = frame * width, b = part > 0 ? a + width : a;
        for (let i = 0; i < width; i++)
          at[i] = reference[i] + this.enlarge * ((1 - part) * displacement[a + i] + part * displacement[b + i]);
        points.needsUpdate = true;
      }
      geometry.computeVertexNormals();
      geometry.boundingSphere = null;
      const colours = geometry.getAttribute("color") as BufferAttribute, data = this.fields[s], n = entry.shown.length;
      const size = data ? this.width(entry) : 1, [low, high] = this.range;
      for (let i = 0; i < n; i++) {
        if (data) {
          const now = this.value(data, frame * n + i, size), next = part > 0 ? this.value(data, (frame + 1) * n + i, size) : now;
          mapped((now + part * (next - now) - low) / (high - low), colour);
        } else colour.set(this.plain);
        colours.setXYZ(i, colour.r, colour.g, colour.b);
      }
      colours.needsUpdate = true;
    });
  }
}
