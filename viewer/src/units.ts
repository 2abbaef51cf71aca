// SPDX-License-Identifier: Apache-2.0
// Numbers with units as people write them: 2.93 MPa.
import { figure } from "./dom";

const kPrefixes: [number, string][] = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];
/** Units that take a prefix: those that begin with one of these, but not kg, which has one, nor powers such as m². */
const kTake = /^(m|N|Pa|J|W|s|Hz)(?![²³^\w])/;

/** Prefix for values of this size at most: none from 0.1 to 1000. Displayed numbers are SI values times `factor`. */
export function prefixed(unit: string, size: number): { unit: string; factor: number } {
  if (!kTake.test(unit) || / or /.test(unit) || !(size > 0) || !Number.isFinite(size) || (size >= 0.1 && size < 1000)) return { unit, factor: 1 };
  if (unit === "s" && size >= 0.1) return { unit, factor: 1 };  // nobody counts in kiloseconds
  const [power, prefix] = kPrefixes.find(([p]) => size >= p) ?? kPrefixes[kPrefixes.length - 1];
  return { unit: prefix + unit, factor: 1 / power };
}

/** A value with its unit, with four digits. */
export function quantity(value: number, unit: string): string {
  const as = prefixed(unit, Math.abs(value));
  return `${figure(value * as.factor)}${unit === "-" || unit === "" ? "" : ` ${as.unit}`}`;
}

/** Largest absolute value of several lists. */
export function largest(lists: Iterable<ArrayLike<number>>): number {
  let most = 0;
  for (const list of lists)
    for (let i = 0; i < list.length; i++) {
      const v = Math.abs(list[i]);
      if (v > most && v < Infinity) most = v;
    }
  return most;
}
