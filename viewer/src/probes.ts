// SPDX-License-Identifier: Apache-2.0
// Channels of the probes of a model, from its text: the scene has the model as it was written.
import type { Scene } from "./data";
import { offeredUnder } from "./series";

/** What a probe records; `vector` if it has components. */
export interface Probe { name: string; kind: string; channel: string; vector: boolean }

/** A line without its comment. */
const bare = (line: string): string => line.replace(/(^|\s)#.*$/, "");
const plain = (text: string): string => text.trim().replace(/^(["'])(.*)\1$/, "$2");
const indent = (line: string): number => line.search(/\S/);

/** Parts of a text between commas that are outside of brackets and quotes. */
function parts(text: string): string[] {
  const found = [""];
  let depth = 0, quote = "";
  for (const c of text) {
    if (quote) quote = c === quote ? "" : quote;
    else if (c === '"' || c === "'") quote = c;
    else if ("[{(".includes(c)) depth++;
    else if ("]})".includes(c)) depth--;
    if (c === "," && depth === 0 && !quote) found.push(""); else found[found.length - 1] += c;
  }
  return found.filter((part) => part.trim());
}

/** Text within the bracket that opens it; "" if it is not closed. */
function inside(text: string): string {
  let depth = 0;
  for (let i = 0; i < text.length; i++) {
    if ("[{".includes(text[i])) depth++;
    if ("]}".includes(text[i]) && --depth === 0) return text.slice(1, i);
  }
  return "";
}

/** Keys and values of a map, written in braces or as lines that are indented more. */
function entries(first: string, below: string[]): [string, string, string[]][] {
  const split = (text: string): [string, string] | null => { const m = text.match(/^\s*("[^"]*"|'[^']*'|[^:{[]+?)\s*:(?:\s+(.*)|\s*)$/s); return m && [plain(m[1]), (m[2] ?? "").trim()]; };
  if (first.startsWith("{")) return parts(inside([first, ...below].join(" "))).flatMap((part) => { const found = split(part); return found ? [[...found, []] as [string, string, string[]]] : []; });
  const lines = below.filter((line) => line.trim()), list: [string, string, string[]][] = [];
  for (const line of lines) {
    if (indent(line) > indent(lines[0])) { list[list.length - 1]?.[2].push(line); continue; }
    const found = split(line);
    if (found) list.push([...found, []]);
  }
  return list;
}

/** Names of probes, with what each of them records, in the order of the model. */
export function probeEntries(text: string): { name: string; of: Map<string, string> }[] {
  const all = entries("", text.split("\n").map(bare).filter((line) => !/^(---|%)/.test(line)));
  const output = all.find(([key]) => key === "output"), probes = output && entries(output[1], output[2]).find(([key]) => key === "probes");
  return probes ? entries(probes[1], probes[2]).map(([name, first, below]) => ({ name, of: new Map(entries(first, below).map(([key, value]) => [key, plain(value)])) })) : [];
}

/** The quantity of each probe that is plotted: position, coordinates, force and so on; probes whose quantity is not in the recording are left out. */
export function probesOf(scene: Scene): Probe[] {
  const m = scene.manifest;
  const channelOf = (of: Map<string, string>): [string, string, boolean?] | null => {
    const get = (key: string) => of.get(key) ?? "";
    if (of.has("body")) return m.bodies.some((b) => b.name === get("body")) ? ["position", `bodies.${get("body")}.position`, true] : null;
    if (of.has("joint")) {
      const joint = m.joints.find((j) => j.name === get("joint")), quantity = joint?.count ? "coordinates" : "force";
      return joint ? [`${joint.count ? joint.type ?? "" : ""} ${quantity}`, `joints.${joint.name}.${quantity}`, joint.count !== 1] : null;
    }
    if (of.has("load")) {
      const column = m.loads.find((l) => l.name === get("load"))?.columns[0];
      return column ? [`${column.name} ${column.unit}`, `loads.${get("load")}.${column.name}`, column.size > 1] : null;
    }
    if (of.has("contact")) {
      const pair = parts(get("contact").replace(/^\[|\]$/g, "")).map(plain), name = [pair.join("+"), [...pair].reverse().join("+")].find((n) => m.contacts.includes(n));
      return name ? ["normal_force", `contacts.${name}.normal_force`] : null;
    }
    if (of.has("solid") && of.has("interface")) return ["interface", `solids.${get("solid")}.interfaces.${get("interface")}.force`, true];
    if (of.has("cable")) return ["tension", `cables.${get("cable")}.tension`];
    if (of.has("beam")) return ["section", `beams.${get("beam")}.elements.force.${3 * (Number(get("element")) || 0)}`];
    if (of.has("controller")) return ["controller", offeredUnder(scene, `controllers/${get("controller")}/`)[0] ?? ""];
    return null;
  };
  return probeEntries(m.source.text).flatMap(({ name, of }) => {
    const found = channelOf(of);
    return found && found[1] ? [{ name, kind: found[0], channel: found[1], vector: found[2] ?? false }] : [];
  });
}

/** Lists of channels for the first plots: up to four probes of one kind share a plot, if they are single numbers. */
export function firstPlots(probes: Probe[], plots: number): string[][] {
  const lists: { kind: string; channels: string[] }[] = [];
  for (const { kind, channel, vector } of probes) {
    if (lists.some((list) => list.channels.includes(channel))) continue;
    const last = lists.find((list) => list.kind === kind);
    if (!last) lists.push({ kind, channels: [channel] });
    else if (!vector && last.channels.length < 4) last.channels.push(channel);
  }
  return lists.slice(0, plots).map((list) => list.channels);
}
