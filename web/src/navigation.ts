// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Moving through the map without a mouse.
import { MapView } from './map_view';

const kScanTime_ms = 100;

export class Navigation {
  private riding = 0;

  /// `scan`: where one is; `choose`: goes to another.
  constructor(private readonly view: MapView, private readonly scan: () => number | null, private readonly choose: (scan: number) => void) {}

  above(): void {
    const { camera, controls } = this.view;
    const far = camera.position.distanceTo(controls.target);
    this.view.look(controls.target.clone(), far * Math.tan((camera.fov * Math.PI) / 360) * Math.min(1, camera.aspect), 0.1);
  }

  /// By tenths of the distance to what is looked at, to the right and ahead.
  pan(right: number, ahead: number): void {
    const { camera, controls } = this.view;
    const step = camera.position.distanceTo(controls.target) * 0.1;
    const forward = controls.target.clone().sub(camera.position).setZ(0).normalize();
    const move = forward.clone().multiplyScalar(ahead * step).add(forward.cross(camera.up).multiplyScalar(right * step));
    camera.position.add(move);
    controls.target.add(move);
    controls.update();
    this.view.draw();
  }

  zoom(by: number): void {
    const { camera, controls } = this.view;
    camera.position.sub(controls.target).multiplyScalar(by).add(controls.target);
    controls.update();
    this.view.draw();
  }

  /// Along the trajectory from where one is; again: stops.
  ride(): void {
    if (this.riding) {
      clearInterval(this.riding);
      this.riding = 0;
    } else {
      this.riding = window.setInterval(() => this.next(), kScanTime_ms);
    }
  }

  private next(): void {
    const { camera, controls, data } = this.view;
    const next = (this.scan() ?? -1) + 1;
    if (next >= data.scans.count) {
      this.ride();
      return;
    }
    this.choose(next);
    const at = this.view.path.at(next);
    camera.position.add(at).sub(controls.target);
    controls.target.copy(at);
    controls.update();
  }
}
