// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What is shown, and by which colours.
import { AnswerColour, answerLegend } from './answers';
import { CloudColour } from './cloud_material';
import { css, kStateColours, kTrackingColours, kVerdictColours, kind, amount, lineAmount, Rgb } from './colour';
import { checkbox, fixed, make, select } from './dom';
import { kSigmaRange } from './keyframe_textures';
import { MapInfo, kStates, kTrackings, kVerdicts } from './map_data';
import { MapView } from './map_view';
import { LoopColour, PathColour } from './paths';

const kCloud: [CloudColour, string][] = [
  ['height', 'height'], ['above', 'height above the sensor'], ['intensity', 'intensity'], ['time', 'time'],
  ['sigma', 'uncertainty'], ['component', 'component'], ['session', 'session'], ['plain', 'one colour'],
];
const kPath: [PathColour, string][] = [
  ['sigma', 'uncertainty'], ['tracking', 'tracking'], ['state', 'how scans got their pose'], ['speed', 'speed'],
  ['error', 'error'], ['component', 'component'], ['session', 'session'], ['plain', 'one colour'],
];

function bar(low: string, high: string, lightness?: number): HTMLElement {
  const colour = (share: number) => (lightness === undefined ? lineAmount(share) : amount(share * lightness));
  const steps = Array.from({ length: 9 }, (_, i) => css(colour(i / 8)));
  return make('span', { class: 'bar' }, low, make('i', { style: `background: linear-gradient(90deg, ${steps.join(',')})` }), high);
}

function keys(names: readonly string[], colours: (i: number) => Rgb): HTMLElement {
  const shown = names.slice(0, 8);
  return make('span', { class: 'keys' }, ...shown.map((n, i) => make('span', {}, make('i', { style: `background: ${css(colours(i))}` }), n)),
    names.length > shown.length ? `and ${names.length - shown.length} more` : null);
}

function cloudLegend(view: MapView, info: MapInfo): HTMLElement | null {
  if (info.cloud.points === 0) { return null; }
  const light = view.cloud.uniforms.lightness.value as number;
  switch (view.shown.cloud) {
    case 'height': return bar(`${fixed(info.height_m[0], 1)} m`, `${fixed(info.height_m[1], 1)} m`, light);
    case 'above': return bar('-3 m', '9 m', light);
    case 'intensity': return bar(fixed(info.intensity[0], 0), fixed(info.intensity[1], 0), light);
    case 'time': return bar('first scan', 'last scan', light);
    case 'sigma': return bar(`${kSigmaRange[0]} m`, `${kSigmaRange[1]} m`, light);
    case 'component': return keys(info.components.map((c) => c.name), kind);
    case 'session': return keys(info.sessions.map((s) => s.name), kind);
    default: return null;
  }
}

function pathLegend(view: MapView): HTMLElement | null {
  const { scans, info } = view.data;
  const most = (values: Float32Array, unit: string) => `${fixed(values.reduce((a, b) => Math.max(a, b), 0), 2)} ${unit}`;
  switch (view.shown.path) {
    case 'sigma': return bar(`${kSigmaRange[0]} m`, `${kSigmaRange[1]} m`);
    case 'tracking': return keys(kTrackings, (i) => kTrackingColours[i]);
    case 'state': return keys(kStates, (i) => kStateColours[i]);
    case 'speed': return bar('0', most(scans.speed, 'm/s'));
    case 'error': return bar('0', most(scans.error_m, 'm'));
    case 'component': return keys(info.components.map((c) => c.name), kind);
    case 'session': return keys(info.sessions.map((s) => s.name), kind);
    default: return null;
  }
}

function answerKeys(view: MapView): HTMLElement | null {
  if (!view.answers) { return null; }
  const { kinds } = view.answers.answers;
  switch (view.shown.answers) {
    case 'p': return bar('P 0', 'P 1');
    case 'kind': return keys(kinds, kind);
    default: return keys(answerLegend.map(([n]) => n), (i) => answerLegend[i][1]);
  }
}

export class Toolbar {
  readonly element = make('div', { class: 'toolbar' });
  readonly legend = make('div', { class: 'legend' });
  private readonly cloud: HTMLSelectElement;
  private readonly path: HTMLSelectElement;

