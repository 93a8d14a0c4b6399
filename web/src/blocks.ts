// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a page: <script type="text/plain" class="block" data-name data-type data-filter> with base64 of zlib.
// Filters undo what the writer did to make columns compress: "planes" (bytes of equal rank together), then "delta"
// (zigzag differences).

export type Column = Float32Array | Float64Array | Uint8Array | Uint16Array | Int16Array | Uint32Array | Int32Array;

const kMakers: Record<string, (bytes: ArrayBuffer) => Column> = {
  f32: (b) => new Float32Array(b),
  f64: (b) => new Float64Array(b),
  u8: (b) => new Uint8Array(b),
  u16: (b) => new Uint16Array(b),
  i16: (b) => new Int16Array(b),
  u32: (b) => new Uint32Array(b),
  i32: (b) => new Int32Array(b),
};
const kSizes: Record<string, number> = { f32: 4, f64: 8, u8: 1, u16: 2, i16: 2, u32: 4, i32: 4 };

type FromBase64 = { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };

export function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const native = (Uint8Array as unknown as FromBase64).fromBase64;
  if (native) {
    return native.call(Uint8Array, text);
  }
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) {
    bytes[i] = letters.charCodeAt(i);
  }
  return bytes;
}

export async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

export function withoutPlanes(planes: ArrayBuffer, size: number): ArrayBuffer {
  const from = new Uint8Array(planes);
  const count = from.length / size;
  const to = new Uint8Array(from.length);
  for (let plane = 0; plane < size; ++plane) {
    for (let i = 0, at = plane, begin = plane * count; i < count; ++i, at += size) {
      to[at] = from[begin + i];
    }
  }
  return to.buffer;
}

/// In place; the typed array wraps round as the writer's integers did.
export function undoDelta(column: Column): void {
  let value = 0;
  for (let i = 0; i < column.length; ++i) {
    const zigzag = column[i] & (column.BYTES_PER_ELEMENT === 2 ? 0xffff : 0xffffffff);
    value = (value + ((zigzag >>> 1) ^ -(zigzag & 1))) | 0;
    column[i] = value;
    value = column[i] | 0;
  }
}

export function decoded(raw: ArrayBuffer, type: string, filter: string): Column {
  const size = kSizes[type];
  const bytes = filter.includes('planes') ? withoutPlanes(raw, size) : raw;
  const column = kMakers[type](bytes);
  if (filter.includes('delta')) {
    undoDelta(column);
  }
  return column;
}

/// Reads blocks by name; the text of each leaves the document once it is read.
export class Blocks {
  private readonly elements = new Map<string, HTMLElement>();

  constructor(root: ParentNode) {
    root.querySelectorAll<HTMLElement>('script.block').forEach((e) => this.elements.set(e.dataset.name ?? '', e));
  }

  has(name: string): boolean {
    return this.elements.has(name);
  }

  async read<T extends Column>(name: string): Promise<T> {
    const element = this.elements.get(name);
    if (!element) {
      throw new Error(`the page has no block ${name}`);
    }
    this.elements.delete(name);
    const raw = await inflated(bytesOfBase64((element.textContent ?? '').trim()));
    const column = decoded(raw, element.dataset.type ?? '', element.dataset.filter ?? '') as T;
    element.remove();
    return column;
  }

  /// An empty column where the page has none.
  async readOr<T extends Column>(name: string, empty: T): Promise<T> {
    return this.has(name) ? this.read<T>(name) : empty;
  }
}
