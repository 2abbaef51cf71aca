// SPDX-License-Identifier: Apache-2.0
// Channels by their names for users: bodies.crank.position.x, joints.A.force, energy.kinetic.
import type { Scene } from "./data";

export interface Series { name: string; unit: string; values: Float64Array }

const kComponents: Record<number, string[]> = { 3: ["x", "y", "z"], 4: ["w", "x", "y", "z"], 6: ["xx", "yy", "zz", "xy", "yz", "xz"] };
const kBody = ["position", "velocity", "angular_velocity", "orientation"];
/** Angular velocity of a body along its own axes, which is computed from that of the world and the orientation. */
const kOwnSpin = "angular_velocity_body";
const kJoint = ["force", "moment", "coordinates", "rates"];
/** Free coordinates of joints: translations and rotations, in their order. */
export const kFreedoms: Record<string, string> = { revolute: "R", prismatic: "T", cylindrical: "TR", universal: "RR", constant_velocity: "RR", spherical: "RRR", planar: "TTR", point_in_plane: "TTRRR",
  point_on_line: "TRRR", parallel_axes: "TTTR" };
const kContact = ["gap", "normal_force", "force", "friction", "point", "points", "status", "impulse", "energy_lost"];

function column(data: Float32Array, width: number, frames: number, at: number): Float64Array {
  const values = new Float64Array(frames);
  for (let f = 0; f < frames; f++) values[f] = data[f * width + at];
  return values;
}

function magnitude(data: Float32Array, width: number, frames: number, at: number, size: number): Float64Array {
  const values = new Float64Array(frames);
  for (let f = 0; f < frames; f++) {
    let sum = 0;
    for (let k = 0; k < size; k++) sum += data[f * width + at + k] ** 2;
    values[f] = Math.sqrt(sum);
  }
  return values;
}

/** `units`: of the components, if they differ. */
interface Found { path: string; at: number; size: number; unit: string; units?: string[]; labels?: string[] }

/** Place of a quantity in its packed channel. `rest` is the component, if one is named. */
function find(scene: Scene, name: string): { found: Found; rest: string; head: string } | null {
  const m = scene.manifest;
  const split = (group: string, names: string[], quantities: string[]): { index: number; quantity: string; rest: string } | null => {
    if (!name.startsWith(group + ".")) return null;
    const tail = name.slice(group.length + 1);
    // Names may contain dots: the longest one that matches.
    let best = -1;
    names.forEach((n, i) => { if (tail.startsWith(n + ".") && (best < 0 || n.length > names[best].length)) best = i; });
    if (best < 0) return null;
    const words = tail.slice(names[best].length + 1).split(".");
    return quantities.includes(words[0]) ? { index: best, quantity: words[0], rest: words.slice(1).join(".") } : null;
  };
  const packed = (group: string, index: number, count: number, quantity: string, rest: string) => {
    const entry = scene.entry(`packed/${group}/${quantity}`);
    if (!entry) return null;
    const size = entry.data.w / count;
    return { found: { path: entry.path, at: index * size, size, unit: entry.unit }, rest,
      head: name.slice(0, rest ? name.length - rest.length - 1 : undefined) };
  };
  const body = split("bodies", m.bodies.map((b) => b.name), kBody);
  if (body) return packed("bodies", body.index, m.bodies.length, body.quantity, body.rest);
  const joint = split("joints", m.joints.map((j) => j.name), kJoint);
  if (joint) {
    if (joint.quantity === "force" || joint.quantity === "moment")
      return packed("joints", joint.index, m.joints.length, joint.quantity, joint.rest);
    const entry = scene.entry(`packed/joints/${joint.quantity}`), own = m.joints[joint.index];
    if (!entry || !own.count) return null;
    const freedoms = kFreedoms[own.type ?? ""] ?? "", per = joint.quantity === "coordinates" ? "" : "/s", unit = `rad${per} or m${per}`;
    const units = freedoms.length === own.count ? [...freedoms].map((f) => (f === "T" ? "m" : "rad") + per) : undefined;
    return { found: { path: entry.path, at: own.first ?? 0, size: own.count, unit: units?.every((u) => u === units[0]) ? units[0] : unit, units, labels: Array.from({ length: own.count }, (_, i) => `${i}`) },
      rest: joint.rest, head: `joints.${own.name}.${joint.quantity}` };
  }
  const contact = split("contacts", m.contacts, kContact);
  if (contact) return packed("contacts", contact.index, m.contacts.length, contact.quantity, contact.rest);
  for (const load of m.loads) {
    if (!name.startsWith(`loads.${load.name}.`)) continue;
    const words = name.slice(load.name.length + 7).split(".");
    let at = load.first;
    for (const c of load.columns) {
      if (c.name === words[0])
        return { found: { path: "packed/loads/values", at, size: c.size, unit: c.unit }, rest: words.slice(1).join("."), head: `loads.${load.name}.${c.name}` };
      at += c.size;
    }
  }
  // Any other channel by its path, with components behind it.
  const words = name.split(".");
  for (let k = words.length; k > 0; k--) {
    const entry = scene.entry(words.slice(0, k).join("/"));
    if (!entry || entry.path.startsWith("packed/")) continue;
    const size = entry.data.w;
    const labels = entry.dims.length === 1 && kComponents[size] ? undefined : Array.from({ length: size }, (_, i) => `${i}`);
    return { found: { path: entry.path, at: 0, size, unit: entry.unit, labels }, rest: words.slice(k).join("."), head: words.slice(0, k).join(".") };
  }
  return null;
}

