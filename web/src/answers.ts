// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Answers to "where is the sensor in this map", on the map: placed ones as dots, wrong ones with a line to the truth.
import * as THREE from 'three';
import { Blocks } from './blocks';
import { Rgb, kind, lineAmount, rgbOf } from './colour';
import { fixed } from './dom';
import { fill, segments } from './paths';
import { PlotOf } from './plots';
import { ColumnOf, Table } from './table';
import { timeOfDay } from './search';

export interface AnswerInfo { kinds: string[]; names: string[]; words: string[] }

export interface Answers extends AnswerInfo {
  count: number;
  stamp_s: Float64Array;
  position: Float32Array;
  truth: Float32Array; // not a number: unknown
  sigma_m: Float32Array;
  p: Float32Array;
  error_m: Float32Array;
  error_deg: Float32Array;
  kind: Uint8Array;
  placed: Uint8Array;
  wrong: Uint8Array;
}

export const kAnswerColours = ['verdict', 'p', 'kind'] as const;
export type AnswerColour = (typeof kAnswerColours)[number];
const kRight = rgbOf('#009e73');
const kWrong = rgbOf('#d55e00');
const kUnjudged = rgbOf('#56b4e9');

export async function readAnswers(info: AnswerInfo, b: Blocks): Promise<Answers> {
  const f32 = (name: string) => b.read<Float32Array>(`answer.${name}`);
  const u8 = (name: string) => b.read<Uint8Array>(`answer.${name}`);
  const stamp_s = await b.read<Float64Array>('answer.stamp');
  return { ...info, count: stamp_s.length, stamp_s, position: await f32('position'), truth: await f32('truth'),
    sigma_m: await f32('sigma'), p: await f32('p'), error_m: await f32('error'), error_deg: await f32('turn'),
    kind: await u8('kind'), placed: await u8('placed'), wrong: await u8('wrong') };
}

export class AnswerMarks {
  readonly dots: THREE.Points;
  readonly lines = segments(2, 6);

  constructor(readonly answers: Answers) {
    this.dots = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial(
      { size: 9, sizeAttenuation: false, vertexColors: true, depthTest: false, transparent: true }));
    this.dots.frustumCulled = false;
    this.dots.renderOrder = 7;
    this.update('verdict');
  }

  at(i: number): THREE.Vector3 {
    const { placed, position, truth } = this.answers;
    return new THREE.Vector3().fromArray(placed[i] ? position : truth, 3 * i);
  }

  update(by: AnswerColour): void {
    const a = this.answers;
    const [points, colours, ends, end_colours]: number[][] = [[], [], [], []];
    for (let i = 0; i < a.count; ++i) {
      if (!a.placed[i]) { continue; }
      const at = a.position.subarray(3 * i, 3 * i + 3);
      points.push(...at);
      colours.push(...this.colour(i, by));
      if (a.wrong[i]) {
        ends.push(...at, ...a.truth.subarray(3 * i, 3 * i + 3));
        end_colours.push(...kWrong, ...kWrong);
      }
    }
    fill(this.lines, ends, end_colours);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3));
    this.dots.geometry.dispose();
    this.dots.geometry = geometry;
  }

  private colour(i: number, by: AnswerColour): Rgb {
    const a = this.answers;
    if (by === 'p') { return lineAmount(a.p[i]); }
    if (by === 'kind') { return kind(a.kind[i]); }
    return a.wrong[i] ? kWrong : Number.isFinite(a.truth[3 * i]) ? kRight : kUnjudged;
  }
}

export const answerLegend: [string, Rgb][] = [['right', kRight], ['wrong', kWrong], ['not judged', kUnjudged]];

export function answerWords(a: Answers, i: number): string {
  const at = [0, 1, 2].map((axis) => fixed(a.position[3 * i + axis], 2)).join(', ');
  const error = Number.isFinite(a.error_m[i]) ? `, ${fixed(a.error_m[i], 2)} m and ${fixed(a.error_deg[i], 1)} deg from the truth${a.wrong[i] ? ': wrong' : ''}` : '';
  const place = a.placed[i] ? `at ${at} m, P(correct) ${fixed(a.p[i], 3)}${error}` : 'no position';
  return `${a.names[i]}: ${a.kinds[a.kind[i]]}, ${place}${a.words[i] ? `; ${a.words[i]}` : ''}`;
}

const number = (name: string, value: (i: number) => number, decimals: number): ColumnOf<number> =>
  ({ name, value, text: (i) => fixed(value(i), decimals) });

/// Wrong ones first.
export function answerTable(a: Answers, choose: (i: number) => void): Table<number> {
  const where = (i: number, axis: number) => (a.placed[i] ? a.position[3 * i + axis] : NaN);
  const verdict = (i: number) => (a.wrong[i] ? 'wrong' : !a.placed[i] ? 'no position' : Number.isFinite(a.truth[3 * i]) ? 'right' : 'not judged');
  const columns: ColumnOf<number>[] = [
    { name: 'asked about', value: (i) => a.names[i] }, { name: 'time', value: (i) => a.stamp_s[i], text: (i) => timeOfDay(a.stamp_s[i]) },
    { name: 'state', value: (i) => a.kinds[a.kind[i]] }, { name: 'verdict', value: verdict }, number('P(correct)', (i) => a.p[i], 3),
    number('error [m]', (i) => a.error_m[i], 2), number('error [deg]', (i) => a.error_deg[i], 1),
    number('x [m]', (i) => where(i, 0), 2), number('y [m]', (i) => where(i, 1), 2), { name: 'words', value: (i) => a.words[i] },
  ];
  const order = Array.from(a.kind.keys()).sort((i, j) => a.wrong[j] - a.wrong[i] || a.p[j] * a.wrong[j] - a.p[i] * a.wrong[i] || i - j);
  return new Table(columns, order, { file: 'answers.csv', choose, empty: 'no answers' });
}

export function answerPlots(a: Answers): PlotOf[] {
  const plots: PlotOf[] = [{ title: 'P(correct)', unit: '', names: ['P'], values: [a.p] }];
  if (a.sigma_m.some(Number.isFinite)) { plots.push({ title: 'Uncertainty of the position', unit: 'm', names: ['1 sigma'], values: [a.sigma_m] }); }
  if (a.error_m.some(Number.isFinite)) { plots.push({ title: 'Error against the truth', unit: 'm', names: ['error'], values: [a.error_m] }); }
  return plots;
}

export function pickAnswer(marks: AnswerMarks, project: (p: THREE.Vector3) => { x: number; y: number } | null, x: number, y: number): number | null {
  let [best, nearest]: [number | null, number] = [null, 10];
  for (let i = 0; i < marks.answers.count; ++i) {
    const p = marks.answers.placed[i] ? project(marks.at(i)) : null;
    const far = p ? Math.hypot(x - p.x, y - p.y) : Infinity;
    if (far < nearest) { [best, nearest] = [i, far]; }
  }
  return best;
}
