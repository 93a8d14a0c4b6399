// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Lines in the map: the trajectory, the truth, keyframes and loops.
import * as THREE from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { Rgb, lineAmount, kStateColours, kTrackingColours, kVerdictColours, kind, rgbOf } from './colour';
import { sigmaShare } from './keyframe_textures';
import { MapData, sessionOf, sigmaOf } from './map_data';

export const kPathColours = ['sigma', 'tracking', 'state', 'speed', 'error', 'component', 'session', 'plain'] as const;
export type PathColour = (typeof kPathColours)[number];
export type LoopColour = 'verdict' | 'p';

export function segments(width_px: number, order: number): LineSegments2 {
  const material = new LineMaterial({ linewidth: width_px, vertexColors: true, depthTest: false, transparent: true });
  const lines = new LineSegments2(new LineSegmentsGeometry(), material);
  lines.frustumCulled = false;
  lines.renderOrder = order; // later ones lie above; the cloud hides none
  return lines;
}

/// Positions and colours of both ends of each segment.
export function fill(lines: LineSegments2, positions: number[] | Float32Array, colours: number[] | Float32Array): void {
  lines.geometry.dispose();
  lines.geometry = new LineSegmentsGeometry();
  lines.visible = positions.length > 0;
  if (positions.length > 0) {
    lines.geometry.setPositions(positions as Float32Array);
    lines.geometry.setColors(colours as Float32Array);
  }
}

export function pathColour(data: MapData, by: PathColour): (scan: number) => Rgb {
  const { scans, info } = data;
  const fastest = scans.speed.reduce((a, b) => Math.max(a, b), 0.1);
  const worst = scans.error_m.reduce((a, b) => Math.max(a, b), 1e-3);
  switch (by) {
    case 'sigma': return (i) => lineAmount(sigmaShare(sigmaOf(scans, i)));
    case 'tracking': return (i) => kTrackingColours[scans.tracking[i]] ?? kTrackingColours[2];
    case 'state': return (i) => kStateColours[scans.state[i]];
    case 'speed': return (i) => lineAmount(scans.speed[i] / fastest);
    case 'error': return (i) => lineAmount(scans.error_m[i] / worst);
    case 'component': return (i) => kind(scans.component[i]);
    case 'session': return (i) => kind(sessionOf(info, i));
    default: return () => rgbOf('#d55e00');
  }
}

const kMostLines = 12000; // of a trajectory; more cost more than they show

/// How passes are drawn one above the other: metres of height for each metre of driving.
export interface Lift { metre_a_metre: number }

export class Positions {
  constructor(private readonly data: MapData, readonly lift: Lift) {}
  share = 0; // 0: map; 1: what it is compared with

  private mixed(map: Float32Array, before: Float32Array, at: number, axis: number): number {
    return map[at + axis] + (before[at + axis] - map[at + axis]) * this.share;
  }

  keyframe(k: number, into = new THREE.Vector3()): THREE.Vector3 {
    const { pose, before, path_m } = this.data.keyframes;
    const at = (axis: number) => this.mixed(pose, before, 7 * k, axis);
    return into.set(at(0), at(1), at(2) + path_m[k] * this.lift.metre_a_metre);
  }

  scan(i: number, driven_m: number, into = new THREE.Vector3()): THREE.Vector3 {
    const { position, before } = this.data.scans;
    const at = (axis: number) => this.mixed(position, before, 3 * i, axis);
    return into.set(at(0), at(1), at(2) + driven_m * this.lift.metre_a_metre);
  }
}

/// Metres driven until each scan.
export function drivenMetres({ scans }: MapData): Float64Array {
  const driven = new Float64Array(scans.count);
  for (let i = 1; i < scans.count; ++i) {
    const p = scans.odometry;
    const step = scans.segment[i] === scans.segment[i - 1]
      ? Math.hypot(p[3 * i] - p[3 * i - 3], p[3 * i + 1] - p[3 * i - 2], p[3 * i + 2] - p[3 * i - 1]) : 0;
    driven[i] = driven[i - 1] + step;
  }
  return driven;
}

export class PathLines {
  readonly lines = segments(3, 2);
  readonly truth = segments(1.5, 1);
  private readonly driven: Float64Array;

  constructor(private readonly data: MapData, private readonly positions: Positions) {
    this.driven = drivenMetres(data);
  }

  at(scan: number): THREE.Vector3 {
    return this.positions.scan(scan, this.driven[scan] ?? 0);
  }

  update(by: PathColour): void {
    const { scans } = this.data;
    const colour = pathColour(this.data, by);
    const [points, colours]: number[][] = [[], []];
    const [a, b] = [new THREE.Vector3(), new THREE.Vector3()];
    const step = Math.ceil(scans.count / kMostLines);
    for (let from = 0, i = step; i < scans.count; from = i, i += step) {
      if (scans.component[i] !== scans.component[from] || scans.segment[i] !== scans.segment[from]) { continue; }
      this.positions.scan(from, this.driven[from], a);
      this.positions.scan(i, this.driven[i], b);
      points.push(a.x, a.y, a.z, b.x, b.y, b.z);
      const c = colour(i);
      colours.push(...c, ...c);
    }
    fill(this.lines, points, colours);
    this.updateTruth();
  }

  private updateTruth(): void {
    const { truth, count } = this.data.scans;
    const points: number[] = [];
    const step = Math.ceil(count / kMostLines);
    for (let i = step; i < count && truth.length > 0; i += step) {
      const span = [...truth.subarray(3 * (i - step), 3 * (i - step) + 3), ...truth.subarray(3 * i, 3 * i + 3)];
      if (span.every(Number.isFinite)) { points.push(...span); }
    }
    fill(this.truth, points, new Float32Array(points.length).fill(0.6));
  }
}

export class LoopLines {
  readonly lines = segments(2, 3);
  readonly dots: THREE.Points;
  shown: number[] = []; // loops

  constructor(private readonly data: MapData, private readonly positions: Positions) {
    const material = new THREE.PointsMaterial({ size: 7, sizeAttenuation: false, vertexColors: true, depthTest: false, transparent: true });
    this.dots = new THREE.Points(new THREE.BufferGeometry(), material);
    this.dots.frustumCulled = false;
    this.dots.renderOrder = 4;
  }

  ends(loop: number): [THREE.Vector3, THREE.Vector3] {
    return [this.positions.keyframe(this.data.loops.source[loop]), this.positions.keyframe(this.data.loops.target[loop])];
  }

  middle(loop: number): THREE.Vector3 {
    const [a, b] = this.ends(loop);
    return a.lerp(b, 0.5);
  }

  update(shown: number[], by: LoopColour): void {
    const { loops } = this.data;
    this.shown = shown;
    (this.dots.material as THREE.PointsMaterial).size = shown.length > 1000 ? 3 : 7;
    const [points, colours, dots, dot_colours]: number[][] = [[], [], [], []];
    for (const i of shown) {
      const [a, b] = this.ends(i);
      const c = by === 'verdict' ? kVerdictColours[loops.verdict[i]] : lineAmount(loops.p[i]);
      points.push(a.x, a.y, a.z, b.x, b.y, b.z);
      colours.push(...c, ...c);
      dots.push((a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2);
      dot_colours.push(...c);
    }
    fill(this.lines, points, colours);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(dots, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(dot_colours, 3));
    this.dots.geometry.dispose();
    this.dots.geometry = geometry;
  }
}
