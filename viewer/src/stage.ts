// SPDX-License-Identifier: Apache-2.0
import {
  AmbientLight, ArrowHelper, Box3, Color, DirectionalLight, GridHelper, Group, HemisphereLight, OrthographicCamera, PCFShadowMap, PerspectiveCamera,
  Plane, Raycaster, Scene as World, Vector2, Vector3, WebGLRenderer,
} from "three";
import { kUnseen } from "./bodies";
import { h } from "./dom";
import { drawable, software } from "./materials";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

export const kDark = { background: "#14191f", grid: "#34404b", line: "#e6ebef" };
export const kLight = { background: "#f2f5f7", grid: "#c3ccd4", line: "#22303c" };

/** Texts in place of the picture: without WebGL 2, and from the loss of its context to the return. */
const kNone = "This browser cannot draw in 3D: WebGL 2 is off or not available. Turn on hardware acceleration, or open the page in another browser. Plots and values are shown without it.";
const kLost = "The browser has stopped drawing in 3D. The picture returns when the browser can draw again; if it does not, reload the page.";

/** Pixels of a picture for one of the window, in each direction. */
const kRatio = software ? 1 : Math.min(devicePixelRatio, 2);

/** Renderer, lights, ground grid, axes and cameras. */
export class Stage {
  readonly world = new World();
  readonly canvas = h("canvas");
  /** The renderer; null in a browser that cannot draw in 3D. */
  readonly renderer: WebGLRenderer | null;
  readonly perspective = new PerspectiveCamera(35, 1, 0.01, 1000);
  readonly parallel = new OrthographicCamera(-1, 1, 1, -1, 0.01, 1000);
  camera: PerspectiveCamera | OrthographicCamera = this.perspective;
  readonly controls: OrbitControls;
  readonly grid = new Group();
  readonly axes = new Group();
  readonly section = new Plane(new Vector3(-1, 0, 0), 0);
  private readonly sun = new DirectionalLight(0xffffff, 2.6);
  private readonly box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  /** Direction of the present view, until the user moves the camera; after that a resize changes nothing. */
  looking: Vector3 | null = null;
  size = 1;
  dirty = true;
  private moving = false;
  private part = 1;  // share of kRatio while something moves
  private drawn = false;  // a picture whose size changes is drawn again at once: it would be empty until the next one
  /** Size of the pictures of a film; null: that of the window. */
  fixedSize: [number, number] | null = null;
  /** Two pictures side by side with one camera; called with 0 and 1 before each is drawn, and with −1 afterwards. */
  halves: ((half: number) => void) | null = null;
  private readonly instead = h("p", { class: "instead", role: "alert", hidden: true });
  /** Called when the picture is replaced by a text, and when it returns. */
  onblank: () => void = () => undefined;

  constructor(readonly holder: HTMLElement, readonly up: Vector3, shadows: boolean) {
    holder.prepend(this.canvas, this.instead);
    this.renderer = this.makeRenderer();
    if (!this.renderer) this.explain(kNone);
    for (const camera of [this.perspective, this.parallel]) camera.up.copy(up);
    this.world.add(new HemisphereLight(0xffffff, 0xa8b2bb, 1.9), new AmbientLight(0xffffff, 0.5), this.sun, this.sun.target, this.grid, this.axes);
    this.sun.castShadow = shadows && !software;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.controls = new OrbitControls(this.perspective, this.canvas);
    this.controls.zoomToCursor = true;
    const before = new Vector3();  // a click alone moves no camera
    this.controls.addEventListener("start", () => { before.copy(this.camera.position); });
    this.controls.addEventListener("end", () => { if (this.camera.position.distanceTo(before) > 1e-9 * this.size) this.looking = null; });
    this.controls.addEventListener("change", () => { this.dirty = true; });
    new ResizeObserver(() => { if (this.looking) this.view(this.looking); else this.resize(); if (this.drawn) this.draw(); }).observe(holder);
  }

  private makeRenderer(): WebGLRenderer | null {
    if (!drawable) return null;
    try {
      const renderer = new WebGLRenderer({ canvas: this.canvas, antialias: !software, preserveDrawingBuffer: true });
      renderer.setPixelRatio(kRatio);
      renderer.debug.checkShaderErrors = false;  // to ask for them waits until all are compiled
      renderer.shadowMap.enabled = true;  // costs nothing while no light casts any
      renderer.shadowMap.type = PCFShadowMap;
      // These come after the renderer's own listeners, which ask for the context back and then make its objects again.
      this.canvas.addEventListener("webglcontextlost", () => this.explain(kLost));
      this.canvas.addEventListener("webglcontextrestored", () => this.explain(""));
      return renderer;
    } catch { return null; }
  }

