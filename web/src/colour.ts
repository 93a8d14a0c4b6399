// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Colours that readers with any colour vision tell apart: Okabe and Ito for kinds, Cividis-like lightness order for
// amounts (9 anchors of Viridis by Smith and van der Walt).

export type Rgb = [number, number, number]; // 0..1

const kViridis = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
// Plasma by the same authors: what lies in the cloud must not have its colours.
const kPlasma = ['#0d0887', '#4c02a1', '#7e03a8', '#aa2395', '#cc4778', '#e66c5c', '#f89540', '#fdc527', '#f0f921'];
const kKinds = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00', '#f0e442', '#999999'];

export function rgbOf(hex: string): Rgb {
  const n = parseInt(hex.slice(1), 16);
  return [((n >> 16) & 255) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}

const kCloudAnchors = kViridis.map(rgbOf);
const kLineAnchors = kPlasma.map(rgbOf);

/// Of points of the cloud. `value` in [0, 1], clamped.
export const amount = (value: number) => between(kCloudAnchors, value);
/// Of lines in it; the darkest tenth, which a dark page hides, is left out.
export const lineAmount = (value: number) => between(kLineAnchors, 0.12 + 0.88 * Math.min(Math.max(value, 0), 1));

function between(anchors: Rgb[], value: number): Rgb {
  const at = Math.min(Math.max(value, 0), 1) * (anchors.length - 1);
  const i = Math.min(Math.floor(at), anchors.length - 2);
  const [a, b, r] = [anchors[i], anchors[i + 1], at - i];
  return [a[0] + (b[0] - a[0]) * r, a[1] + (b[1] - a[1]) * r, a[2] + (b[2] - a[2]) * r];
}

export function kind(index: number): Rgb {
  return rgbOf(kKinds[index % kKinds.length]);
}

export function css([r, g, b]: Rgb): string {
  const byte = (v: number) => Math.round(255 * v);
  return `rgb(${byte(r)} ${byte(g)} ${byte(b)})`;
}

export const kVerdictColours: Rgb[] = ['#009e73', '#8c8c8c', '#d55e00', '#cc79a7'].map(rgbOf);
export const kTrackingColours: Rgb[] = ['#0072b2', '#e69f00', '#d55e00'].map(rgbOf);
export const kStateColours: Rgb[] = ['#0072b2', '#e69f00', '#cc79a7', '#d55e00'].map(rgbOf);
export const kSourceColour: Rgb = rgbOf('#e69f00');
export const kTargetColour: Rgb = rgbOf('#56b4e9');

/// Colours of amounts as bytes, for a texture.
export function ramp(): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const c = amount(i / 255);
    bytes.set([c[0] * 255, c[1] * 255, c[2] * 255, 255], 4 * i);
  }
  return bytes;
}
