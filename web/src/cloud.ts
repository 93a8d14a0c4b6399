// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The cloud in chunks of consecutive keyframes. The points of a chunk are ordered from coarse to fine, so that a level of
// detail is how many of them are drawn.
import * as THREE from 'three';
import { Blocks } from './blocks';
import { CloudColour, CloudUniforms, cloudMaterial, cloudUniforms, kCloudColours } from './cloud_material';
import { colourTexture, poseTexture, traitTexture } from './keyframe_textures';
import { ChunkInfo, MapData } from './map_data';

export class Chunk {
  points?: THREE.Points;
  place?: Int16Array; // x y z of each point, in units of info.scale_m
  keyframe?: Uint16Array; // of each point, from info.first
  readonly sphere = new THREE.Sphere();

  constructor(readonly info: ChunkInfo) {}

  /// Around its keyframes, wide enough for all their points.
  bound(poses: Float32Array): void {
    const box = new THREE.Box3();
    const at = new THREE.Vector3();
    for (let k = this.info.first; k < this.info.first + this.info.keyframes; ++k) {
      box.expandByPoint(at.fromArray(poses, 7 * k));
    }
    box.getBoundingSphere(this.sphere);
    this.sphere.radius += this.info.reach_m;
  }

  async load(blocks: Blocks, shared: CloudUniforms): Promise<THREE.Points> {
    const planes = await blocks.read<Int16Array>(`${this.info.name}.xyz`);
    const runs = await blocks.read<Uint32Array>(`${this.info.name}.runs`);
    const strength = await blocks.readOr<Uint8Array>(`${this.info.name}.intensity`, new Uint8Array(this.info.points));
    const count = this.info.points;
    this.place = new Int16Array(3 * count);
    for (let axis = 0; axis < 3; ++axis) {
      for (let i = 0, at = axis; i < count; ++i, at += 3) {
        this.place[at] = planes[axis * count + i];
      }
    }
    this.keyframe = new Uint16Array(count);
    for (let run = 0, at = 0; run < runs.length; ++run) {
      this.keyframe.fill(run % this.info.keyframes, at, at + runs[run]);
      at += runs[run];
    }
    return this.build(strength, shared);
  }

  private build(strength: Uint8Array, shared: CloudUniforms): THREE.Points {
    const geometry = new THREE.BufferGeometry();
    const keyframe = new THREE.BufferAttribute(this.keyframe!, 1);
    keyframe.gpuType = THREE.IntType;
    geometry.setAttribute('place', new THREE.BufferAttribute(this.place!, 3));
    geometry.setAttribute('position', geometry.getAttribute('place'));
    geometry.setAttribute('keyframe', keyframe);
    geometry.setAttribute('strength', new THREE.BufferAttribute(strength, 1, true));
    this.points = new THREE.Points(geometry, cloudMaterial(shared, this.info.scale_m, this.info.first));
    this.points.frustumCulled = false;
    return this.points;
  }
}

export class Cloud {
  readonly group = new THREE.Group();
  readonly chunks: Chunk[];
  readonly uniforms: CloudUniforms;
  loaded = 0; // points
  drawn = 0;

  constructor(private data: MapData) {
    const { info, keyframes } = data;
    this.uniforms = cloudUniforms(poseTexture(keyframes.pose, keyframes.before), traitTexture(data), colourTexture());
    this.uniforms.height.value.fromArray(info.height_m);
    this.chunks = info.chunks.map((c) => new Chunk(c));
    this.chunks.forEach((c) => c.bound(keyframes.pose));
  }

  /// Chunk after chunk. `progress` now and then: a picture takes long where there is no graphics card.
  async load(progress: (whole: boolean) => void): Promise<void> {
    const begin = performance.now();
    let next = 100;
    for (const chunk of this.chunks) {
      this.group.add(await chunk.load(this.data.blocks, this.uniforms));
      this.loaded += chunk.info.points;
      if (performance.now() - begin > next) {
        progress(false);
        await new Promise((resume) => requestAnimationFrame(resume));
        next = 2 * (performance.now() - begin);
      }
    }
    progress(true);
  }

  /// The same points by other poses.
  adopt(data: MapData): void {
    const { keyframes } = data;
    this.data = data;
    [this.uniforms.poses, this.uniforms.traits].forEach((u) => (u.value as THREE.Texture).dispose());
    this.uniforms.poses.value = poseTexture(keyframes.pose, keyframes.before);
    this.uniforms.traits.value = traitTexture(data);
    this.chunks.forEach((c) => c.bound(keyframes.pose));
  }

  colour(by: CloudColour): void {
    this.uniforms.mode.value = kCloudColours.indexOf(by);
  }

  /// 0: the map; 1: what it is compared with.
  blend(share: number): void {
    this.uniforms.blend.value = share;
    const poses = share > 0.5 ? this.data.keyframes.before : this.data.keyframes.pose;
    this.chunks.forEach((c) => c.bound(poses));
  }

  /// Draws of each chunk what can be told apart on the screen, and at most `budget` points.
  detail(camera: THREE.PerspectiveCamera, height_px: number, budget: number): void {
    const frustum = new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const focal_px = height_px / 2 / Math.tan((camera.fov * Math.PI) / 360);
    const seen = this.chunks.filter((c) => c.points && frustum.intersectsSphere(c.sphere));
    const far = seen.map((c) => Math.max(c.sphere.distanceToPoint(camera.position), 1));
    for (let spacing_px = 0.7; ; spacing_px *= 1.3) {
      const counts = seen.map((c, i) => this.count(c, (spacing_px * far[i]) / focal_px));
      const sum = counts.reduce((a, b) => a + b, 0);
      if (sum <= budget || spacing_px > 1e3) {
        this.chunks.forEach((c) => { if (c.points) { c.points.visible = false; } });
        seen.forEach((c, i) => { c.points!.visible = counts[i] > 0; c.points!.geometry.setDrawRange(0, counts[i]); });
        this.drawn = sum;
        return;
      }
    }
  }

  /// Points of the levels down to the first whose voxels are no larger than `spacing_m`.
  private count(chunk: Chunk, spacing_m: number): number {
    const level = this.data.info.level_voxels_m.findIndex((voxel) => voxel <= spacing_m);
    const levels = chunk.info.levels;
    return level < 0 ? chunk.info.points : levels[Math.min(level, levels.length - 1)] ?? 0;
  }
}

/// Where a point of a keyframe is: pose (x y z qx qy qz qw at 7 k) times place.
export function placed(poses: Float32Array, k: number, p: THREE.Vector3): THREE.Vector3 {
  const q = new THREE.Quaternion().fromArray(poses, 7 * k + 3);
  return p.applyQuaternion(q).add(new THREE.Vector3().fromArray(poses, 7 * k));
}
