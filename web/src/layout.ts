// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Components have frames of their own: nothing says where they stand in the map. They are shown beside it, not on it.
import { MapData } from './map_data';

interface Extent { low: number[]; high: number[] }

export function extents(data: MapData): Extent[] {
  const { scans, info } = data;
  const all = info.components.map(() => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] }));
  for (let i = 0; i < scans.count; ++i) {
    const e = all[scans.component[i]];
    for (let axis = 0; axis < 3; ++axis) {
      e.low[axis] = Math.min(e.low[axis], scans.position[3 * i + axis]);
      e.high[axis] = Math.max(e.high[axis], scans.position[3 * i + axis]);
    }
  }
  return all;
}

/// Moves every component but the first to the right of those before it; returns how far each went along x.
export function layOut(data: MapData, gap_m = 60): number[] {
  const { scans, keyframes } = data;
  const all = extents(data);
  const shift = [0];
  for (let c = 1, right = all[0]?.high[0] ?? 0; c < all.length; ++c) {
    shift.push(Number.isFinite(all[c].low[0]) ? right + gap_m - all[c].low[0] : 0);
    right = Number.isFinite(all[c].high[0]) ? all[c].high[0] + shift[c] : right;
  }
  for (let i = 0; i < scans.count; ++i) {
    scans.position[3 * i] += shift[scans.component[i]] ?? 0;
  }
  for (let k = 0; k < keyframes.count; ++k) {
    keyframes.pose[7 * k] += shift[scans.component[keyframes.scan[k]]] ?? 0;
  }
  return shift;
}
