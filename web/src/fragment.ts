// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A view as the end of the page's address (#c=...&t=...&loop=120-7), to be sent to somebody else.
import * as THREE from 'three';
import { MapView } from './map_view';

export interface Place {
  camera?: THREE.Vector3;
  target?: THREE.Vector3;
  loop?: string;
  scan?: number;
  cloud?: string;
  path?: string;
}

function vector(text: string | null): THREE.Vector3 | undefined {
  const values = (text ?? '').split(',').map(Number);
  return values.length === 3 && values.every(Number.isFinite) && text ? new THREE.Vector3(...values) : undefined;
}

export function parse(fragment: string): Place {
  const words = new URLSearchParams(fragment.replace(/^#/, ''));
  const scan = words.get('scan');
  return {
    camera: vector(words.get('c')), target: vector(words.get('t')), loop: words.get('loop') ?? undefined,
    scan: scan !== null && /^\d+$/.test(scan) ? Number(scan) : undefined,
    cloud: words.get('cloud') ?? undefined, path: words.get('path') ?? undefined,
  };
}

export function fragmentOf(view: MapView, chosen: { loop: string | null; scan: number | null }): string {
  const text = (v: THREE.Vector3) => v.toArray().map((x) => x.toFixed(2)).join(',');
  const words = [`c=${text(view.camera.position)}`, `t=${text(view.controls.target)}`,
    `cloud=${view.shown.cloud}`, `path=${view.shown.path}`];
  if (chosen.loop !== null) { words.push(`loop=${chosen.loop}`); }
  if (chosen.scan !== null) { words.push(`scan=${chosen.scan}`); }
  return `#${words.join('&')}`;
}
