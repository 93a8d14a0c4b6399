// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
import { fixed } from './dom';
import { drivenBetween, verdictWords } from './loop_words';
import { MapData, kStates, kTrackings, sigmaOf } from './map_data';
import { timeOfDay } from './search';
import { ColumnOf, Table } from './table';

const number = <Row>(name: string, value: (row: Row) => number, decimals: number): ColumnOf<Row> =>
  ({ name, value, text: (row) => fixed(value(row), decimals) });

export function loopTable(data: MapData, choose: (loop: number) => void): Table<number> {
  const { loops, keyframes, info } = data;
  const columns: ColumnOf<number>[] = [
    { name: 'source scan', value: (i) => keyframes.scan[loops.source[i]] },
    { name: 'target scan', value: (i) => keyframes.scan[loops.target[i]] },
    { name: 'verdict', value: (i) => verdictWords(data, i) },
    number('P(correct)', (i) => loops.p[i], 3),
    { name: 'proposed by', value: (i) => info.origins[loops.origin[i]] },
    number('driven between [m]', (i) => drivenBetween(data, i), 0),
    number('weight', (i) => (loops.weight[i] > 0 ? loops.weight[i] : NaN), 2),
    number('chi2', (i) => (loops.chi2[i] > 0 ? loops.chi2[i] : NaN), 1),
  ];
  return new Table(columns, Array.from(loops.source.keys()), { file: 'loops.csv', choose, empty: 'no loop candidates' });
}

export function scanTable(data: MapData, choose: (scan: number) => void): Table<number> {
  const { scans, info } = data;
  const columns: ColumnOf<number>[] = [
    { name: 'scan', value: (i) => i },
    { name: 'time', value: (i) => scans.stamp_s[i], text: (i) => timeOfDay(scans.stamp_s[i]) },
    { name: 'pose by', value: (i) => kStates[scans.state[i]] },
    { name: 'tracking', value: (i) => kTrackings[scans.tracking[i]] },
    ...['x', 'y', 'z'].map((axis, a) => number<number>(`${axis} [m]`, (i) => scans.position[3 * i + a], 2)),
    number('1 sigma [m]', (i) => sigmaOf(scans, i), 3),
    number('speed [m/s]', (i) => scans.speed[i], 1),
    number('fit', (i) => scans.inliers[i], 2),
    { name: 'component', value: (i) => info.components[scans.component[i]]?.name ?? '' },
    { name: 'problem', value: (i) => info.problems[String(i)] ?? '' },
  ];
  if (scans.error_m.length > 0) {
    columns.splice(8, 0, number('error [m]', (i) => scans.error_m[i], 3));
  }
  return new Table(columns, Array.from(scans.state.keys()), { file: 'scans.csv', choose, empty: 'no scans' });
}

/// A table that came as words; columns of numbers sort as numbers.
export function plainTable({ title, columns, rows }: { title: string; columns: string[]; rows: string[][] }): Table<string[]> {
  const numeric = (c: number) => rows.length > 0 && rows.every((r) => r[c] !== '' && Number.isFinite(Number(r[c])));
  const made = columns.map((name, c): ColumnOf<string[]> =>
    numeric(c) ? { name, value: (r) => Number(r[c]), text: (r) => r[c] } : { name, value: (r) => r[c] });
  return new Table(made, rows, { file: `${title.replace(/\W+/g, '_')}.csv`, empty: 'nothing' });
}
