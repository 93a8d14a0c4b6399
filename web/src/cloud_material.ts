// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from 'three';
import { kWidth } from './keyframe_textures';

export const kCloudColours = ['height', 'above', 'intensity', 'time', 'sigma', 'component', 'session', 'plain'] as const;
export type CloudColour = (typeof kCloudColours)[number];

const kVertex = `
in vec3 place;
in uint keyframe;
in float strength;
uniform sampler2D poses;
uniform sampler2D traits;
uniform sampler2D colours;
uniform float scale, blend, pixels, least, lightness;
uniform int first, mode;
uniform vec2 height;
uniform vec3 plain;
out vec3 tint;

vec4 texel(sampler2D t, int i) { return texelFetch(t, ivec2(i % ${kWidth}, i / ${kWidth}), 0); }
vec3 turned(vec4 q, vec3 p) { return p + 2.0 * cross(q.xyz, cross(q.xyz, p) + q.w * p); }
vec3 amount(float share) { return texture(colours, vec2(clamp(share, 0.0, 1.0) * lightness, 0.25)).rgb; }
vec3 sort(float i) { return texelFetch(colours, ivec2(int(i), 1), 0).rgb; }

void main() {
  int k = first + int(keyframe);
  vec4 q = texel(poses, 4 * k), before = texel(poses, 4 * k + 2);
  if (dot(q, before) < 0.0) { before = -before; }
  vec3 t = mix(texel(poses, 4 * k + 1).xyz, texel(poses, 4 * k + 3).xyz, blend);
  vec3 p = turned(normalize(mix(q, before, blend)), place * scale) + t;
  vec4 trait = texel(traits, k);
  float share = (p.z - height.x) / max(height.y - height.x, 0.001);
  if (mode == 1) { share = (p.z - t.z + 3.0) / 12.0; }
  if (mode == 2) { share = strength; }
  if (mode == 3) { share = trait.x; }
  if (mode == 4) { share = trait.y; }
  tint = mode == 5 ? sort(trait.z) : mode == 6 ? sort(trait.w) : mode == 7 ? plain : amount(share);
  gl_Position = projectionMatrix * viewMatrix * vec4(p, 1.0);
  gl_PointSize = clamp(pixels / gl_Position.w, least, 4.0 * least);
}`;

const kFragment = `
in vec3 tint;
out vec4 colour;
void main() { colour = vec4(tint, 1.0); }`;

/// What all chunks of a cloud share.
export interface CloudUniforms {
  [name: string]: THREE.IUniform;
}

export function cloudUniforms(poses: THREE.Texture, traits: THREE.Texture, colours: THREE.Texture): CloudUniforms {
  return {
    poses: { value: poses }, traits: { value: traits }, colours: { value: colours }, blend: { value: 0 },
    pixels: { value: 100 }, least: { value: 1 }, mode: { value: 0 }, height: { value: new THREE.Vector2(0, 10) },
    plain: { value: new THREE.Color(0.5, 0.5, 0.5) }, lightness: { value: 1 },
  };
}

export function cloudMaterial(shared: CloudUniforms, scale: number, first: number): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: kVertex, fragmentShader: kFragment,
    uniforms: { ...shared, scale: { value: scale }, first: { value: first } },
  });
}
