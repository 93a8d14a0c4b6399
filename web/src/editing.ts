// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Changes of the run that have not been saved, and how they are undone, saved, or made by hand.
import { make } from './dom';
import { MapData } from './map_data';
import { shellWord } from './loop_words';

export interface EditActions {
  undo: () => void;
  save: () => void;
  ask: (pair: string) => void; // what registration says of two scans
}

export function editBar({ info }: MapData, actions: EditActions): HTMLElement | string {
  if (!info.edits.possible) { return ''; }
  const { unsaved } = info.edits;
  const pair = make('input', { type: 'search', placeholder: 'two scans: 120-7', 'aria-label': 'two scans to be tried as a loop', size: 14 });
  const ask = () => { if (pair.value.trim() !== '') { actions.ask(pair.value.trim()); } };
  pair.addEventListener('keydown', (e) => { if (e.key === 'Enter') { ask(); } });
  const command = `loopmark loops ${shellWord(info.run)} ${unsaved.join(' ')}`;
  return make('section', { class: 'edits', 'aria-label': 'changes' }, make('h2', {}, 'Changes'),
    make('p', { role: 'status' }, info.message ?? 'None yet: choose a loop to veto or force it.'),
    unsaved.length === 0 ? null : make('p', { class: 'command' }, make('code', {}, command)),
    make('div', { class: 'tools' }, make('button', { onclick: actions.undo, disabled: unsaved.length === 0 }, 'undo'),
      make('button', { onclick: actions.save, disabled: unsaved.length === 0 }, 'save into the run')),
    make('div', { class: 'tools' }, pair, make('button', { onclick: ask }, 'try as a loop')));
}

/// What registration said of a pair, before it counts.
export function proposalView(pair: string, words: string, force: () => void): HTMLElement {
  return make('section', { class: 'loop-panel', 'aria-label': 'a proposed loop' }, make('h2', {}, `Proposed: ${pair}`),
    make('pre', {}, words), make('button', { class: 'act', onclick: force }, 'force and solve again'));
}
