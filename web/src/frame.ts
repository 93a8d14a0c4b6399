// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What stands around every page: what it is, and at its end how it is used and what it is made with.
import { fixed, make } from './dom';
import { Key } from './keys';

export interface FrameInfo {
  title: string;
  name: string;
  version: string;
  facts: [string, string][];
  licences: string;
}

export function header(info: FrameInfo, toggle: () => void): HTMLElement {
  return make('header', { class: 'top' },
    make('div', {}, make('h1', {}, info.title), make('p', { class: 'name' }, info.name)),
    make('dl', { class: 'facts' }, ...info.facts.map(([k, v]) => make('div', {}, make('dt', {}, k), make('dd', {}, v)))),
    make('button', { class: 'theme', onclick: toggle, 'aria-label': 'dark or light', title: 'dark or light (d)' }, '◐'));
}

export function footer(info: FrameInfo, notes: string[], keys: Key[]): HTMLElement {
  const name = (k: string) => (k === ' ' ? 'space' : k);
  return make('footer', {}, ...notes.filter((n) => n !== '').map((n) => make('p', {}, n)),
    make('p', {}, `Keys: ${keys.map((k) => `${name(k.key)} ${k.words}`).join(', ')}. Drag to move, right button or two ` +
      'fingers to turn, wheel or pinch to zoom.'),
    make('p', {}, `Made by loopmark ${info.version}.`),
    make('details', {}, make('summary', {}, 'Licences of what this page is made with'), make('pre', {}, info.licences)));
}

/// A part of the page that opens with a click.
export function part(name: string, open: boolean, ...inside: Node[]): HTMLElement {
  return make('details', { class: 'part', open }, make('summary', {}, make('h2', {}, name)), ...inside);
}

export function timeWords(parts: [string, number][]): string {
  return parts.length === 0 ? '' : `Time taken: ${parts.map(([name, s]) => `${name} ${fixed(s, 1)} s`).join(', ')}.`;
}

export function cloudWords({ cloud }: { cloud: { points: number; of: number; voxel_m: number; rounded_m: number } }): string {
  const less = cloud.points < cloud.of ? `, about ${cloud.of.toLocaleString('en')} before they were thinned to fit` : '';
  return `The cloud has ${cloud.points.toLocaleString('en')} points${less}: at most one in ${fixed(cloud.voxel_m, 2)} m of ` +
    `what each stretch of the drive saw, rounded to ${fixed(cloud.rounded_m, 3)} m.`;
}
