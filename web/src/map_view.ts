// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The map in 3-D: cloud, trajectory, keyframes, loops, and what was chosen.
import * as THREE from 'three';
import { AnswerColour, AnswerMarks } from './answers';
import { Cloud } from './cloud';
import { CloudColour } from './cloud_material';
import { rgbOf } from './colour';
import { make } from './dom';
import { extents } from './layout';
import { MapData, kVerdicts } from './map_data';
import { LoopColour, LoopLines, PathColour, PathLines, Positions, fill, segments } from './paths';
import { View } from './view';

export interface Shown {
  cloud: CloudColour;
  path: PathColour;
  loops: LoopColour;
  answers: AnswerColour;
  verdicts: boolean[]; // by kVerdicts
  least_p: number;
  point_px: number;
  parts: { cloud: boolean; path: boolean; keyframes: boolean; loops: boolean; truth: boolean };
  lift: number; // metres of height for a kilometre driven
  before: number; // 0: map; 1: what it is compared with
}

export function allShown(data: MapData): Shown {
  return {
    cloud: 'height', path: data.answers ? 'plain' : data.info.components.length > 1 ? 'component' : 'sigma', loops: 'verdict', answers: 'verdict',
    verdicts: kVerdicts.map((v) => v !== 'rejected'), least_p: 0, point_px: 1.5,
    parts: { cloud: true, path: true, keyframes: data.scans.count < 3, loops: !data.answers, truth: data.scans.truth.length > 0 }, lift: 0, before: 0,
  };
}

export class MapView extends View {
  readonly cloud: Cloud;
  path!: PathLines;
  loops!: LoopLines;
  readonly keyframes: THREE.Points;
  readonly answers: AnswerMarks | null;
  readonly chosen = segments(4, 5);
  readonly marker: THREE.Mesh;
  private readonly lift = { metre_a_metre: 0 };
  private readonly labels: HTMLElement;
  private names: { text: string; at: THREE.Vector3 }[] = [];
  private readonly budget: number; // points in one picture at rest
  private moving_budget = 300_000;
  shown: Shown;

  private positions!: Positions;

