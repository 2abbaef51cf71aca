// SPDX-License-Identifier: Apache-2.0
import {
  Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, FrontSide, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, PlaneGeometry, Quaternion,
  Vector3,
} from "three";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { discsFor } from "./balls";
import type { Four, Scene, Triple } from "./data";
import { type Edges, edgesFor, outlined, outlines } from "./edges";
import { shaped } from "./inertia";
import { software, surface, type Surface } from "./materials";
import type { Poses } from "./poses";

export type Showing = "shown" | "ghost" | "hidden";

/** Colours that are distinct for colour-blind users, too (after Okabe and Ito 2008), less saturated. */
const kPalette = ["#4c86c6", "#e0a030", "#4fa287", "#cc6f4a", "#8f7bc0", "#7fb7dd", "#c9b64a", "#b06a92"];
const kFixed = "#9aa5ae";
const kChosen = new Color("#ffd23f");

export const quaternion = (q: Four | undefined): Quaternion => (q ? new Quaternion(q[1], q[2], q[3], q[0]) : new Quaternion());
export const vector = (v: Triple | undefined): Vector3 => (v ? new Vector3(...v) : new Vector3());

interface Part { body: number; local: Matrix4 }
interface Batch { parts: Part[]; inertia: boolean; solid: InstancedMesh; ghost: InstancedMesh; discs: InstancedMesh | null; edges: Edges | null; ghostEdges: Edges | null }

/** Layer of invisible objects for picking. */
export const kUnseen = 1;

/** Shading of planes; unlit planes cost least per pixel, but receive no shadows. */
const planeSurface = (lit: boolean, opacity: number): Surface | MeshBasicMaterial => {
  const look = { color: kFixed, transparent: true, opacity, side: DoubleSide, depthWrite: false };
  return lit ? surface(look) : new MeshBasicMaterial(look);
};

const kNothing = new Matrix4().makeScale(0, 0, 0);

/** All bodies: each different shape is one instanced mesh, a second one for ghosts. */
export class Bodies {
  readonly group = new Group();
  readonly showing: Showing[];
  private readonly batches: Batch[] = [];
  private readonly planes: { body: number; local: Matrix4; mesh: Mesh }[] = [];
  chosen = -1;
  plain = false;
  private open = false;
  private shadows = false;
  /** Common colour of all bodies of a compared recording. */
  tint: Color | null = null;
  /** Place of each body in the order of colours. */
  readonly hues: number[];
  private edgesOn = true;

  private constructor(private readonly scene: Scene, private readonly poses: Poses) {
    this.showing = scene.manifest.bodies.map(() => "shown");
    this.hues = scene.manifest.bodies.map((_, i) => i);
  }

  static async of(scene: Scene, poses: Poses): Promise<Bodies> {
    const bodies = new Bodies(scene, poses);
    await bodies.build();
    return bodies;
  }

  colour(body: number): Color {
    const entry = this.scene.manifest.bodies[body];
    if (body === this.chosen) return kChosen;
    if (this.tint) return this.tint;
    if (entry.mark) return new Color("#d9822b");
    if (entry.color) return new Color(entry.color);
    return new Color(entry.fixed ? kFixed : kPalette[this.hues[body] % kPalette.length]);
  }