  constructor(private readonly view: MapView) {
    const { info, scans } = view.data;
    const s = view.shown;
    const fits = (by: string) => (by !== 'session' || info.sessions.length > 1) && (by !== 'component' || info.components.length > 1)
      && (by !== 'error' || scans.error_m.length > 0) && (by !== 'intensity' || info.intensity[1] > info.intensity[0]);
    this.cloud = select('colour of the cloud', kCloud.filter(([v]) => fits(v)), (v) => { s.cloud = v as CloudColour; this.changed(); });
    this.path = select('colour of the trajectory', kPath.filter(([v]) => fits(v)), (v) => { s.path = v as PathColour; this.changed(); });
    const compared = scans.before === scans.odometry ? 'map ↔ odometry' : 'map ↔ before the change';
    this.element.append(
      this.group('Cloud', this.part('cloud', 'shown'), this.cloud, this.range('size of points', 1, 5, 0.5, s.point_px, (v) => { s.point_px = v; })),
      this.group('Trajectory', this.part('path', 'shown'), this.path, this.part('keyframes', 'keyframes'),
        scans.truth.length > 0 ? this.part('truth', 'truth (grey)') : null),
      this.answerGroup(), this.loopGroup(),
      this.group('Look', this.range('passes one above the other', 0, 200, 5, s.lift, (v) => { s.lift = v; }, 'lift'),
        this.range('what the map is compared with', 0, 1, 0.05, s.before, (v) => { s.before = v; }, compared)));
    this.synchronise();
  }

  /// After something else has changed what is shown.
  synchronise(): void {
    this.cloud.value = this.view.shown.cloud;
    this.path.value = this.view.shown.path;
    const { loops } = this.view.shown;
    const lines = loops === 'verdict' ? keys(kVerdicts, (i) => kVerdictColours[i]) : bar('P 0', 'P 1');
    this.legend.replaceChildren(...[['Cloud', cloudLegend(this.view, this.view.data.info)], ['Trajectory', pathLegend(this.view)],
      ['Loops', this.view.data.loops.count > 0 && this.view.shown.parts.loops ? lines : null], ['Answers', answerKeys(this.view)]]
      .filter((row): row is [string, HTMLElement] => row[1] !== null)
      .map(([name, e]) => make('span', { class: 'legend-row' }, make('b', {}, name), e)));
  }

  private changed(): void {
    this.view.update();
    this.synchronise();
  }

  private group(name: string, ...parts: (Node | null)[]): HTMLElement {
    return make('fieldset', {}, make('legend', {}, name), ...parts);
  }

  private part(name: keyof MapView['shown']['parts'], label: string): HTMLElement {
    return checkbox(label, this.view.shown.parts[name], (v) => { this.view.shown.parts[name] = v; this.changed(); });
  }

  private range(label: string, min: number, max: number, step: number, value: number, set: (v: number) => void, text?: string): HTMLElement {
    const slider = make('input', { type: 'range', min, max, step, value, 'aria-label': label, title: label });
    slider.addEventListener('input', () => { set(Number(slider.value)); this.view.update(); });
    return make('label', { class: 'range' }, text ?? '', slider);
  }

  private answerGroup(): HTMLElement | string {
    const { shown, answers } = this.view;
    return !answers ? '' : this.group('Answers', select('colour of the answers', [['verdict', 'right or wrong'], ['p', 'P(correct)'], ['kind', 'state']],
      (v) => { shown.answers = v as AnswerColour; this.changed(); }));
  }

  private loopGroup(): HTMLElement | string {
    const { shown, data } = this.view;
    if (data.loops.count === 0) { return ''; }
    const counts = kVerdicts.map((_, v) => data.loops.verdict.reduce((n, x) => n + (x === v ? 1 : 0), 0));
    const boxes = kVerdicts.map((name, v) => counts[v] === 0 ? null
      : checkbox(`${name} (${counts[v]})`, shown.verdicts[v], (on) => { shown.verdicts[v] = on; this.changed(); }));
    return this.group('Loops', this.part('loops', 'shown'), ...boxes,
      select('colour of loops', [['verdict', 'verdict'], ['p', 'P(correct)']], (v) => { shown.loops = v as LoopColour; this.changed(); }),
      this.range('least P(correct)', 0, 1, 0.05, shown.least_p, (v) => { shown.least_p = v; }, 'P ≥'));
  }
}
