// SPDX-License-Identifier: Apache-2.0
// Beams with their sections, cables as ropes.
import { Box3, BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group, Mesh, Quaternion, Vector3 } from "three";
import type { Scene } from "./data";
import { surface } from "./materials";
import type { Poses } from "./poses";
import { mapped } from "./solids";

interface Line {
  kind: "beam" | "cable"; index: number; nodes: number; position: Float32Array; orientation: Float32Array | null; outline: [number, number][];
  geometry: BufferGeometry; mesh: Mesh; tension: Float32Array | null; most: number;
}

const circle = (radius: number): [number, number][] =>
  Array.from({ length: 10 }, (_, i) => [radius * Math.cos(2 * Math.PI * i / 10), radius * Math.sin(2 * Math.PI * i / 10)]);

export class Lines {
  readonly group = new Group();
  private readonly list: Line[] = [];
  private constructor(private readonly poses: Poses) {}

  static async of(scene: Scene, poses: Poses, size: () => number): Promise<Lines> {
    const lines = new Lines(poses), m = scene.manifest;
    for (const [index, beam] of m.beams.entries()) {
      const position = await scene.channel(`beams/${beam.name}/nodes/position`), orientation = await scene.channel(`beams/${beam.name}/nodes/orientation`);
      const width = scene.entry(`beams/${beam.name}/nodes/position`)?.data.w ?? 0;
      if (!position || !orientation) continue;
      const h = (beam.height || 0.01 * size()) / 2, w = (beam.width || 0.01 * size()) / 2;
      lines.add("beam", index, width / 3, position, orientation, [[-h, -w], [h, -w], [h, w], [-h, w]], null);
    }
    for (const [index, cable] of m.cables.entries()) {
      const position = await scene.channel(`cables/${cable.name}/position`), tension = await scene.channel(`cables/${cable.name}/tension`);
      const width = scene.entry(`cables/${cable.name}/position`)?.data.w ?? 0;
      if (position) lines.add("cable", index, width / 3, position, null, circle(cable.radius || 0.003 * size()), tension);
    }
    return lines;
  }

  private add(kind: "beam" | "cable", index: number, nodes: number, position: Float32Array, orientation: Float32Array | null, outline: [number, number][],
    tension: Float32Array | null): void {
    const k = outline.length, geometry = new BufferGeometry(), corners: number[] = [];
    for (let i = 0; i + 1 < nodes; i++)
      for (let j = 0; j < k; j++) {
        const a = i * k + j, b = i * k + (j + 1) % k;
        corners.push(a, b, b + k, a, b + k, a + k);
      }
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * k * nodes), 3).setUsage(DynamicDrawUsage));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(3 * k * nodes), 3).setUsage(DynamicDrawUsage));
    geometry.setIndex(corners);
    const mesh = new Mesh(geometry, surface({ vertexColors: true, flatShading: true, side: DoubleSide, roughness: 0.6 }));
    mesh.frustumCulled = false;
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.userData = { pick: () => ({ kind, index }) };
    this.group.add(mesh);
    let most = 0;
    if (tension) for (const t of tension) most = Math.max(most, t);
    this.list.push({ kind, index, nodes, position, orientation, outline, geometry, mesh, tension, most });
  }

  /** Box around a beam or cable at the present time. */
  boxOf(kind: string, index: number): Box3 {
    const line = this.list.find((l) => l.kind === kind && l.index === index);
    return line ? new Box3().setFromBufferAttribute(line.geometry.getAttribute("position") as BufferAttribute) : new Box3();
  }

  box(out: { expandByPoint(p: Vector3): unknown }): void {
    const p = new Vector3();
    for (const line of this.list)
      for (let i = 0; i < line.nodes; i++) out.expandByPoint(p.fromArray(line.position, 3 * i));
  }

  update(): void {
    const { frame, part } = this.poses, q = new Quaternion(), e1 = new Vector3(), e2 = new Vector3(), p = new Vector3(), next = new Vector3(), colour = new Color();
    for (const line of this.list) {
      const { nodes, position, orientation, outline } = line, width = 3 * nodes;
      const points = line.geometry.getAttribute("position") as BufferAttribute, colours = line.geometry.getAttribute("color") as BufferAttribute;
      const at = (i: number, out: Vector3) => {
        const a = frame * width + 3 * i, b = part > 0 ? a + width : a;
        return out.set(position[a] + part * (position[b] - position[a]), position[a + 1] + part * (position[b + 1] - position[a + 1]),
          position[a + 2] + part * (position[b + 2] - position[a + 2]));
      };
      for (let i = 0; i < nodes; i++) {
        at(i, p);
        if (orientation) {
          const a = 4 * (frame * nodes + i);
          q.set(orientation[a + 1], orientation[a + 2], orientation[a + 3], orientation[a]);
          e1.set(0, 1, 0).applyQuaternion(q);
          e2.set(0, 0, 1).applyQuaternion(q);
          colour.set("#4c86c6");
        } else {
          at(Math.min(i + 1, nodes - 1), next).sub(at(Math.max(i - 1, 0), e1)).normalize();
          e1.set(0, 0, 1);
          if (Math.abs(next.z) > 0.9) e1.set(1, 0, 0);
          e2.crossVectors(next, e1).normalize();
          e1.crossVectors(e2, next);
          const tension = line.tension?.[frame * (nodes - 1) + Math.min(i, nodes - 2)] ?? 0;
          if (line.most > 0) mapped(tension / line.most, colour); else colour.set("#a08050");
        }
        outline.forEach(([y, z], j) => {
          const v = i * outline.length + j;
          points.setXYZ(v, p.x + y * e1.x + z * e2.x, p.y + y * e1.y + z * e2.y, p.z + y * e1.z + z * e2.z);
          colours.setXYZ(v, colour.r, colour.g, colour.b);
        });
      }
      points.needsUpdate = colours.needsUpdate = true;
      line.geometry.boundingSphere = null;
    }
  }
}