  private async build(): Promise<void> {
    const m = this.scene.manifest;
    const parts: Part[][] = m.meshes.map(() => []);
    m.bodies.forEach((body, index) => {
      for (const part of body.parts ?? []) {
        const local = new Matrix4().compose(vector(part.p), quaternion(part.q), new Vector3(1, 1, 1));
        if (part.plane) {
          const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), vector(part.plane).normalize());
          const mesh = new Mesh(new PlaneGeometry(1, 1), planeSurface(!software, 0.28));
          mesh.matrixAutoUpdate = false;
          mesh.receiveShadow = true;
          mesh.userData = { pick: () => ({ kind: "body", index }) };
          this.planes.push({ body: index, local: local.multiply(new Matrix4().makeRotationFromQuaternion(turn)), mesh });
          this.group.add(mesh);
        } else if (part.mesh !== undefined) parts[part.mesh].push({ body: index, local });
      }
    });
    for (let k = 0; k < m.meshes.length; k++) {
      if (parts[k].length === 0) continue;
      const flat = new BufferGeometry();
      flat.setAttribute("position", new BufferAttribute(await this.scene.floats(m.meshes[k].points), 3));
      flat.setIndex(new BufferAttribute(await this.scene.integers(m.meshes[k].triangles), 1));
      // Corners are shared in shapes without edges, and in surfaces too large for sharp edges.
      const smooth = m.meshes[k].triangles.n > 200000 || ["sphere", "ellipsoid", "capsule"].includes(m.meshes[k].type);
      const geometry = smooth ? flat : toCreasedNormals(flat, 0.6);
      if (smooth) geometry.computeVertexNormals();
      geometry.computeBoundingSphere();
      const make = (ghost: boolean): InstancedMesh => {
        const material = surface({ roughness: 0.62, metalness: 0.05, side: FrontSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
          ...(ghost ? { transparent: true, opacity: 0.16, depthWrite: false } : {}) });
        const mesh = new InstancedMesh(geometry, outlined(material), parts[k].length);
        mesh.frustumCulled = false;
        mesh.castShadow = !ghost;
        mesh.receiveShadow = !ghost;
        mesh.userData = { pick: (instance: number) => ({ kind: "body", index: parts[k][instance].body }) };
        this.group.add(mesh);
        return mesh;
      };
      const solid = make(false), ghost = make(true), smoothly = smooth && m.meshes[k].type !== "mesh";
      const edges = smoothly ? null : edgesFor(solid, flat, 0x101820, 0.55), ghostEdges = smoothly ? null : edgesFor(ghost, flat, 0x101820, 0.3);
      const batch: Batch = { parts: parts[k], inertia: m.meshes[k].type === "inertia", solid, ghost, discs: null, edges, ghostEdges };
      for (const lines of [edges, ghostEdges]) if (lines) this.group.add(lines);
      if (m.meshes[k].type === "sphere" && (software || m.bodies.length > 500)) this.group.add(batch.discs = discsFor(batch.solid));
      this.batches.push(batch);
    }
    this.setOpen(false);
    this.colours();
    this.update();
  }

  /** Whether a section cuts the bodies, so that their insides are visible. */
  setOpen(open: boolean): void {
    this.open = open;
    for (const { solid, discs } of this.batches)
      if (discs) {
        discs.visible = !open && !this.shadows;
        solid.layers.set(discs.visible ? kUnseen : 0);
      }
    for (const { solid, ghost } of this.batches)
      for (const mesh of [solid, ghost]) {
        const material = mesh.material as Surface;
        material.side = open ? DoubleSide : FrontSide;
        material.needsUpdate = true;
      }
  }

  /** Whether bodies cast shadows: discs for balls cast none, and unlit planes receive none. */
  setShadows(on: boolean): void {
    this.shadows = on;
    for (const { mesh } of software ? this.planes : []) {
      const before = mesh.material as Surface;
      mesh.material = planeSurface(on, before.opacity);
      before.dispose();
    }
    this.setOpen(this.open);
  }

  /** Opacity of ghosts, and look of their edges. */
  setGhostLook(opacity: number, edges: string, edgeOpacity: number, behind: boolean): void {
    for (const { ghost, ghostEdges } of this.batches) {
      // Behind the same surface of another recording.
      Object.assign(ghost.material, { opacity, polygonOffsetFactor: behind ? 4 : 1, polygonOffsetUnits: behind ? 4 : 1 });
      if (ghostEdges) ghostEdges.depth.value = behind ? 1.006 : 1;
      if (ghostEdges) Object.assign(ghostEdges.material, { color: new Color(edges), opacity: edgeOpacity });
    }
  }
  /** Whether edges and outlines are drawn. */
  setEdges(on: boolean): void {
    this.edgesOn = on;
    outlines.value = on ? 1 : 0;
    this.update();
  }

  /** Boxes of mass and inertia, in place of shapes: diagonals [m], and whether they are much longer than wide; `local` can be scaled. */
  inertiaBoxes(): { body: number; diagonal: number; slender: boolean; local: Matrix4 }[] {
    return this.batches.filter((batch) => batch.inertia).flatMap(({ parts, solid }) => {
      solid.geometry.computeBoundingBox();
      // Boxes have the principal axes of inertia, which the body's own axes need not be: sides are measured between corners.
      const corners = solid.geometry.getAttribute("position"), first = new Vector3().fromBufferAttribute(corners, 0), other = new Vector3();
      const sides = Array.from({ length: corners.count }, (_, i) => first.distanceTo(other.fromBufferAttribute(corners, i))).filter((d) => d > 0).sort((a, b) => a - b);
      const diagonal = sides[sides.length - 1] ?? 0, slender = (sides.filter((d, i) => i === 0 || d > 1.001 * sides[i - 1])[1] ?? 0) < 0.4 * diagonal;
      return parts.map(({ body, local }) => ({ body, diagonal, slender, local }));
    });
  }

  /** Box around all bodies at the present time, without planes; of ghosts, and of boxes of inertia unless `inertia`, the centre of mass only,
   *  of boxes beside shapes nothing. */
  box(inertia = false): Box3 {
    const all = new Box3(), matrix = new Matrix4(), one = new Box3();
    for (const batch of this.batches) {
      batch.solid.geometry.computeBoundingBox();
      for (const part of batch.parts) {
        if (batch.inertia ? !inertia : this.showing[part.body] !== "shown") {
          if (batch.inertia && shaped(this.scene)) continue;
          all.expandByPoint(this.poses.r_of(part.body, new Vector3()));
          continue;
        }
        one.copy(batch.solid.geometry.boundingBox as Box3).applyMatrix4(this.poses.matrix_of(part.body, matrix).multiply(part.local));
        all.union(one);
      }
    }
    return all;
  }

  /** Number of points of specialPoints() of all bodies, about. */
  get specialCount(): number { return this.batches.reduce((sum, { edges, parts }) => sum + (edges ? edges.geometry.getAttribute("position").count * parts.length : 0), 0); }
  /** Corners and middles of the edges of a body, relative to its centre of mass in its own axes. */
  specialPoints(body: number): { local: Vector3; what: string }[] {
    const found: { local: Vector3; what: string }[] = [];
    for (const { parts, edges, inertia } of this.batches) {
      if (!edges || inertia) continue;
      const ends = edges.geometry.getAttribute("position") as BufferAttribute;
      for (const part of parts) {
        if (part.body !== body) continue;
        for (let i = 0; i + 1 < ends.count; i += 2) {
          const [a, b] = [i, i + 1].map((k) => new Vector3().fromBufferAttribute(ends, k).applyMatrix4(part.local));
          found.push({ local: a, what: "corner" }, { local: b, what: "corner" }, { local: a.clone().lerp(b, 0.5), what: "middle of an edge" });
        }
      }
    }
    return found;
  }

  /** Box around the shapes of one body at the present time; empty if it has none. */
  boxOf(body: number): Box3 {
    const all = new Box3(), matrix = new Matrix4();
    for (const { parts, solid } of this.batches) {
      solid.geometry.computeBoundingBox();
      for (const part of parts)
        if (part.body === body) all.union(new Box3().copy(solid.geometry.boundingBox as Box3).applyMatrix4(this.poses.matrix_of(body, matrix).multiply(part.local)));
    }
    return all;
  }

  /** Unbounded planes, drawn as squares larger than the scene. */
  sizePlanes(size: number): void {
    for (const plane of this.planes) plane.local.scale(new Vector3(1.6 * size, 1.6 * size, 1));
    // A bin has walls on all sides; those that would hide the scene are drawn as outlines.
    if (this.planes.length > 1) for (const plane of this.planes) (plane.mesh.material as Surface).opacity = 0.07;
    this.update();
  }

  colours(): void {
    for (const batch of this.batches)
      batch.parts.forEach((part, i) => {
        const colour = this.colour(part.body);
        batch.solid.setColorAt(i, colour);
        batch.ghost.setColorAt(i, colour);
      });
    for (const batch of this.batches)
      for (const mesh of [batch.solid, batch.ghost]) {
        if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
        if (batch.discs && mesh === batch.solid) batch.discs.instanceColor = mesh.instanceColor;
      }
  }

  update(): void {
    const matrix = new Matrix4();
    for (const { parts, solid, ghost, edges, ghostEdges } of this.batches) {
      let ghosts = false;
      parts.forEach((part, i) => {
        const showing = this.showing[part.body];
        this.poses.matrix_of(part.body, matrix).multiply(part.local);
        solid.setMatrixAt(i, showing === "shown" && !this.plain ? matrix : kNothing);
        const faint = showing === "ghost" || (this.plain && showing === "shown");
        ghost.setMatrixAt(i, faint ? matrix : kNothing);
        ghosts ||= faint;
      });
      ghost.visible = ghosts;
      if (edges) edges.visible = this.edgesOn;
      if (ghostEdges) ghostEdges.visible = ghosts && this.edgesOn;
      solid.instanceMatrix.needsUpdate = ghost.instanceMatrix.needsUpdate = true;
      solid.boundingSphere = ghost.boundingSphere = null;
    }
    for (const plane of this.planes) {
      plane.mesh.visible = this.showing[plane.body] !== "hidden";
      this.poses.matrix_of(plane.body, plane.mesh.matrix).multiply(plane.local);
      plane.mesh.matrixWorldNeedsUpdate = true;
    }
  }
}
