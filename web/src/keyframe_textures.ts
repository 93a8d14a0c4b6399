// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the cloud's shader knows of keyframes: poses after and before the loops, and what points are coloured by. Points
// stay in their keyframe's frame, so that other poses move the whole cloud without touching it.
import * as THREE from 'three';
import { kind, ramp } from './colour';
import { MapData, sessionOf, sigmaOf } from './map_data';

export const kWidth = 1024; // texels a row
export const kSigmaRange: [number, number] = [0.01, 10]; // metres, shown on a logarithmic scale

function texture(texels: Float32Array<ArrayBuffer>): THREE.DataTexture {
  const t = new THREE.DataTexture(texels, kWidth, texels.length / 4 / kWidth, THREE.RGBAFormat, THREE.FloatType);
  t.needsUpdate = true;
  return t;
}

const rows = (texels: number) => Math.max(1, Math.ceil(texels / kWidth));

/// Four texels a keyframe: quaternion and position in the map, and in what it is compared with.
export function poseTexture(pose: Float32Array, before: Float32Array): THREE.DataTexture {
  const count = pose.length / 7;
  const texels = new Float32Array(rows(count * 4) * kWidth * 4);
  for (let k = 0; k < count; ++k) {
    const write = (from: Float32Array, at: number) => {
      texels.set(from.subarray(7 * k + 3, 7 * k + 7), at);
      texels.set(from.subarray(7 * k, 7 * k + 3), at + 4);
    };
    write(pose, 16 * k);
    write(before, 16 * k + 8);
  }
  return texture(texels);
}

export function sigmaShare(sigma_m: number): number {
  const [low, high] = kSigmaRange.map(Math.log);
  return (Math.log(Math.max(sigma_m, 1e-6)) - low) / (high - low);
}

/// One texel a keyframe: time in [0, 1], share of the uncertainty's scale, component, session.
export function traitTexture({ info, scans, keyframes }: MapData): THREE.DataTexture {
  const texels = new Float32Array(rows(keyframes.count) * kWidth * 4);
  for (let k = 0; k < keyframes.count; ++k) {
    const scan = keyframes.scan[k];
    const share = scans.count > 1 ? scan / (scans.count - 1) : 0;
    texels.set([share, sigmaShare(sigmaOf(scans, scan)), scans.component[scan], sessionOf(info, scan)], 4 * k);
  }
  return texture(texels);
}

/// Row 0: colours of amounts. Row 1: of kinds.
export function colourTexture(): THREE.DataTexture {
  const bytes = new Uint8Array(256 * 4 * 2);
  bytes.set(ramp());
  for (let i = 0; i < 256; ++i) {
    bytes.set([...kind(i).map((v) => v * 255), 255], 256 * 4 + 4 * i);
  }
  const t = new THREE.DataTexture(bytes, 256, 2);
  t.needsUpdate = true;
  return t;
}