/** Components of a vector (x, y, z) turned by the inverse of a unit quaternion (w, x, y, z). */
function turnedBack([w, a, b, c]: number[], [x, y, z]: number[]): number[] {
  const u = b * z - c * y, v = c * x - a * z, k = a * y - b * x;
  return [x - 2 * w * u + 2 * (b * k - c * v), y - 2 * w * v + 2 * (c * u - a * k), z - 2 * w * k + 2 * (a * v - b * u)];
}

/** Series of an angular velocity along the axes of its body, all components, one, or its size. */
async function ownSpin(scene: Scene, name: string): Promise<Series[]> {
  const at = name.lastIndexOf("." + kOwnSpin), body = name.slice(0, at), rest = name.slice(at + kOwnSpin.length + 2);
  const spin = await seriesOf(scene, `${body}.angular_velocity`), turn = await seriesOf(scene, `${body}.orientation`);
  if (spin.length !== 3 || turn.length !== 4) return [];
  const head = `${body}.${kOwnSpin}`, own = ["x", "y", "z"].map((c) => ({ name: `${head}.${c}`, unit: spin[0].unit, values: new Float64Array(scene.manifest.frames) }));
  for (let f = 0; f < scene.manifest.frames; f++) turnedBack(turn.map((q) => q.values[f]), spin.map((w) => w.values[f])).forEach((value, k) => { own[k].values[f] = value; });
  if (rest === "size") return [{ name: `${head}.size`, unit: spin[0].unit, values: own[0].values.map((x, f) => Math.hypot(x, own[1].values[f], own[2].values[f])) }];
  return rest ? own.filter((series) => series.name === `${head}.${rest}`) : own;
}

/** Series of a name. Without a component: all of them, of long lists the first eight. */
export async function seriesOf(scene: Scene, name: string): Promise<Series[]> {
  if (/^bodies\..*\.angular_velocity_body(\.|$)/.test(name.trim())) return ownSpin(scene, name.trim());
  const place = find(scene, name.trim());
  if (!place) return [];
  const { found, rest, head } = place;
  const data = await scene.channel(found.path);
  const entry = scene.entry(found.path);
  if (!data || !entry) return [];
  const frames = scene.manifest.frames, width = entry.data.w;
  if (found.size === 1) return [{ name: head, unit: found.unit, values: column(data, width, frames, found.at) }];
  const labels = found.labels ?? kComponents[found.size] ?? Array.from({ length: found.size }, (_, i) => `${i}`);
  if (rest === "size") return [{ name: `${head}.size`, unit: found.unit, values: magnitude(data, width, frames, found.at, found.size) }];
  const wanted = rest ? [labels.indexOf(rest)] : labels.map((_, i) => i).slice(0, 8);
  return wanted.filter((k) => k >= 0).map((k) => ({ name: `${head}.${labels[k]}`, unit: found.units?.[k] ?? found.unit, values: column(data, width, frames, found.at + k) }));
}