  constructor(holder: HTMLElement, public data: MapData) {
    super(holder, `Map of ${data.info.name} in 3-D`);
    this.shown = allShown(data);
    this.budget = this.software ? 1_000_000 : 4_000_000;
    this.cloud = new Cloud(data);
    this.keyframes = new THREE.Points(new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ size: 5, sizeAttenuation: false, color: 0x888888, depthTest: false, transparent: true }));
    this.keyframes.frustumCulled = false;
    this.marker = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), new THREE.MeshBasicMaterial({ color: 0xff3b30 }));
    this.marker.visible = false;
    this.labels = make('div', { class: 'labels', 'aria-hidden': 'true' });
    holder.append(this.labels);
    this.answers = data.answers ? new AnswerMarks(data.answers) : null;
    if (this.answers) { this.scene.add(this.answers.dots, this.answers.lines); }
    this.scene.add(this.cloud.group, this.keyframes, this.chosen, this.marker);
    this.makeLines();
    this.before = (moving) => this.prepare(moving);
    this.nameComponents();
    this.update();
    this.overview();
  }

  /// The same run, solved anew.
  adopt(data: MapData): void {
    this.data = data;
    this.cloud.adopt(data);
    this.scene.remove(this.path.lines, this.path.truth, this.loops.lines, this.loops.dots);
    this.makeLines();
    this.nameComponents();
    this.update();
  }

  private makeLines(): void {
    this.positions = new Positions(this.data, this.lift);
    this.path = new PathLines(this.data, this.positions);
    this.loops = new LoopLines(this.data, this.positions);
    this.scene.add(this.path.lines, this.path.truth, this.loops.lines, this.loops.dots);
  }

  /// After `shown` has changed.
  update(): void {
    const s = this.shown;
    this.cloud.colour(s.cloud);
    this.lift.metre_a_metre = s.lift / 1000;
    this.positions.share = s.before;
    this.cloud.blend(s.before);
    this.cloud.group.visible = s.parts.cloud;
    this.path.update(s.path);
    this.path.lines.visible &&= s.parts.path;
    this.path.truth.visible &&= s.parts.truth;
    this.loops.update(s.parts.loops ? this.wantedLoops() : [], s.loops);
    this.answers?.update(s.answers);
    this.placeKeyframes();
    this.draw();
  }

  theme(dark: boolean): void {
    this.scene.background = new THREE.Color(dark ? '#101418' : '#f4f6f8');
    this.cloud.uniforms.lightness.value = dark ? 1 : 0.8; // the ramp's yellow end is unreadable on white
    this.cloud.uniforms.plain.value.set(dark ? '#9aa4ae' : '#5a646e');
    this.draw();
  }

  overview(): void {
    const box = new THREE.Box3();
    extents(this.data).forEach((e) => {
      if (Number.isFinite(e.low[0])) {
        box.expandByPoint(new THREE.Vector3(...e.low)).expandByPoint(new THREE.Vector3(...e.high));
      }
    });
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.look(sphere.center, Math.max(25, sphere.radius * 1.05));
  }

  showScans(first: number, last: number): void {
    const box = new THREE.Box3();
    for (let i = first; i <= last; ++i) { box.expandByPoint(this.path.at(i)); }
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.look(sphere.center, Math.max(30, sphere.radius * 1.2), 30);
  }

  mark(scan: number | null): void {
    this.marker.visible = scan !== null;
    if (scan !== null) { this.marker.position.copy(this.path.at(scan)); }
    this.draw();
  }

  markAnswer(i: number): void {
    this.marker.visible = true;
    this.marker.position.copy(this.answers!.at(i));
    this.draw();
  }

  chooseLoop(loop: number | null): void {
    const [points, colours]: number[][] = [[], []];
    if (loop !== null) {
      const [a, b] = this.loops.ends(loop);
      points.push(...a, ...b);
      const c = rgbOf('#ff3b30');
      colours.push(...c, ...c);
    }
    fill(this.chosen, points, colours);
    this.draw();
  }

  private wantedLoops(): number[] {
    const { loops } = this.data;
    const s = this.shown;
    return Array.from(loops.source.keys()).filter((i) => s.verdicts[loops.verdict[i]] && loops.p[i] >= s.least_p);
  }

  private placeKeyframes(): void {
    const { count } = this.data.keyframes;
    const points = new Float32Array(this.shown.parts.keyframes ? 3 * count : 0);
    const at = new THREE.Vector3();
    for (let k = 0; 3 * k < points.length; ++k) { this.positions.keyframe(k, at).toArray(points, 3 * k); }
    this.keyframes.geometry.dispose();
    this.keyframes.geometry = new THREE.BufferGeometry();
    this.keyframes.geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
  }

  /// What the picture needs of where the camera is now.
  private prepare(moving: boolean): void {
    const uniforms = this.cloud.uniforms;
    const focal_px = this.height_px / 2 / Math.tan((this.camera.fov * Math.PI) / 360);
    uniforms.pixels.value = 0.2 * focal_px; // a point is as large as its voxel, 0.2 m, when near
    uniforms.least.value = this.shown.point_px * this.renderer.getPixelRatio();
    // While it moves, as many points as pictures of a thirtieth of a second allow.
    this.moving_budget = Math.min(this.budget, Math.max(50_000, this.moving_budget * Math.min(1.3, 33 / Math.max(5, this.frame_ms))));
    this.cloud.detail(this.camera, this.height_px, moving ? this.moving_budget : this.budget);
    if (this.marker.visible) {
      const far = this.camera.position.distanceTo(this.marker.position);
      this.marker.scale.setScalar(Math.max(0.4, far * 0.008));
    }
    this.placeLabels();
  }

  private nameComponents(): void {
    const { info, scans } = this.data;
    this.names = info.components.length < 2 ? [] : info.components.map((c, i) => {
      const scan = scans.component.indexOf(i);
      return { text: c.name, at: this.path.at(Math.max(0, scan)) };
    });
    this.labels.replaceChildren(...this.names.map((n) => make('span', {}, n.text)));
  }

  private placeLabels(): void {
    this.names.forEach((n, i) => {
      const label = this.labels.children[i] as HTMLElement;
      const at = this.project(n.at);
      label.hidden = at === null;
      if (at) { label.style.transform = `translate(${at.x.toFixed(0)}px, ${at.y.toFixed(0)}px)`; }
    });
  }
}
