// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What lies under a click.
import * as THREE from 'three';
import { placed } from './cloud';
import { MapView } from './map_view';

const kReach_px = 12;

function apart(p: { x: number; y: number }, a: { x: number; y: number }, b: { x: number; y: number }): number {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const length = dx * dx + dy * dy;
  const along = length === 0 ? 0 : Math.min(1, Math.max(0, ((p.x - a.x) * dx + (p.y - a.y) * dy) / length));
  return Math.hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

/// The loop whose line or dot is nearest to a position on the canvas. Dots go before lines.
export function pickLoop(view: MapView, x: number, y: number): number | null {
  let [best, nearest]: [number | null, number] = [null, kReach_px];
  for (const loop of view.loops.shown) {
    const [a, b] = view.loops.ends(loop).map((p) => view.project(p));
    if (!a || !b) { continue; }
    const line = apart({ x, y }, a, b) + 3;
    const dot = Math.hypot(x - (a.x + b.x) / 2, y - (a.y + b.y) / 2);
    if (Math.min(line, dot) < nearest) { [best, nearest] = [loop, Math.min(line, dot)]; }
  }
  return best;
}

export function pickScan(view: MapView, x: number, y: number): number | null {
  let [best, nearest]: [number | null, number] = [null, kReach_px];
  for (let i = 0; i < view.data.scans.count; ++i) {
    const p = view.project(view.path.at(i));
    const far = p ? Math.hypot(x - p.x, y - p.y) : Infinity;
    if (far < nearest) { [best, nearest] = [i, far]; }
  }
  return best;
}

/// The point of the drawn cloud that is nearest to the eye within a few pixels of the click.
export function pickPoint(view: MapView, x: number, y: number): THREE.Vector3 | null {
  const canvas = view.renderer.domElement;
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2((x / canvas.clientWidth) * 2 - 1, 1 - (y / canvas.clientHeight) * 2), view.camera);
  const poses = view.shown.before > 0.5 ? view.data.keyframes.before : view.data.keyframes.pose;
  let [best, least]: [THREE.Vector3 | null, number] = [null, Infinity];
  for (const chunk of view.cloud.chunks) {
    if (!chunk.points?.visible || !ray.ray.intersectsSphere(chunk.sphere)) { continue; }
    const drawn = chunk.points.geometry.drawRange.count;
    for (let i = 0; i < drawn; ++i) {
      const p = new THREE.Vector3().fromArray(chunk.place!, 3 * i).multiplyScalar(chunk.info.scale_m);
      placed(poses, chunk.info.first + chunk.keyframe![i], p);
      const far = p.distanceTo(view.camera.position);
      if (far < least && ray.ray.distanceToPoint(p) < Math.max(0.1, far * 0.006)) { [best, least] = [p, far]; }
    }
  }
  return best;
}