/** Series of another recording at times of this one: linear between its frames, not a number before and after them. */
export function resampled(series: Series, from: number[], to: number[]): Series {
  const values = new Float64Array(to.length), last = from.length - 1, slack = 1e-9 * Math.abs((from[last] ?? 0) - (from[0] ?? 0));
  let k = 0;
  to.forEach((t, i) => {
    while (k + 1 < last && from[k + 1] <= t) k++;
    const next = Math.min(k + 1, last), span = from[next] - from[k], part = span > 0 ? Math.min(1, Math.max(0, (t - from[k]) / span)) : 0;
    values[i] = t < from[0] - slack || t > from[last] + slack ? NaN : series.values[k] + part * (series.values[next] - series.values[k]);
  });
  return { ...series, values };
}

/** Quantities of one object, for its list of values. */
export function quantitiesOf(scene: Scene, kind: string, name: string): string[] {
  if (kind === "body") return [...kBody, kOwnSpin].map((q) => `bodies.${name}.${q}`);
  if (kind === "joint") {
    const joint = scene.manifest.joints.find((j) => j.name === name);
    return kJoint.filter((q) => joint?.count || q === "force" || q === "moment").map((q) => `joints.${name}.${q}`);
  }
  if (kind === "load") return (scene.manifest.loads.find((l) => l.name === name)?.columns ?? []).map((c) => `loads.${name}.${c.name}`);
  if (kind === "contact") return kContact.filter((q) => scene.entry(`packed/contacts/${q}`)).map((q) => `contacts.${name}.${q}`);
  return offeredUnder(scene, `${kind}s/${name}/`);
}

/** Names of channels whose paths begin with a text. */
export const offeredUnder = (scene: Scene, head: string): string[] => scene.manifest.channels.filter((c) => c.path.startsWith(head)).map((c) => c.path.replaceAll("/", "."));

/** Names for completion; for many objects only a part. */
export function offered(scene: Scene): string[] {
  const m = scene.manifest, most = 60;
  const plain = m.channels.filter((c) => !c.path.startsWith("packed/") && c.data.w <= 12).map((c) => c.path.replaceAll("/", "."));
  const of = (kind: string, names: string[]) => names.slice(0, most).flatMap((n) => quantitiesOf(scene, kind, n));
  return [...plain, ...of("body", m.bodies.filter((b) => !b.fixed && !b.node).map((b) => b.name)), ...of("joint", m.joints.map((j) => j.name)),
    ...of("load", m.loads.map((l) => l.name)), ...of("contact", m.contacts)];
}

/** Amplitude spectrum of evenly resampled values, mean removed, with a Hann window. */
export function spectrum(time: number[], values: Float64Array): { frequency: Float64Array; amplitude: Float64Array } {
  let n = 1;
  while (2 * n <= time.length && n < 16384) n *= 2;
  const re = new Float64Array(n), im = new Float64Array(n);
  const begin = time[0], span = time[time.length - 1] - begin;
  let k = 0, mean = 0;
  for (let i = 0; i < n; i++) {
    const t = begin + span * i / n;
    while (k + 2 < time.length && time[k + 1] <= t) k++;
    const part = time.length > 1 ? (t - time[k]) / (time[k + 1] - time[k] || 1) : 0;
    re[i] = values[k] + part * ((values[k + 1] ?? values[k]) - values[k]);
    mean += re[i] / n;
  }
  for (let i = 0; i < n; i++) re[i] = (re[i] - mean) * (1 - Math.cos(2 * Math.PI * i / n));
  fft(re, im);
  const half = Math.max(1, n / 2);
  const frequency = new Float64Array(half), amplitude = new Float64Array(half);
  for (let i = 0; i < half; i++) {
    frequency[i] = span > 0 ? i / span : 0;
    amplitude[i] = 2 * Math.hypot(re[i], im[i]) / n;
  }
  return { frequency, amplitude };
}

/** Radix-2 fast Fourier transform in place (Cooley and Tukey, Math. Comp. 19, 1965). */
function fft(re: Float64Array, im: Float64Array): void {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) { [re[i], re[j]] = [re[j], re[i]]; [im[i], im[j]] = [im[j], im[i]]; }
  }
  for (let size = 2; size <= n; size *= 2) {
    const angle = -2 * Math.PI / size;
    for (let i = 0; i < n; i += size)
      for (let k = 0; k < size / 2; k++) {
        const c = Math.cos(angle * k), s = Math.sin(angle * k), a = i + k, b = a + size / 2;
        const x = re[b] * c - im[b] * s, y = re[b] * s + im[b] * c;
        re[b] = re[a] - x; im[b] = im[a] - y; re[a] += x; im[a] += y;
      }
  }
}
