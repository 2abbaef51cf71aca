// SPDX-License-Identifier: Apache-2.0
// The animation: objects of the scene, and those that are selected, hidden, measured and followed.
import { Box3, BufferAttribute, BufferGeometry, Color, Group, Line, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, type Object3D, Points, PointsMaterial, SphereGeometry, Vector3 } from "three";
import { Axes } from "./axes";
import { Bodies, type Showing } from "./bodies";
import type { Manifest, Scene } from "./data";
import type { Ghost } from "./ghost";
import { Forces, Joints, Loads } from "./glyphs";
import { shaped, sizeInertia } from "./inertia";
import { Lines } from "./lines";
import { Poses } from "./poses";
import { type Spot, spotAt } from "./snap";
import { Solids } from "./solids";
import { Stage } from "./stage";

export interface Choice { kind: "body" | "joint" | "load" | "contact" | "solid" | "beam" | "cable"; index: number }

export class View {
  readonly forces: { contacts: Forces | null; reactions: Forces | null; loads: Forces | null } = { contacts: null, reactions: null, loads: null };
  readonly trails = new Group();
  readonly centres = new Points(new BufferGeometry(), new PointsMaterial({ color: 0xd1281e, size: 7, sizeAttenuation: false, depthTest: false }));
  readonly frames = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ vertexColors: true }));
  readonly helical: Axes;
  ghost: Ghost | null = null;
  beside = false;
  shadowsAsked = false;  // by the user: then they are kept on slow machines, too
  /** Called when shadows are switched, and when something has moved. */
  onshadows: () => void = () => undefined;
  onupdate: () => void = () => undefined;
  private t = 0;
  chosen: Choice | null = null;
  follow = false;
  trailsOn = false;
  measuring = false;
  /** Extent of the scene without boxes of inertia. */
  private readonly extent = new Box3();
  readonly marks: Spot[] = [];
  private pointed: Spot | null = null;
  private readonly markGroup = new Group();
  private readonly followed = new Vector3();

  private constructor(readonly scene: Scene, readonly stage: Stage, readonly poses: Poses, readonly bodies: Bodies, readonly joints: Joints,
    readonly loads: Loads, readonly solids: Solids, readonly lines: Lines, readonly width: number) {
    this.helical = new Axes(scene, poses, () => stage.size);
  }

  static async of(scene: Scene, holder: HTMLElement): Promise<View> {
    const m = scene.manifest, g = m.gravity ?? [0, 0, -1];
    const up = new Vector3(-g[0], -g[1], -g[2]);
    const axis = up.lengthSq() === 0 ? 2 : [Math.abs(up.x), Math.abs(up.y), Math.abs(up.z)].indexOf(Math.max(Math.abs(up.x), Math.abs(up.y), Math.abs(up.z)));
    const sign = up.getComponent(axis) < 0 ? -1 : 1;
    up.set(0, 0, 0).setComponent(axis, sign);
    const stage = new Stage(holder, up, m.bodies.length <= 500);
    const poses = await Poses.of(scene);
    const bodies = await Bodies.of(scene, poses), solids = await Solids.of(scene, poses);
    const joints = new Joints(m.joints, poses), width = bodies.box().getSize(new Vector3()).length() || 1, lines = await Lines.of(scene, poses, () => width);
    const view = new View(scene, stage, poses, bodies, joints, new Loads(m.loads, m.joints, joints, poses), solids, lines, width);
    for (const [key, made] of [["contacts", await Forces.contacts(scene)], ["reactions", await Forces.reactions(scene, joints)],
      ["loads", await Forces.loads(scene, poses)]] as const) {
      view.forces[key] = made;
      if (!made) continue;
      stage.world.add(made.group);
      if (key === "reactions") made.onfilled = () => view.update(); else await made.fill();
    }
    if (view.forces.reactions) view.forces.reactions.group.visible = false;
    stage.world.add(bodies.group, joints.group, view.loads.group, solids.group, lines.group, view.trails, view.centres, view.frames, view.markGroup, view.helical.group);
    view.centres.visible = view.frames.visible = false;
    for (const object of [view.centres, view.frames]) object.frustumCulled = false;
    view.centres.renderOrder = 5;
    // Boxes of mass and inertia would hide bodies with shapes.
    if (shaped(scene)) m.bodies.forEach((body, i) => { if (body.parts?.[0]?.mesh !== undefined && m.meshes[body.parts[0].mesh].type === "inertia") bodies.showing[i] = "ghost"; });
    view.extent.copy(view.box(false));
    stage.fit(sizeInertia(scene, bodies, view.extent) ? view.box(true) : view.extent);
    bodies.sizePlanes(stage.size);
    view.update();
    return view;
  }

  /** Box around the scene at times spread over the recording; solids, which take longer, at three of them. */
  private box(inertia: boolean): Box3 {
    const time = this.scene.manifest.time, all = new Box3(), before = time[0], samples = 24;
    for (let k = 0; k <= samples; k++) {
      this.poses.set(time[Math.round(k / samples * (time.length - 1))]);
      all.union(this.bodies.box(inertia));
      if (k % (samples / 2) !== 0) continue;
      this.solids.update();
      this.solids.box(all);
    }
    this.lines.box(all);
    this.poses.set(before);
    for (let j = 0; j < this.scene.manifest.joints.length; j++) all.expandByPoint(this.joints.point(j, new Vector3()));
    for (const { a, b, Za, Zb, coil, damper } of this.scene.manifest.loads) if (Za && Zb && (coil || damper)) for (const [body, Z] of [[a, Za], [b, Zb]] as const) all.expandByPoint(this.poses.point(body ?? -1, Z, new Vector3()));
    if (!inertia && this.bodies.inertiaBoxes().length > 0) return all.isEmpty() ? all : all.expandByScalar(0.04 * all.getSize(new Vector3()).length());
    if (all.isEmpty()) all.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    return all;
  }

  set(t: number): void {
    this.t = t;
    this.poses.set(t);
    this.ghost?.set(t);
    this.update();
  }

  /** Draws another recording over this one. */
  compare(ghost: Ghost): void {
    this.ghost = ghost;
    ghost.setSize(this.stage.size, this.extent);
    this.stage.world.add(ghost.group);
  }
  showGhost(on: boolean): void {
    this.ghost?.show(on || this.beside, this.t);
    this.stage.dirty = true;
  }
  /** The other recording in a separate picture to the right with the same camera, or as a ghost over this one. */
  async setBeside(on: boolean): Promise<void> {
    const { ghost, stage, solids } = this;
    if (!ghost) return;
    this.beside = on;
    await ghost.setAlone(on, solids.choices[solids.choice]?.label);
    if (on) ghost.setRange(solids.range);
    const own = [this.bodies, this.joints, this.loads, this.solids, this.lines, ...Object.values(this.forces)].flatMap((part) => (part ? [part.group] : []))
      .concat([this.trails, this.markGroup, this.helical.group]), others = [this.centres, this.frames];
    let shown: boolean[] = [];
    const all = [...own, ...others];
    stage.halves = !on ? null : (half) => {
      if (half === 0) shown = all.map((object) => object.visible);
      if (half === 1) for (const object of all) object.visible = false;
      if (half === -1) all.forEach((object, i) => { object.visible = shown[i]; });
      ghost.group.visible = half !== 0;
    };
    ghost.show(true, this.t);
    stage.resize();
    if (stage.looking) stage.view(stage.looking);
    this.update();
  }

  update(): void {
    const { poses, stage } = this, size = stage.size;
    this.bodies.update();
    if (this.joints.group.visible) this.joints.update(size);
    if (this.loads.group.visible) this.loads.update(size);
    this.solids.update();
    this.lines.update();
    for (const forces of Object.values(this.forces)) if (forces?.group.visible) forces.update(size, poses.frame, poses.part);
    if (this.centres.visible) this.updateCentres();
    if (this.frames.visible) this.updateFrames();
    if (this.trailsOn) this.updateTrails();
    this.helical.update();
    if (this.marks.length > 0 || this.pointed) this.updateMarks();
    if (this.follow && this.chosen) {
      const at = this.placeOf(this.chosen);
      if (at) {
        const step = at.clone().sub(this.followed);
        stage.controls.target.add(step);
        stage.camera.position.add(step);
        this.followed.copy(at);
        stage.controls.update();
      }
    }
    this.onupdate();
    stage.dirty = true;
  }

  setFollow(on: boolean): void {
    this.follow = on;
    const at = this.chosen && this.placeOf(this.chosen);
    if (!on || !at) return;
    this.followed.copy(at);
    this.stage.looking = null;
    const step = at.clone().sub(this.stage.controls.target);
    this.stage.controls.target.copy(at);
    this.stage.camera.position.add(step);
    this.stage.controls.update();
  }

  /** Point that is followed: the centre of mass of a body, a joint's point, the middle of anything else; null of what is nowhere. */
  placeOf(choice: Choice): Vector3 | null {
    if (choice.kind === "body") return this.poses.r_of(choice.index, new Vector3());
    const box = this.boxOf(choice);
    return box.isEmpty() ? null : box.getCenter(new Vector3());
  }

  /** Box around an object at the present time; empty if it is nowhere. */
  boxOf({ kind, index }: Choice): Box3 {
    const box = new Box3(), m = this.scene.manifest, at = new Vector3();
    if (kind === "body") box.copy(this.bodies.boxOf(index));
    if (kind === "solid") this.solids.box(box, index);
    if (kind === "beam" || kind === "cable") box.copy(this.lines.boxOf(kind, index));
    if (kind === "body" && box.isEmpty()) box.expandByPoint(this.poses.r_of(index, at));
    if (kind === "joint" && m.joints[index].Za) box.expandByPoint(this.joints.point(index, at));
    const load = kind === "load" ? m.loads[index] : null;
    if (load?.Za && load.Zb) for (const [body, Z] of [[load.a, load.Za], [load.b, load.Zb]] as const) box.expandByPoint(this.poses.point(body ?? -1, Z, at));
    return box;
  }

  /** Moves the camera near the selected object, in its present direction; shows all without one. */
  fit(): void {
    const box = this.chosen && this.boxOf(this.chosen), { stage } = this;
    if (!box || box.isEmpty()) { stage.view(stage.looking ?? stage.firstLook()); return; }
    // Points, such as those of joints, are shown with what is near them.
    stage.close(box.expandByScalar(Math.max(0.02 * stage.size, 0.03 * box.getSize(new Vector3()).length())));
    if (this.follow && this.chosen) this.followed.copy(this.placeOf(this.chosen) as Vector3);
  }

  choose(choice: Choice | null): void {
    this.chosen = choice;
    this.bodies.chosen = choice?.kind === "body" ? choice.index : -1;
    this.joints.chosen = choice?.kind === "joint" ? choice.index : -1;
    this.bodies.colours();
    this.joints.colours();
    if (this.follow) this.setFollow(true);
    this.update();
  }

  show(body: number, showing: Showing): void { this.bodies.showing[body] = showing; this.update(); }
  showAll(): void {
    this.bodies.showing.fill("shown");
    this.solids.hidden.fill(false);
    this.update();
  }
  isolate(body: number): void {
    this.bodies.showing.forEach((_, i) => { this.bodies.showing[i] = i === body ? "shown" : "ghost"; });
    this.update();
  }

  setEdges(on: boolean): void {
    this.bodies.setEdges(on);
    this.ghost?.setEdges(on);
  }
  setShadows(on: boolean): void {
    this.stage.shadows = on;
    this.bodies.setShadows(on);
    this.ghost?.setShadows(on);
    this.onshadows();
  }
  /** Reduces the rendering effort on slow machines: first without shadows. */
  lighten(): void { if (this.stage.shadows && !this.shadowsAsked) this.setShadows(false); else this.stage.lighten(); }

  /** Object at a point of the window; in the picture of the other recording, the object of the same name here. */
  pick(x: number, y: number): { choice: Choice; point: Vector3; node: number } | null {
    if (this.ghost && this.stage.halfAt(x) === 1) {
      const met = this.met(x, y, this.ghost.objects);
      if (!met) return null;
      const named = ({ bodies, solids, beams, cables }: Manifest): { name: string }[] => ({ body: bodies, solid: solids, beam: beams, cable: cables, joint: [], load: [], contact: [] })[met.choice.kind];
      const name = named(this.ghost.scene.manifest)[met.choice.index]?.name, index = named(this.scene.manifest).findIndex((own) => own.name === name);
      return index < 0 ? null : { ...met, choice: { ...met.choice, index }, node: -1 };
    }
    return this.met(x, y, this.solidObjects().concat([this.joints.group, this.loads.group, ...Object.values(this.forces).filter((f) => f?.group.visible).map((f) => f!.group)]));
  }
  private solidObjects(): Object3D[] { return [this.bodies.group, this.solids.group, this.lines.group]; }
  private met(x: number, y: number, objects: Object3D[]): { choice: Choice; point: Vector3; node: number } | null {
    const hits = this.stage.ray(x, y).intersectObjects(objects, true);
    let plane: { choice: Choice; point: Vector3; node: number } | null = null;
    for (const hit of hits) {
      const pick = hit.object.userData.pick as ((instance: number) => Choice) | undefined;
      if (!pick || !hit.object.visible || !hit.object.parent?.visible) continue;
      const found = { choice: pick(hit.instanceId ?? 0), point: hit.point, node: -1 };
      if (hit.face && hit.object instanceof Mesh) {
        const corners = [hit.face.a, hit.face.b, hit.face.c], place = new Vector3(), points = hit.object.geometry.getAttribute("position") as BufferAttribute;
        const far = corners.map((k) => place.fromBufferAttribute(points, k).distanceTo(hit.point));
        found.node = corners[far.indexOf(Math.min(...far))];
      }
      if (hit.object instanceof Mesh && (hit.object.material as { opacity: number }).opacity < 0.3) { plane ??= found; continue; }  // seen through
      return found;
    }
    return plane;
  }

  /** Whether nothing that is opaque is before a point. */
  sees(point: Vector3): boolean {
    const pixel = this.stage.pixel(point), hit = pixel && this.met(pixel.x, pixel.y, this.solidObjects()), eye = this.stage.camera.position;
    return !hit || eye.distanceTo(point) < eye.distanceTo(hit.point) + 2e-3 * this.stage.size;
  }

  /** Point to measure at, at a point of the window; null in the picture of the other recording, and where nothing is. */
  spot(x: number, y: number): Spot | null {
    return this.stage.halfAt(x) === 1 ? null : spotAt(this, x, y, this.met(x, y, this.solidObjects()));
  }
  /** Shows the spot that a click would mark. */
  point(spot: Spot | null): void {
    if (!spot && !this.pointed) return;
    this.pointed = spot;
    this.updateMarks();
    this.stage.dirty = true;
  }
  addMark(spot: Spot): void {
    if (this.marks.length >= 3) this.marks.length = 0;
    this.marks.push(spot);
    this.pointed = null;
    this.update();
  }
  clearMarks(): void { this.marks.length = 0; this.pointed = null; this.updateMarks(); this.stage.dirty = true; }

  private updateMarks(): void {
    this.markGroup.clear();
    const colour = 0xd1281e, dot = new SphereGeometry(0.006 * this.stage.size, 10, 8);
    for (const mark of [...this.marks, ...(this.pointed ? [this.pointed] : [])]) {
      // A point between special ones is marked smaller, before the click.
      const ball = new Mesh(dot, new MeshBasicMaterial({ color: mark !== this.pointed ? colour : mark.what ? 0xf08c00 : 0x868e96, depthTest: false }));
      ball.position.copy(mark.at());
      ball.scale.setScalar(mark === this.pointed && !mark.what ? 0.5 : 1);
      this.markGroup.add(ball);
    }
    if (this.marks.length > 1)
      this.markGroup.add(new Line(new BufferGeometry().setFromPoints(this.marks.map((m) => m.at())), new LineBasicMaterial({ color: colour, depthTest: false })));
  }

  /** Distance of two marked points [m], and the angle at the second of three [rad]. */
  measured(): { distance: number; angle: number; between: string } | null {
    if (this.marks.length < 2) return null;
    const [a, b, c] = this.marks.map((m) => m.at()), names = this.marks.map((m) => m.what || m.choice.kind);
    return { between: this.marks.some((m) => m.what) ? names.join(" – ") : "", distance: a.distanceTo(b), angle: c ? a.clone().sub(b).angleTo(c.clone().sub(b)) : NaN };
  }

  private moving(): number[] {
    const list = this.scene.manifest.bodies;
    return list.map((_, i) => i).filter((i) => !list[i].fixed && !list[i].node && this.bodies.showing[i] !== "hidden");
  }
  private updateCentres(): void {
    const points = new Float32Array(this.moving().flatMap((i) => [...this.poses.position.subarray(3 * i, 3 * i + 3)]));
    this.centres.geometry.dispose();
    this.centres.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(points, 3));
  }
  private updateFrames(): void {
    const points: number[] = [], colours: number[] = [], tip = new Vector3(), at = new Vector3(), length = 0.045 * this.stage.size;
    const inks = [[0.82, 0.25, 0.17], [0.18, 0.54, 0.31], [0.18, 0.43, 0.7]];
    for (const i of this.moving().slice(0, 1000))
      inks.forEach((ink, k) => {
        this.poses.r_of(i, at);
        this.poses.point(i, [0, 1, 2].map((n) => (n === k ? length : 0)), tip);
        points.push(...at.toArray(), ...tip.toArray());
        colours.push(...ink, ...ink);
      });
    this.frames.geometry.dispose();
    this.frames.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(points), 3))
      .setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  }

  /** Paths of the centres of mass up to now: of the selected body, otherwise of up to 40 bodies. */
  private updateTrails(): void {
    const wanted = this.chosen?.kind === "body" ? [this.chosen.index] : this.moving().slice(0, 40), key = wanted.join(" ");
    if (this.trails.userData.key !== key) {
      this.trails.clear();
      this.trails.userData.key = key;
      for (const body of wanted) {
        const line = new Line(new BufferGeometry().setAttribute("position", new BufferAttribute(this.poses.path(body), 3)), new LineBasicMaterial({ color: new Color(this.bodies.colour(body)) }));
        line.frustumCulled = false;
        this.trails.add(line);
      }
    }
    for (const line of this.trails.children) (line as Line).geometry.setDrawRange(0, this.poses.frame + 1);
  }
  setTrails(on: boolean): void { this.trailsOn = this.trails.visible = on; this.update(); }
}
