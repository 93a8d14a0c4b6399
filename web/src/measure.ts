// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Distances between points of the cloud, two clicks each.
import * as THREE from 'three';
import { rgbOf } from './colour';
import { fixed } from './dom';
import { MapView } from './map_view';
import { fill, segments } from './paths';
import { pickPoint } from './pick';

export function measured(a: THREE.Vector3, b: THREE.Vector3): string {
  return `${fixed(a.distanceTo(b), 2)} m (level ${fixed(Math.hypot(b.x - a.x, b.y - a.y), 2)} m, height ${fixed(b.z - a.z, 2)} m)`;
}

export class Measure {
  on = false;
  private first: THREE.Vector3 | null = null;
  private readonly line = segments(3, 5);

  constructor(private readonly view: MapView, private readonly tell: (text: string) => void) {
    view.scene.add(this.line);
    this.line.visible = false;
  }

  set(on: boolean): void {
    this.on = on;
    this.first = null;
    this.line.visible = false;
    this.tell(on ? 'Measuring: click the first point of the cloud.' : '');
    this.view.draw();
  }

  click(x: number, y: number): void {
    const p = pickPoint(this.view, x, y);
    if (!p) {
      this.tell('No point of the cloud there.');
    } else if (!this.first) {
      this.first = p;
      this.tell(`From ${p.toArray().map((v) => fixed(v, 2)).join(', ')} m: click the second point.`);
    } else {
      this.tell(measured(this.first, p));
      const c = rgbOf('#ff3b30');
      fill(this.line, [...this.first, ...p], [...c, ...c]);
      this.first = null;
      this.view.draw();
    }
  }
}
