// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group, LineBasicMaterial, LineSegments, Mesh, type Vector3 } from "three";
import type { FieldEntry, Scene, SolidEntry } from "./data";
import { surface } from "./materials";
import type { Poses } from "./poses";

/** Cool to warm (after Moreland, "Diverging color maps for scientific visualization", 2009), in nine colours. */
const kMap = ["#3b4cc0", "#6282ea", "#8db0fe", "#b8d0f9", "#dddddd", "#f5c4ad", "#f49a7b", "#de604d", "#b40426"].map((c) => new Color(c));

export function mapped(x: number, out: Color): Color {
  const at = Math.min(0.9999, Math.max(0, x)) * (kMap.length - 1), k = Math.floor(at);
  return out.lerpColors(kMap[k], kMap[k + 1], at - k);
}

/** A field by its name, of nodes or elements; some solids may lack it. Component −1: size. */
interface Choice { label: string; name: string; of: string; unit: string; component: number }
/** Triangles with separate corners, each in the colour of its element. */
interface Cells { mesh: Mesh; corners: Uint32Array; owners: Uint32Array }
interface Own {
  entry: SolidEntry; index: number; reference: Float32Array; displacement: Float32Array | null; mesh: Mesh; lines: LineSegments; geometry: BufferGeometry; cells: Cells | null;
}

const kTensor = ["xx", "yy", "zz", "xy", "yz", "xz"];

