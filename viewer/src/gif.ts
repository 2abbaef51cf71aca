// SPDX-License-Identifier: Apache-2.0
// Animated GIF (CompuServe, Graphics Interchange Format 89a, 1990) of pictures of one size.

export interface Picture { width: number; height: number; rgba: Uint8ClampedArray }

/** Palette by median cut (Heckbert 1982) of the colours that occur, in 15 bits. */
function palette(pictures: Picture[]): { table: Uint8Array; index: Uint8Array } {
  const count = new Uint32Array(32768);
  for (const { rgba } of pictures)
    for (let i = 0; i < rgba.length; i += 4) count[(rgba[i] >> 3) << 10 | (rgba[i + 1] >> 3) << 5 | rgba[i + 2] >> 3]++;
  const part = (c: number, k: number): number => (c >> (10 - 5 * k)) & 31;
  const box = (colours: number[]) => {
    let best = 0, spread = -1, weight = 0;
    for (const c of colours) weight += count[c];
    for (let k = 0; k < 3; k++) {
      let low = 31, high = 0;
      for (const c of colours) { low = Math.min(low, part(c, k)); high = Math.max(high, part(c, k)); }
      if (high - low > spread) { spread = high - low; best = k; }
    }
    return { colours, axis: best, spread, weight, urgency: spread * Math.sqrt(weight) };
  };
  const boxes = [box([...count.keys()].filter((c) => count[c] > 0))];
  while (boxes.length < 256) {
    const at = boxes.reduce((a, b, i) => (b.spread > 0 && (a < 0 || b.urgency > boxes[a].urgency) ? i : a), -1);
    if (at < 0) break;
    const { colours, axis, weight } = boxes[at];
    colours.sort((a, b) => part(a, axis) - part(b, axis));
    let sum = 0, cut = 1;
    for (let i = 0; i < colours.length - 1; i++) { sum += count[colours[i]]; cut = i + 1; if (2 * sum >= weight) break; }
    boxes.splice(at, 1, box(colours.slice(0, cut)), box(colours.slice(cut)));
  }
  const table = new Uint8Array(768), index = new Uint8Array(32768);
  boxes.forEach(({ colours, weight }, i) => {
    for (let k = 0; k < 3; k++) table[3 * i + k] = Math.min(255, Math.round(colours.reduce((s, c) => s + count[c] * (8 * part(c, k) + 4), 0) / (weight || 1)));
    for (const c of colours) index[c] = i;
  });
  return { table, index };
}

/** Codes of variable length (Welch 1984), in blocks of 255 bytes. */
function packed(indices: Uint8Array): Uint8Array {
  const bytes: number[] = [], clear = 256, end = 257;
  let held = 0, bits = 0, size = 9, next = 258, known = new Map<number, number>();
  const put = (code: number): void => {
    held |= code << bits;
    bits += size;
    while (bits >= 8) { bytes.push(held & 255); held >>>= 8; bits -= 8; }
  };
  put(clear);
  let prefix = indices[0];
  for (let i = 1; i < indices.length; i++) {
    const key = prefix << 8 | indices[i], code = known.get(key);
    if (code !== undefined) { prefix = code; continue; }
    put(prefix);
    if (next < 4096) {
      if (next === 1 << size && size < 12) size++;
      known.set(key, next++);
    } else {
      put(clear);
      known = new Map();
      next = 258;
      size = 9;
    }
    prefix = indices[i];
  }
  put(prefix);
  if (next === 1 << size && size < 12) size++;
  put(end);
  if (bits > 0) bytes.push(held & 255);
  const blocks = new Uint8Array(2 + bytes.length + Math.ceil(bytes.length / 255));
  blocks[0] = 8;
  let at = 1;
  for (let i = 0; i < bytes.length; i += 255) {
    const block = bytes.slice(i, i + 255);
    blocks[at++] = block.length;
    blocks.set(block, at);
    at += block.length;
  }
  return blocks;
}

/** @param pictures  {width, height, rgba}, all of one size. @param rate  Pictures a second; the format counts hundredths. */
export function gif(pictures: Picture[], rate: number): Uint8Array<ArrayBuffer> {
  const { width, height } = pictures[0], { table, index } = palette(pictures), u16 = (v: number): number[] => [v & 255, v >> 8];
  const letters = (text: string): number[] => [...text].map((c) => c.charCodeAt(0));
  const parts: ArrayLike<number>[] = [letters("GIF89a"), [...u16(width), ...u16(height), 0xf7, 0, 0], table, [0x21, 0xff, 11, ...letters("NETSCAPE2.0"), 3, 1, 0, 0, 0]];
  pictures.forEach(({ rgba }, k) => {
    const wait = Math.round(100 * (k + 1) / rate) - Math.round(100 * k / rate), indices = new Uint8Array(width * height);
    for (let i = 0; i < indices.length; i++) indices[i] = index[(rgba[4 * i] >> 3) << 10 | (rgba[4 * i + 1] >> 3) << 5 | rgba[4 * i + 2] >> 3];
    parts.push([0x21, 0xf9, 4, 4, ...u16(wait), 0, 0, 0x2c, 0, 0, 0, 0, ...u16(width), ...u16(height), 0], packed(indices));
  });
  parts.push([0x3b]);
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) { all.set(part, at); at += part.length; }
  return all;
}
