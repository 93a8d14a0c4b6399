// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A picture in 3-D: renderer, camera, controls. Drawn when something changed, not all the time.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

// Colours are given as they are to be seen (sRGB); nothing is lit.
THREE.ColorManagement.enabled = false;

export class View {
  readonly renderer: THREE.WebGLRenderer;
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(50, 1, 0.5, 10000);
  readonly controls: OrbitControls;
  before: (moving: boolean) => void = () => {}; // each picture
  frame_ms = 20; // from one picture to the next while it moves
  private last_at = -1e9;
  private wanted = false;
  private moved_at = -1e9;

  constructor(readonly holder: HTMLElement, label: string) {
    this.renderer = new THREE.WebGLRenderer({ antialias: false });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // no conversion
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', label);
    holder.append(canvas);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = false;
    this.controls.maxPolarAngle = Math.PI * 0.495;
    this.controls.mouseButtons = { LEFT: THREE.MOUSE.PAN, MIDDLE: THREE.MOUSE.DOLLY, RIGHT: THREE.MOUSE.ROTATE };
    this.controls.touches = { ONE: THREE.TOUCH.PAN, TWO: THREE.TOUCH.DOLLY_ROTATE };
    this.controls.addEventListener('change', () => { this.moved_at = performance.now(); this.draw(); });
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
  }

  /// Whether pictures are made without a graphics card.
  get software(): boolean {
    const gl = this.renderer.getContext();
    const about = gl.getExtension('WEBGL_debug_renderer_info');
    const name = about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : '';
    return /swiftshader|llvmpipe|software/i.test(name);
  }

  get height_px(): number {
    return this.renderer.domElement.height;
  }

  /// Soon, once, however often it is asked for.
  draw(): void {
    if (!this.wanted) {
      this.wanted = true;
      requestAnimationFrame(() => this.now());
    }
  }

  now(): void {
    this.wanted = false;
    const now = performance.now();
    const moving = now - this.moved_at < 200;
    if (moving && now - this.last_at < 1000) {
      this.frame_ms = 0.8 * this.frame_ms + 0.2 * (now - this.last_at);
    }
    this.last_at = now;
    this.depth();
    this.camera.updateMatrixWorld();
    this.before(moving);
    this.renderer.render(this.scene, this.camera);
    if (moving) {
      setTimeout(() => this.draw(), 220); // all detail again once it rests
    }
  }

  /// Looks at `center` from above, so that a circle of `radius` metres fills the picture.
  look(center: THREE.Vector3, radius: number, tilt_deg = 35, turn_deg = -90): void {
    const narrow = Math.min(1, this.camera.aspect);
    const distance = radius / Math.tan((this.camera.fov * Math.PI) / 360) / narrow;
    const [tilt, turn] = [(tilt_deg * Math.PI) / 180, (turn_deg * Math.PI) / 180];
    this.controls.target.copy(center);
    this.camera.position.set(Math.sin(tilt) * Math.cos(turn), Math.sin(tilt) * Math.sin(turn), Math.cos(tilt))
      .multiplyScalar(distance).add(center);
    this.controls.update();
    this.draw();
  }

  /// A position on the canvas, in CSS pixels; behind the camera: null.
  project(p: THREE.Vector3): { x: number; y: number } | null {
    const v = p.clone().applyMatrix4(this.camera.matrixWorldInverse);
    if (v.z > -this.camera.near) { return null; }
    v.applyMatrix4(this.camera.projectionMatrix);
    const { clientWidth, clientHeight } = this.renderer.domElement;
    return { x: ((v.x + 1) / 2) * clientWidth, y: ((1 - v.y) / 2) * clientHeight };
  }

  dispose(): void {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private depth(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(0.1, distance / 500);
    this.camera.far = Math.max(2000, distance * 50);
    this.camera.updateProjectionMatrix();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.holder;
    if (clientWidth > 0 && clientHeight > 0) {
      this.renderer.setSize(clientWidth, clientHeight);
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.draw();
    }
  }
}
