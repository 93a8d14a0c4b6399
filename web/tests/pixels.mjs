// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Pictures as numbers, and where a pinhole camera sees a point: its own arithmetic, not the page's.
import { inflateSync } from 'node:zlib';

/// An 8-bit PNG without interlacing (what the browser writes), as {width, height, at(x, y) -> [r, g, b]}.
export function readPng(bytes) {
  const idat = [];
  let header;
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
    const [length, type] = [bytes.readUInt32BE(at), bytes.toString('latin1', at + 4, at + 8)];
    const data = bytes.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') { header = { width: data.readUInt32BE(0), height: data.readUInt32BE(4), depth: data[8], colour: data[9], interlace: data[12] }; }
    if (type === 'IDAT') { idat.push(data); }
  }
  const channels = { 2: 3, 6: 4 }[header.colour];
  if (header.depth !== 8 || !channels || header.interlace !== 0) { throw new Error('not the kind of PNG that is expected'); }
  const raw = unfiltered(inflateSync(Buffer.concat(idat)), header.width * channels, header.height, channels);
  const at = (x, y) => [...raw.subarray((y * header.width + x) * channels, (y * header.width + x) * channels + 3)];
  return { width: header.width, height: header.height, at };
}

function paeth(a, b, c) {
  const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// PNG (ISO/IEC 15948), section 9: each row says how it was predicted from its neighbours.
function unfiltered(data, stride, height, step) {
  const out = new Uint8Array(stride * height);
  for (let y = 0; y < height; ++y) {
    const kind = data[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x >= step ? out[y * stride + x - step] : 0;
      const up = y > 0 ? out[(y - 1) * stride + x] : 0;
      const corner = x >= step && y > 0 ? out[(y - 1) * stride + x - step] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][kind];
      out[y * stride + x] = data[y * (stride + 1) + 1 + x] + guess;
    }
  }
  return out;
}

const minus = (a, b) => a.map((v, i) => v - b[i]);
const dot = (a, b) => a.reduce((s, v, i) => s + v * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.sqrt(dot(a, a)));

/// Pixel of a point for a camera at `eye` that looks at `target`, z up, with a vertical field of view of 50 degrees.
export function project(point, eye, target, width, height) {
  const ahead = unit(minus(target, eye));
  const right = unit(cross(ahead, [0, 0, 1]));
  const up = cross(right, ahead);
  const p = minus(point, eye);
  const focal = height / 2 / Math.tan((25 * Math.PI) / 180);
  return [width / 2 + (focal * dot(p, right)) / dot(p, ahead), height / 2 - (focal * dot(p, up)) / dot(p, ahead)];
}