  /** Shows a text in place of the picture; the picture again if it is empty. */
  private explain(text: string): void {
    this.instead.textContent = text;
    this.instead.hidden = text === "";
    this.holder.classList.toggle("blank", this.blank);
    this.dirty = true;
    this.onblank();
  }
  /** Whether a text stands in place of the picture. */
  get blank(): boolean { return !this.instead.hidden; }

  /** Fits light, grid and cameras to the extent of the scene. */
  fit(box: Box3): void {
    this.box.copy(box);
    const middle = box.getCenter(new Vector3());
    this.size = Math.max(box.getSize(new Vector3()).length(), 1e-9);
    const [e1, e2] = this.sides();
    this.sun.position.copy(middle).addScaledVector(this.up, this.size).addScaledVector(e1, 0.45 * this.size).addScaledVector(e2, -0.7 * this.size);
    this.sun.target.position.copy(middle);
    // Far enough for a ground well below the moving bodies: shadows of parallel light have constant width.
    const shadow = this.sun.shadow.camera, half = 0.62 * this.size;
    Object.assign(shadow, { left: -half, right: half, top: half, bottom: -half, near: 0.1 * this.size, far: 12 * this.size });
    shadow.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.002 * this.size;
    this.makeGrid(box, middle);
    this.makeAxes();
    for (const camera of [this.perspective, this.parallel]) {
      camera.near = 1e-3 * this.size;
      camera.far = 60 * this.size;
    }
    this.controls.target.copy(middle);
    this.resize();
    this.view(this.firstLook());
  }

  /** View of a planar mechanism from the front, of others obliquely. */
  firstLook(): Vector3 {
    const [e1, e2] = this.sides(), size = this.box.getSize(new Vector3()), all = [size.x, size.y, size.z], k = all.indexOf(Math.min(...all));
    const normal = new Vector3().setComponent(k, 1), right = new Vector3().crossVectors(this.up, normal);
    if (all[k] > 0.15 * Math.max(...all) || right.lengthSq() < 0.5) return e1.multiplyScalar(0.45).addScaledVector(e2, -0.85).addScaledVector(this.up, 0.42);
    if (right.dot(e1) + 0.1 * right.dot(e2) < 0) { normal.negate(); right.negate(); }
    return normal.addScaledVector(this.up, 0.16).addScaledVector(right, 0.12);
  }

