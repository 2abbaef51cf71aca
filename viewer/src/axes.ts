// SPDX-License-Identifier: Apache-2.0
// The instantaneous helical axis of a body relative to another one, and its earlier positions.
import { BufferAttribute, BufferGeometry, Group, Line, LineBasicMaterial, LineSegments, Quaternion, Vector3 } from "three";
import type { Scene } from "./data";
import { type Poses, valuesAt } from "./poses";

/** Line about which a body turns and along which it slides; all in world axes. */
export interface HelicalAxis {
  point: Vector3;   // of the line, nearest to the body's centre of mass [m]
  along: Vector3;   // unit vector of the angular velocity
  rate: number;     // [rad/s]
  pitch: number;    // displacement along the axis per radian [m/rad]
}

interface Motion { r: Vector3; v: Vector3; w: Vector3 }

/**
 * Axis of a motion relative to another one (Mozzi 1763): the points whose velocity is along ω. Null where the relative angular
 * velocity is less than `still` [rad/s].
 */
export function helicalAxis(body: Motion, from: Motion, still: number): HelicalAxis | null {
  const w = body.w.clone().sub(from.w), rate = w.length();
  if (!(rate > still)) return null;
  const carried = from.v.clone().add(new Vector3().crossVectors(from.w, body.r.clone().sub(from.r)));
  const v = body.v.clone().sub(carried);
  return { point: body.r.clone().addScaledVector(new Vector3().crossVectors(w, v), 1 / (rate * rate)), along: w.clone().divideScalar(rate), rate, pitch: v.dot(w) / (rate * rate) };
}

const kMost = 240;  // Number of drawn axes of other times.

export class Axes {
  readonly group = new Group();
  body = -1;
  from = -1;
  now: HelicalAxis | null = null;
  private velocity: Float32Array | null = null;
  private spin: Float32Array | null = null;
  private fastest = 0;
  private past: { frame: number; a: Vector3; b: Vector3 }[] = [];  // in axes of `from`
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xc2185b, depthTest: false, transparent: true }));
  private readonly fan = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0xc2185b, transparent: true, opacity: 0.3, depthWrite: false }));

  constructor(private readonly scene: Scene, private readonly poses: Poses, private readonly size: () => number) {
    for (const object of [this.line, this.fan]) object.frustumCulled = false;
    this.line.renderOrder = 6;
    this.group.add(this.fan, this.line);
    this.group.visible = false;
  }

  /** Shows the axis of a body relative to another one, −1: the ground; no body: no axis. */
  async choose(body: number, from: number): Promise<void> {
    this.body = body;
    this.from = from;
    this.group.visible = body >= 0 && body !== from;
    if (!this.group.visible) { this.now = null; return; }
    this.velocity ??= await this.scene.channel("packed/bodies/velocity");
    this.spin ??= await this.scene.channel("packed/bodies/angular_velocity");
    const time = this.scene.manifest.time, step = Math.max(1, Math.ceil(time.length / kMost));
    this.fastest = 0;
    const all = time.map((_, frame) => (frame % step === 0 ? frame : -1)).filter((f) => f >= 0);
    for (const frame of all) this.fastest = Math.max(this.fastest, this.at(this.body, frame, 0).w.sub(this.at(this.from, frame, 0).w).length());
    this.past = [];
    const turn = new Quaternion();
    for (const frame of all) {
      const axis = helicalAxis(this.at(body, frame, 0), this.at(from, frame, 0), this.still());
      if (!axis) continue;
      const r = this.at(from, frame, 0).r, back = this.poses.turnAt(from, frame, turn).invert(), half = 0.25 * this.size();
      const end = (sign: number) => axis.point.clone().addScaledVector(axis.along, sign * half).sub(r).applyQuaternion(back);
      this.past.push({ frame, a: end(-1), b: end(1) });
    }
    this.update();
  }
  private still(): number { return 1e-6 * this.fastest; }

  private at(body: number, frame: number, part: number): Motion {
    if (body < 0) return { r: new Vector3(), v: new Vector3(), w: new Vector3() };
    const n = this.scene.manifest.bodies.length, of = (data: Float32Array | null) => new Vector3(...(data ? valuesAt(data, 3 * n, 3 * body, 3, frame, part) : [0, 0, 0]));
    return { r: this.poses.placeAt(body, frame, part, new Vector3()), v: of(this.velocity), w: of(this.spin) };
  }

  update(): void {
    if (!this.group.visible) return;
    const { frame, part } = this.poses, r = this.poses.r_of(this.from, new Vector3()), q = this.poses.q_of(this.from, new Quaternion());
    this.now = helicalAxis(this.at(this.body, frame, part), this.at(this.from, frame, part), this.still());
    const half = 0.4 * this.size(), points = this.now ? [-half, half].map((s) => this.now!.point.clone().addScaledVector(this.now!.along, s)) : [];
    this.line.geometry.setFromPoints(points.length > 0 ? points : [new Vector3(), new Vector3()]);
    this.line.visible = points.length > 0;
    const ends = this.past.filter((axis) => axis.frame <= frame).flatMap(({ a, b }) => [a, b].flatMap((end) => end.clone().applyQuaternion(q).add(r).toArray()));
    this.fan.geometry.dispose();
    this.fan.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  }
}
