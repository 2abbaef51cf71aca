// SPDX-License-Identifier: Apache-2.0
// Scene as `polhode view` writes it (src/polhode/view/scene.cpp) and its packed numbers.

export interface Packed { c: number; n: number; w: number; t: "f" | "u" }
export type Triple = [number, number, number];
export type Four = [number, number, number, number];
export interface MeshEntry { points: Packed; triangles: Packed; type: string }
export interface PartEntry { mesh?: number; plane?: Triple; p: Triple; q?: Four }
export interface BodyEntry { name: string; line?: number; fixed?: boolean; color?: string; mass?: number; node?: boolean; parts?: PartEntry[]; mark?: string }
export interface JointEntry {
  name: string; type?: string; first?: number; count?: number; line?: number; mark?: string;
  a?: number; b?: number; Za?: Triple; Zb?: Triple; q?: Four;
}
export interface LoadEntry {
  name: string; type: string; first: number; columns: { name: string; unit: string; size: number }[];
  line?: number; a?: number; b?: number; Za?: Triple; Zb?: Triple; joint?: string; damping?: number; stiffness?: number; coil?: boolean; damper?: boolean;
}
/** Values at the visible nodes or elements. */
export interface FieldEntry { name: string; of?: "nodes" | "elements"; unit: string; size: number; data: Packed }
export interface SolidEntry {
  name: string; nodes: number; elements: number; shown: number[]; reference: Packed; triangles: Packed; edges: Packed;
  owners?: Packed;  // elements of the triangles, by their rows in fields
  fields: FieldEntry[]; line?: number;
}
export interface BeamEntry { name: string; line?: number; section?: string; height?: number; width?: number }
export interface CableEntry { name: string; line?: number; radius?: number }
export interface ChannelEntry { path: string; unit: string; dims: number[]; data: Packed }
export interface Manifest {
  format: string; version: number; title: string; name?: string; compared?: string; frames: number; file_frames: number; time: number[]; statics: boolean; energy_drift?: number;
  cut_short: boolean; notes: string[]; gravity?: Triple;
  source: { file: string; text: string; overrides: string[]; version: string; solver: string };
  meshes: MeshEntry[]; bodies: BodyEntry[]; joints: JointEntry[]; loads: LoadEntry[]; solids: SolidEntry[];
  beams: BeamEntry[]; cables: CableEntry[]; contacts: string[]; channels: ChannelEntry[];
}

/** Script element of the player: data before it in the page are available, data after it are still being read. */
const player = document.currentScript;

const readToTheEnd = (): Promise<unknown> =>
  (document.readyState === "loading" ? new Promise((resolve) => document.addEventListener("DOMContentLoaded", resolve, { once: true })) : Promise.resolve());

function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> }).fromBase64;
  if (native) return native(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Inverse of pack_floats() and pack_integers() in src/polhode/view/chunk.cpp. */
function unpack(bytes: Uint8Array, width: number): Uint32Array<ArrayBuffer> {
  const n = bytes.length / 4;
  const words = new Uint32Array(n);
  for (let i = 0; i < n; i++) {
    const delta = bytes[i] | (bytes[n + i] << 8) | (bytes[2 * n + i] << 16) | (bytes[3 * n + i] << 24);
    words[i] = i < width ? delta : words[i - width] + delta;
  }
  return words;
}

export class Scene {
  private readonly kept = new Map<number, Promise<Uint32Array<ArrayBuffer>>>();
  private readonly byPath = new Map<string, ChannelEntry>();

  private constructor(readonly manifest: Manifest, readonly served: boolean, private readonly suffix: string) {
    for (const channel of manifest.channels) this.byPath.set(channel.path, channel);
  }

  /** Scene inside the page, or from its server; the second scene is the one for comparison. */
  static async load(second = false): Promise<Scene> {
    const suffix = second ? "-1" : "", inside = document.getElementById(`polhode-scene${suffix}`);
    if (inside) {
      const manifest = JSON.parse(inside.textContent ?? "") as Manifest;
      inside.remove();
      return new Scene(Scene.checked(manifest), false, suffix);
    }
    if (location.protocol === "file:") throw new Error("This page contains no results. Make one with 'polhode view RESULTS --html FILE'.");
    if (!second) Scene.stamp = await Scene.askStamp();
    const answer = await fetch(`scene${suffix}.json`);
    const text = await answer.text();
    // Error message of the server as plain text.
    if (!answer.ok || answer.headers.get("content-type")?.startsWith("text/plain")) throw new Error(text);
    return new Scene(Scene.checked(JSON.parse(text) as Manifest), true, suffix);
  }

  /** Time at which the served file was saved, queried before it is read, so that later changes are detected. */
  static stamp = "";
  static askStamp(): Promise<string> { return fetch("stamp").then((answer) => answer.text()); }

  private static checked(manifest: Manifest): Manifest {
    if (manifest.format !== "polhode scene" || manifest.version !== 1)
      throw new Error(`This page reads scenes of version 1, and this one has version ${manifest.version}.`);
    return manifest;
  }

  private async bytes(index: number): Promise<Uint8Array<ArrayBuffer>> {
    if (this.served) return new Uint8Array(await (await fetch(`chunk${this.suffix}/${index}`)).arrayBuffer());
    const id = `chunk${this.suffix}-${index}`;
    let element = document.getElementById(id);
    if (!element || !player || !(element.compareDocumentPosition(player) & Node.DOCUMENT_POSITION_FOLLOWING)) {
      await readToTheEnd();
      element = document.getElementById(id);
    }
    if (!element) throw new Error(`This page is incomplete: part ${index} is missing. Copy the file again.`);
    const bytes = bytesOfBase64(element.textContent ?? "");
    element.remove();
    return bytes;
  }

  private words(packed: Packed): Promise<Uint32Array<ArrayBuffer>> {
    let words = this.kept.get(packed.c);
    if (!words) {
      words = this.bytes(packed.c).then(inflate).then((bytes) => unpack(bytes, packed.w));
      this.kept.set(packed.c, words);
    }
    return words;
  }

  async floats(packed: Packed): Promise<Float32Array<ArrayBuffer>> { return new Float32Array((await this.words(packed)).buffer); }
  integers(packed: Packed): Promise<Uint32Array<ArrayBuffer>> { return this.words(packed); }

  entry(path: string): ChannelEntry | undefined { return this.byPath.get(path); }
  /** Numbers of a channel, frame by frame; null if the channel does not exist. */
  async channel(path: string): Promise<Float32Array<ArrayBuffer> | null> {
    const entry = this.byPath.get(path);
    return entry ? this.floats(entry.data) : null;
  }
}

/** Row of a time between frames: the frame before it and the fraction of the interval to the next one. */
export function frameAt(time: number[], t: number): { frame: number; part: number } {
  const last = time.length - 1;
  if (last <= 0 || t <= time[0]) return { frame: 0, part: 0 };
  if (t >= time[last]) return { frame: last, part: 0 };
  let low = 0, high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (time[middle] <= t) low = middle; else high = middle;
  }
  const span = time[high] - time[low];
  return { frame: low, part: span > 0 ? (t - time[low]) / span : 0 };
}