  /** Two horizontal directions; the first is x of the world where x is horizontal. */
  sides(): [Vector3, Vector3] {
    const first = Math.abs(this.up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    first.addScaledVector(this.up, -first.dot(this.up)).normalize();
    return [first, new Vector3().crossVectors(this.up, first).normalize()];
  }

  private makeGrid(box: Box3, middle: Vector3): void {
    this.grid.clear();
    const step = niceStep(this.size / 12), cells = 2 * Math.ceil(1.3 * this.size / step);
    const grid = new GridHelper(cells * step, cells, this.gridColour, this.gridColour);
    grid.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), this.up);
    const low = this.lowest(box);
    const snapped = middle.clone().divideScalar(step).round().multiplyScalar(step);
    grid.position.copy(snapped).addScaledVector(this.up, low - snapped.dot(this.up) - 2e-3 * this.size);
    this.grid.add(grid);
    this.grid.userData.step = step;
  }

  private lowest(box: Box3): number {
    let low = Infinity;
    for (let i = 0; i < 8; i++)
      low = Math.min(low, new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).dot(this.up));
    return low;
  }

  private makeAxes(): void {
    this.axes.clear();
    const length = 0.1 * this.size;
    const colours = [0xd0402b, 0x2d8a4e, 0x2f6db3];
    [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)].forEach((e, i) =>
      this.axes.add(new ArrowHelper(e, new Vector3(), length, colours[i], 0.2 * length, 0.1 * length)));
  }

  private gridColour = kLight.grid;
  theme(dark: boolean): void {
    const colours = dark ? kDark : kLight;
    this.world.background = new Color(colours.background);
    this.gridColour = colours.grid;
    this.makeGrid(this.box, this.box.getCenter(new Vector3()));
    this.dirty = true;
  }

  /** View of the middle of the scene from a direction, at the smallest distance that shows all of it. */
  view(direction: Vector3): void {
    this.aim(direction, this.box);
    this.looking = direction.clone().normalize();
  }

  /** View of a part of the scene from the present direction. */
  close(box: Box3): void {
    this.aim(this.camera.position.clone().sub(this.controls.target), box);
    this.looking = null;
  }

  private aim(direction: Vector3, box: Box3): void {
    this.resize();
    const to = direction.clone().normalize(), middle = box.getCenter(new Vector3());
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(to, this.size);
    this.camera.lookAt(middle);
    this.camera.updateMatrixWorld();
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), above = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    const slope = Math.tan(this.perspective.fov * Math.PI / 360), aspect = this.perspective.aspect;
    let distance = 0, half = 0;
    for (let i = 0; i < 8; i++) {
      const c = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(middle);
      const high = Math.max(Math.abs(c.dot(above)), Math.abs(c.dot(right)) / aspect);
      distance = Math.max(distance, high / slope + c.dot(to));
      half = Math.max(half, high);
    }
    this.camera.position.copy(middle).addScaledVector(to, Math.max(1.12 * distance, Math.min(0.05 * this.size, 4 * box.getSize(new Vector3()).length())));
    this.parallel.zoom = 0.6 * this.size / (1.12 * half || 1);
    this.resize();
    this.controls.update();
    this.dirty = true;
  }

  setParallel(on: boolean): void {
    const from = this.camera, to = on ? this.parallel : this.perspective;
    if (from === to) return;
    to.position.copy(from.position);
    to.quaternion.copy(from.quaternion);
    this.camera = to;
    this.controls.object = to;
    this.resize();
    this.controls.update();
  }

  resize(): void {
    const [all, height] = this.fixedSize ?? [Math.max(1, this.holder.clientWidth), Math.max(1, this.holder.clientHeight)], width = this.halves ? Math.max(1, all / 2) : all;
    this.renderer?.setSize(all, height);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    this.controls.zoomToCursor = !this.halves;  // the cursor's place in one of two pictures is not that in both
    const half = 0.6 * this.size, wide = half * width / height;
    Object.assign(this.parallel, { left: -wide, right: wide, top: half, bottom: -half });
    this.parallel.updateProjectionMatrix();
    this.dirty = true;
  }

  get shadows(): boolean { return this.sun.castShadow; }
  set shadows(on: boolean) {
    this.sun.castShadow = on;
    this.dirty = true;
  }

  /** Reduces the rendering effort on slow machines: fewer pixels while something moves. */
  lighten(): void {
    this.part = Math.max(0.5, 0.7 * this.part);
    this.setMoving(this.moving);
  }
  /** Whether the recording plays or the user turns the camera: still pictures have all pixels, whatever they take. */
  setMoving(on: boolean): void {
    this.moving = on;
    const ratio = kRatio * (on ? this.part : 1);
    if (!this.renderer || this.fixedSize || this.renderer.getPixelRatio() === ratio) return;
    this.renderer.setPixelRatio(ratio);
    this.resize();
  }

  ray(x: number, y: number): Raycaster {
    const box = this.canvas.getBoundingClientRect();
    const caster = new Raycaster(), width = this.halves ? box.width / 2 : box.width;
    caster.setFromCamera(new Vector2(2 * ((x - box.left) % width) / width - 1, 1 - 2 * (y - box.top) / box.height), this.camera);
    caster.layers.enable(kUnseen);
    caster.params.Line = { threshold: 0.004 * this.size };
    return caster;
  }

  /** Place of a point in the window; null behind the eye. */
  pixel(point: Vector3): Vector2 | null {
    this.camera.updateMatrixWorld();
    const p = point.clone().project(this.camera), box = this.canvas.getBoundingClientRect(), width = this.halves ? box.width / 2 : box.width;
    return Math.abs(p.z) < 1 ? new Vector2(box.left + (p.x + 1) / 2 * width, box.top + (1 - p.y) / 2 * box.height) : null;
  }

  /** Half of the window that contains a point: 0, or 1 for the right one of two. */
  halfAt(x: number): number {
    const box = this.canvas.getBoundingClientRect();
    return this.halves && x - box.left > box.width / 2 ? 1 : 0;
  }

  draw(): void {
    const { renderer } = this;
    this.dirty = false;
    this.drawn = true;
    if (!renderer) return;
    const { width, height } = renderer.getSize(new Vector2());
    renderer.setScissorTest(this.halves !== null);
    if (!this.halves) {
      renderer.setViewport(0, 0, width, height);
      renderer.render(this.world, this.camera);
      return;
    }
    for (const half of [0, 1]) {
      this.halves(half);
      renderer.setViewport(half * width / 2, 0, width / 2, height);
      renderer.setScissor(half * width / 2, 0, width / 2, height);
      renderer.render(this.world, this.camera);
    }
    this.halves(-1);
  }
}

/** 1, 2 or 5 times a power of ten, at least x. */
export function niceStep(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * ([1, 2, 5, 10].find((k) => k * power >= x) ?? 10);
}
