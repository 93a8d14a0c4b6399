// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What is known of the chosen loop: both scans laid on each other, evidence in words, the command that changes it.
import { Cloud } from './cloud';
import { make } from './dom';
import { changesFor, command, evidenceRows, loopFacts, pairName } from './loop_words';
import { MapData } from './map_data';
import { Overlay, Placement } from './overlay';

const kPlacements: [Placement, string, string][] = [
  ['before', 'odometry', 'placed by odometry alone, before any loop'],
  ['loop', 'this loop', 'placed by the motion that this loop found'],
  ['map', 'map', 'placed as in the solved map'],
];

export interface LoopActions {
  close: () => void;
  step: (by: number) => void;
  change?: (change: string, pair: string) => void; // where a server can do it
}

export class LoopPanel {
  readonly element = make('section', { class: 'loop-panel', hidden: true, 'aria-label': 'the chosen loop' });
  private readonly holder = make('div', { class: 'overlay' });
  private overlay: Overlay | null = null;
  private loop = -1;
  private placement: Placement = 'map';

  constructor(private readonly data: MapData, private readonly cloud: Cloud, private readonly actions: LoopActions,
    private readonly dark: () => boolean) {}

  show(loop: number | null): void {
    this.element.hidden = loop === null;
    if (loop === null) { return; }
    this.loop = loop;
    this.element.replaceChildren(this.header(), this.holder, this.placements(), this.status, this.facts(), ...this.commands());
    this.overlay ??= new Overlay(this.holder, this.data, this.cloud);
    this.overlay.theme(this.dark());
    this.refresh();
  }

  /// Gives back what the picture holds of the graphics card.
  dispose(): void {
    this.overlay?.dispose();
  }

  /// When more of the cloud has been read.
  refresh(): void {
    if (this.element.hidden || !this.overlay) { return; }
    const { source, target } = this.overlay.show(this.loop);
    const lacking = source === 0 || target === 0;
    this.status.textContent = lacking ? 'The page holds no points of one of the two scans (yet).' : '';
    this.setPlacement(this.placement);
  }

  theme(): void {
    this.overlay?.theme(this.dark());
  }

  setPlacement(by: Placement): void {
    this.placement = by;
    this.overlay?.place(this.loop, by);
    this.element.querySelectorAll<HTMLElement>('[data-place]').forEach((b) =>
      b.setAttribute('aria-pressed', String(b.dataset.place === by)));
  }

  private readonly status = make('p', { class: 'quiet', role: 'status' });

  private header(): HTMLElement {
    const button = (text: string, label: string, act: () => void) =>
      make('button', { onclick: act, 'aria-label': label, title: label }, text);
    return make('header', {}, make('h2', {}, `Loop ${pairName(this.data, this.loop)}`),
      button('‹', 'previous loop (p)', () => this.actions.step(-1)), button('›', 'next loop (n)', () => this.actions.step(1)),
      button('×', 'close (Escape)', () => this.actions.close()));
  }

  private placements(): HTMLElement {
    const { keyframes, scans, loops } = this.data;
    const [a, b] = [loops.source[this.loop], loops.target[this.loop]].map((k) => scans.segment[keyframes.scan[k]]);
    const [source, target] = pairName(this.data, this.loop).split('-');
    return make('div', { class: 'placements', role: 'group', 'aria-label': 'placed by' },
      ...kPlacements.filter(([by]) => by !== 'before' || a === b).map(([by, text, title]) =>
        make('button', { 'data-place': by, title, onclick: () => this.setPlacement(by) }, text)),
      make('span', { class: 'key source' }, `scan ${source}`), make('span', { class: 'key target' }, `scan ${target}`));
  }

  private facts(): HTMLElement {
    const rows = loopFacts(this.data, this.loop).map(([k, v]) => make('tr', {}, make('th', { scope: 'row' }, k), make('td', {}, v)));
    const evidence = evidenceRows(this.data, this.loop);
    return make('div', {}, make('table', { class: 'facts-table' }, make('tbody', {}, ...rows)),
      evidence.length === 0 ? make('p', { class: 'quiet' }, 'Registration left no evidence.')
        : make('details', {}, make('summary', {}, 'Evidence in words'), make('div', { class: 'wide' }, make('table', { class: 'facts-table' },
          make('tbody', {}, ...evidence.map(([words, value, scale]) => make('tr', {}, make('td', {}, words),
            make('td', { class: 'number' }, value), make('td', { class: 'quiet' }, scale))))))));
  }

  private commands(): HTMLElement[] {
    return changesFor(this.data, this.loop).map((change) => {
      const words = command(this.data, this.loop, change);
      const copy = make('button', { onclick: () => { void navigator.clipboard?.writeText(words); } }, 'copy');
      const act = this.actions.change;
      const now = act ? make('button', { class: 'act', onclick: () => act(change, pairName(this.data, this.loop)) }, `${change} and solve again`) : null;
      return make('p', { class: 'command' }, make('code', {}, words), copy, now);
    });
  }
}
