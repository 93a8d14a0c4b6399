// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Both ends of a loop laid on each other: the clouds around the two keyframes, in the frame of the target, placed by
// odometry alone, by the loop's own motion, or by the map.
import * as THREE from 'three';
import { Cloud, placed } from './cloud';
import { kSourceColour, kTargetColour } from './colour';
import { MapData } from './map_data';
import { View } from './view';

export type Placement = 'before' | 'loop' | 'map';
const kWantedPoints = 6000;

export function poseAt(poses: Float32Array, k: number): THREE.Matrix4 {
  const q = new THREE.Quaternion().fromArray(poses, 7 * k + 3).normalize();
  return new THREE.Matrix4().compose(new THREE.Vector3().fromArray(poses, 7 * k), q, new THREE.Vector3(1, 1, 1));
}

/// Points of a keyframe and, where it has few, of its neighbours, in the keyframe's frame. `radius`: keyframes around.
export function pointsAround(data: MapData, cloud: Cloud, k: number): Float32Array {
  for (let radius = 0; ; ++radius) {
    const points = gather(data, cloud, k, radius);
    if (points.length >= 3 * kWantedPoints || radius >= 4) {
      return new Float32Array(points);
    }
  }
}

function gather(data: MapData, cloud: Cloud, k: number, radius: number): number[] {
  const poses = data.keyframes.pose;
  const into = poseAt(poses, k).invert();
  const same = data.scans.segment[data.keyframes.scan[k]];
  const points: number[] = [];
  const p = new THREE.Vector3();
  for (const { info, place, keyframe } of cloud.chunks) {
    if (!place || !keyframe || info.first > k + radius || info.first + info.keyframes <= k - radius) { continue; }
    for (let i = 0; i < info.points; ++i) {
      const other = info.first + keyframe[i];
      if (Math.abs(other - k) > radius || data.scans.segment[data.keyframes.scan[other]] !== same) { continue; }
      placed(poses, other, p.fromArray(place, 3 * i).multiplyScalar(info.scale_m)).applyMatrix4(into);
      points.push(p.x, p.y, p.z);
    }
  }
  return points;
}

export class Overlay extends View {
  private readonly source = new THREE.Points(new THREE.BufferGeometry(), material(kSourceColour));
  private readonly target = new THREE.Points(new THREE.BufferGeometry(), material(kTargetColour));

  constructor(holder: HTMLElement, private readonly data: MapData, private readonly cloud: Cloud) {
    super(holder, 'The two scans of the loop, laid on each other');
    this.scene.add(this.target, this.source);
    this.source.matrixAutoUpdate = false;
  }

  /// Points of both, as drawn. None where the cloud of the page has none of them.
  show(loop: number): { source: number; target: number } {
    const { source, target } = this.data.loops;
    const counts = [[this.source, source[loop]], [this.target, target[loop]]].map(([points, k]) => {
      const p = points as THREE.Points;
      const places = pointsAround(this.data, this.cloud, k as number);
      p.geometry.dispose();
      p.geometry = new THREE.BufferGeometry();
      p.geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
      p.frustumCulled = false;
      return places.length / 3;
    });
    const middle = new THREE.Vector3().setFromMatrixPosition(this.motion(loop, 'map')).multiplyScalar(0.5);
    this.look(middle, 30 + middle.length(), 0.5);
    return { source: counts[0], target: counts[1] };
  }

  place(loop: number, by: Placement): void {
    this.source.matrix.copy(this.motion(loop, by));
    this.source.matrixWorldNeedsUpdate = true;
    this.draw();
  }

  /// T_target_source.
  motion(loop: number, by: Placement): THREE.Matrix4 {
    const { loops, keyframes } = this.data;
    if (by === 'loop') { return poseAt(loops.motion, loop); }
    const poses = by === 'map' ? keyframes.pose : keyframes.odometry;
    return poseAt(poses, loops.target[loop]).invert().multiply(poseAt(poses, loops.source[loop]));
  }

  theme(dark: boolean): void {
    this.scene.background = new THREE.Color(dark ? '#101418' : '#f4f6f8');
    (this.target.material as THREE.PointsMaterial).color.set(dark ? '#56b4e9' : '#0072b2');
    (this.source.material as THREE.PointsMaterial).color.set(dark ? '#e69f00' : '#c05000');
    this.draw();
  }
}

function material(colour: [number, number, number]): THREE.PointsMaterial {
  return new THREE.PointsMaterial({ size: 2, sizeAttenuation: false, color: new THREE.Color(...colour) });
}