/** Deformable solids with a field of nodes or elements in colours. */
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
    for (const { fields } of scene.manifest.solids)
      for (const { name, of = "nodes", unit, size } of fields) {
        if (this.choices.some((c) => c.name === name && c.of === of)) continue;
        const shown = of === "elements" ? `${name} by element` : name, add = (label: string, component: number) => this.choices.push({ label, name, of, unit, component });
        if (size === 1) { add(shown, -1); continue; }
        if (size === 3 && !name.startsWith("principal")) add(`${shown} (size)`, -1);
        const parts = size === 6 ? kTensor : size === 3 ? (name.startsWith("principal") ? ["largest", "middle", "smallest"] : ["x", "y", "z"]) : Array.from({ length: size }, (_, i) => `${i}`);
        parts.forEach((part, c) => add(`${shown} ${part}`, c));
      }
  }
  get unit(): string { return this.choice < 0 ? "" : this.choices[this.choice].unit; }
  /** Whether the field in colours has a value for each element. */
  private get byElement(): boolean { return this.choice >= 0 && this.choices[this.choice].of === "elements"; }

  static async of(scene: Scene, poses: Poses): Promise<Solids> {
    const solids = new Solids(scene, poses);
    for (const [index, entry] of scene.manifest.solids.entries()) await solids.add(entry, index);
    const mises = solids.choices.findIndex((c) => c.label === "von_mises"), displacement = solids.choices.findIndex((c) => c.label.startsWith("displacement"));
    await solids.choose(mises >= 0 ? mises : displacement);
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
    this.own.push({ entry, index, reference, displacement, mesh, lines, geometry, cells: null });
  }

  async choose(choice: number): Promise<void> {
    this.choice = choice;
    if (choice < 0) { this.fields = []; return; }
    const fields = this.own.map(({ entry }) => this.fieldOf(entry));
    this.fields = await Promise.all(fields.map((field) => (field ? this.scene.floats(field.data) : null)));
    if (this.byElement) for (const own of this.own) own.cells ??= await this.cellsOf(own);
    if (!this.fixedRange) this.range = this.fullRange();
  }

  private fieldOf(entry: SolidEntry): FieldEntry | undefined {
    const { name, of } = this.choices[this.choice];
    return entry.fields.find((field) => field.name === name && (field.of ?? "nodes") === of);
  }

  private async cellsOf({ entry, mesh, index }: Own): Promise<Cells | null> {
    if (!entry.owners) return null;
    const corners = await this.scene.integers(entry.triangles), owners = await this.scene.integers(entry.owners), geometry = new BufferGeometry();
    for (const name of ["position", "color"]) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * corners.length), 3).setUsage(DynamicDrawUsage));
    const own = new Mesh(geometry, mesh.material);
    own.frustumCulled = false;
    own.castShadow = own.receiveShadow = true;
    own.userData = { pick: () => ({ kind: "solid", index }) };
    this.group.add(own);
    return { mesh: own, corners, owners };
  }

  /** Range of nearly all values of all frames: without the highest half per cent, peaks at edges, unless `peaks`. */
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
    // Ranges of sizes begin at zero, unless all values are far from it, as stretches are.
    const high = sorted[sorted.length - 1 - cut], low = sorted[0] >= 0 && sorted[cut] < 0.5 * high ? 0 : sorted[cut];
    return [low, high > low ? high : low + 1e-30];
  }
  private width(entry: SolidEntry): number { return this.fieldOf(entry)?.size ?? 1; }
  private value(data: Float32Array, i: number, size: number): number {
    const { component } = this.choices[this.choice];
    if (size === 1) return data[i];
    if (component >= 0) return data[size * i + component];
    let sum = 0;
    for (let k = 0; k < size; k++) sum += data[size * i + k] ** 2;
    return Math.sqrt(sum);
  }

  /** A node of a solid at the present time. */
  node(index: number, node: number, out: Vector3): Vector3 {
    const own = this.own.find((o) => o.index === index);
    return own ? out.fromBufferAttribute(own.geometry.getAttribute("position") as BufferAttribute, node) : out;
  }
  /** Node at a corner of what a ray has met: elements in colours have corners of their own. */
  shownNode(index: number, corner: number): number {
    const cells = this.own.find((o) => o.index === index)?.cells;
    return cells?.mesh.visible ? cells.corners[corner] : corner;
  }

  /** Box around all solids at the present time, or around one of them. */
  box(out: Box3, index = -1): void {
    const one = new Box3();
    for (const own of this.own) if (index < 0 || own.index === index) out.union(one.setFromBufferAttribute(own.geometry.getAttribute("position") as BufferAttribute));
  }

  update(): void {
    const { frame, part } = this.poses;
    this.own.forEach((own, s) => {
      const { reference, displacement, mesh, lines, geometry, cells } = own, on = !this.hidden[s], split = on && this.byElement && cells !== null && (this.fields[s] ?? null) !== null;
      lines.visible = on;
      mesh.visible = on && !split;
      if (cells) cells.mesh.visible = split;
      if (!on) return;
      const points = geometry.getAttribute("position") as BufferAttribute, at = points.array, width = reference.length;
      if (displacement) {
        const a = frame * width, b = part > 0 ? a + width : a;
        for (let i = 0; i < width; i++)
          at[i] = reference[i] + this.enlarge * ((1 - part) * displacement[a + i] + part * displacement[b + i]);
        points.needsUpdate = true;
      }
      geometry.boundingSphere = null;
      const rows = this.colours(own, s);
      if (split && cells) { this.spread(cells, at, rows); return; }
      geometry.computeVertexNormals();
      const colours = geometry.getAttribute("color") as BufferAttribute;
      colours.array.set(rows);
      colours.needsUpdate = true;
    });
  }

  /** Colours of all rows of the field, nodes or elements, at the present time; plain where there is none. */
  private colours({ entry, reference }: Own, s: number): Float32Array {
    const { frame, part } = this.poses, colour = new Color(this.plain), data = this.fields[s] ?? null, size = data ? this.width(entry) : 1;
    const n = data && this.byElement ? (this.fieldOf(entry)?.data.w ?? 0) / size : reference.length / 3, rows = new Float32Array(3 * n), [low, high] = this.range;
    for (let i = 0; i < n; i++) {
      if (data && this.choice >= 0) {
        const now = this.value(data, frame * n + i, size), next = part > 0 ? this.value(data, (frame + 1) * n + i, size) : now;
        const value = now + part * (next - now);
        if (Number.isFinite(value)) mapped((value - low) / (high - low), colour); else colour.set(this.plain);
      }
      colour.toArray(rows, 3 * i);
    }
    return rows;
  }

  private spread({ mesh, corners, owners }: Cells, at: ArrayLike<number>, rows: Float32Array): void {
    const points = mesh.geometry.getAttribute("position") as BufferAttribute, colours = mesh.geometry.getAttribute("color") as BufferAttribute;
    for (let i = 0; i < corners.length; i++)
      for (let k = 0; k < 3; k++) {
        points.array[3 * i + k] = at[3 * corners[i] + k];
        colours.array[3 * i + k] = rows[3 * owners[(i / 3) | 0] + k];
      }
    points.needsUpdate = colours.needsUpdate = true;
    mesh.geometry.computeVertexNormals();
    mesh.geometry.boundingSphere = null;
  }
}
