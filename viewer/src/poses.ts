// SPDX-License-Identifier: Apache-2.0
import { Matrix4, Quaternion, Vector3 } from "three";
import { frameAt, type Scene } from "./data";

const kGround = new Vector3();
const kUnit = new Quaternion();
const kOne = new Vector3(1, 1, 1);

/** Poses of all bodies at the present time, interpolated between frames. */
export class Poses {
  readonly position: Float32Array;
  readonly orientation: Float32Array;  // x y z w
  frame = 0;
  part = 0;

  private constructor(private readonly time: number[], private readonly count: number, private readonly r: Float32Array,
    private readonly q: Float32Array) {
    this.position = new Float32Array(3 * count);
    this.orientation = new Float32Array(4 * count);
    this.set(time[0] ?? 0);
  }

  static async of(scene: Scene): Promise<Poses> {
    const n = scene.manifest.bodies.length;
    const [r, q] = await Promise.all([scene.channel("packed/bodies/position"), scene.channel("packed/bodies/orientation")]);
    return new Poses(scene.manifest.time, n, r ?? new Float32Array(), q ?? new Float32Array());
  }

  set(t: number): void {
    const { frame, part } = frameAt(this.time, t);
    this.frame = frame;
    this.part = part;
    const n = this.count, r = this.r, q = this.q;
    if (r.length === 0) return;
    const a = frame * n, b = part > 0 ? a + n : a, rest = 1 - part;
    for (let i = 0; i < 3 * n; i++) this.position[i] = rest * r[3 * a + i] + part * r[3 * b + i];
    for (let i = 0; i < n; i++) {
      const u = 4 * (a + i), v = 4 * (b + i);
      const sign = q[u] * q[v] + q[u + 1] * q[v + 1] + q[u + 2] * q[v + 2] + q[u + 3] * q[v + 3] < 0 ? -part : part;
      const w = rest * q[u] + sign * q[v], x = rest * q[u + 1] + sign * q[v + 1], y = rest * q[u + 2] + sign * q[v + 2],
        z = rest * q[u + 3] + sign * q[v + 3], size = Math.hypot(w, x, y, z) || 1;
      this.orientation[4 * i] = x / size;
      this.orientation[4 * i + 1] = y / size;
      this.orientation[4 * i + 2] = z / size;
      this.orientation[4 * i + 3] = w / size;
    }
  }

  r_of(body: number, out: Vector3): Vector3 { return body < 0 ? out.copy(kGround) : out.fromArray(this.position, 3 * body); }
  q_of(body: number, out: Quaternion): Quaternion { return body < 0 ? out.copy(kUnit) : out.fromArray(this.orientation, 4 * body); }
  matrix_of(body: number, out: Matrix4): Matrix4 { return out.compose(this.r_of(body, new Vector3()), this.q_of(body, new Quaternion()), kOne); }
  /** World coordinates of a point of a body, given relative to its centre of mass in body axes. */
  point(body: number, Z: ArrayLike<number>, out: Vector3): Vector3 {
    out.set(Z[0], Z[1], Z[2]);
    if (body < 0) return out;
    return out.applyQuaternion(this.q_of(body, scratch)).add(this.r_of(body, scratchPoint));
  }
  /** Position and orientation of a body at a given time; −1: the ground. */
  placeAt(body: number, frame: number, part: number, out: Vector3): Vector3 {
    return body < 0 ? out.copy(kGround) : out.fromArray(valuesAt(this.r, 3 * this.count, 3 * body, 3, frame, part));
  }
  turnAt(body: number, frame: number, out: Quaternion): Quaternion {
    if (body < 0) return out.copy(kUnit);
    const at = 4 * (frame * this.count + body), q = this.q;
    return out.set(q[at + 1], q[at + 2], q[at + 3], q[at]).normalize();
  }
  /** Path of a body's centre of mass. */
  path(body: number): Float32Array {
    const frames = this.count > 0 ? this.r.length / 3 / this.count : 0;
    const points = new Float32Array(3 * frames);
    for (let f = 0; f < frames; f++)
      for (let k = 0; k < 3; k++) points[3 * f + k] = this.r[3 * (f * this.count + body) + k];
    return points;
  }
}
const scratch = new Quaternion(), scratchPoint = new Vector3();

/** Numbers of a channel at a time, interpolated between frames. */
export function valuesAt(data: Float32Array, width: number, at: number, size: number, frame: number, part: number): number[] {
  const values: number[] = [];
  for (let k = 0; k < size; k++) {
    const a = data[frame * width + at + k], b = part > 0 ? data[(frame + 1) * width + at + k] : a;
    values.push(Number.isFinite(b) ? a + part * (b - a) : a);
  }
  return values;
}
