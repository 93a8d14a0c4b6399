// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// The page of a map: the view and what was chosen in it, findings, plots, tables.
import { Found, find, timeOfDay } from './search';
import { answerPlots, answerTable, answerWords, pickAnswer } from './answers';
import { editBar, proposalView } from './editing';
import { findingList } from './findings';
import { fragmentOf, parse } from './fragment';
import { cloudWords, footer, header, part, timeWords } from './frame';
import { fixed, make, save } from './dom';
import { Key, listen } from './keys';
import { Link, MapData, kStates, kTrackings, keyframeOfScan, sigmaOf } from './map_data';
import { LoopPanel } from './loop_panel';
import { MapView } from './map_view';
import { Measure } from './measure';
import { Navigation } from './navigation';
import { Plots, mapPlots } from './plots';
import { Theme } from './theme';
import { Toolbar } from './toolbar';
import { CloudColour, kCloudColours } from './cloud_material';
import { PathColour, kPathColours } from './paths';
import { layOut } from './layout';
import { loopTable, plainTable, scanTable } from './map_tables';
import { pairName } from './loop_words';
import { pickLoop, pickScan } from './pick';
import { proposal, solveAgain } from './server';

export class MapPage {
  readonly element = make('div', { class: 'page' });
  readonly view: MapView;
  loop: number | null = null;
  scan: number | null = null;
  private readonly holder = make('div', { class: 'map' });
  private readonly told = make('div', { class: 'told', role: 'status' });
  private readonly loading = make('span', { class: 'loading' });
  private readonly proposed = make('div');
  private panel!: LoopPanel;
  private toolbar!: Toolbar;
  private plots!: Plots;
  private readonly measure: Measure;
  private readonly theme = new Theme(() => this.themed());
  private readonly slider: HTMLInputElement;
  private readonly navigation: Navigation;

  constructor(private data: MapData) {
    layOut(data);
    this.view = new MapView(this.holder, data);
    this.navigation = new Navigation(this.view, () => this.scan, (i) => this.chooseScan(i, false));
    this.measure = new Measure(this.view, (text) => this.tell(text));
    this.slider = make('input', { type: 'range', min: 0, max: Math.max(0, data.scans.count - 1), value: 0, 'aria-label': 'scan' });
    this.slider.addEventListener('input', () => this.chooseScan(Number(this.slider.value), false));
    this.holder.append(this.bar(), this.told);
    this.build();
    this.clicks();
    listen(this.keys());
  }

  /// All that depends on how the map is solved.
  private build(): void {
    const { data } = this;
    const change = (what: string, pair: string) => { void this.change('loops', `--${what} ${pair}`); };
    this.panel?.dispose();
    this.panel = new LoopPanel(data, this.view.cloud, { close: () => this.chooseLoop(null), step: (by) => this.step(by),
      change: data.info.edits.possible ? change : undefined }, () => this.theme.dark);
    this.toolbar = new Toolbar(this.view);
    this.plots = data.answers
      ? new Plots(answerPlots(data.answers), data.answers.count, { hover: (i) => { if (i !== null) { this.chooseAnswer(i, false); } }, choose: (i) => this.chooseAnswer(i, true) })
      : new Plots(mapPlots(data), data.scans.count, { hover: (s) => this.view.mark(s ?? this.scan), choose: (s) => this.chooseScan(s, true) });
    this.proposed.replaceChildren();
    this.element.replaceChildren(header(data.info, () => this.theme.toggle()), this.stage(), this.below());
  }

  /// Has the server do something, and shows the map that comes of it.
  private async change(action: 'loops' | 'undo' | 'save', words: string): Promise<void> {
    this.tell('Solving …');
    const chosen = this.loop === null ? null : pairName(this.data, this.loop);
    try {
      this.data = await solveAgain(this.data, action, words);
      layOut(this.data);
      this.view.adopt(this.data);
      this.build();
      this.themed();
      this.tell(this.data.info.message ?? '');
      const again = chosen === null ? null : find(this.data, chosen);
      this.chooseLoop(again && 'loop' in again ? again.loop : null);
    } catch (problem) {
      this.tell(problem instanceof Error ? problem.message : String(problem));
    }
  }

  private async propose(pair: string): Promise<void> {
    this.tell(`Registering ${pair} …`);
    try {
      const words = await proposal(pair);
      this.proposed.replaceChildren(proposalView(pair, words, () => { void this.change('loops', `--force ${pair}`); }));
      this.tell('');
    } catch (problem) {
      this.tell(problem instanceof Error ? problem.message : String(problem));
    }
  }

  /// Once the element is part of the document.
  async begin(): Promise<void> {
    this.theme.apply();
    this.view.overview();
    this.go(location.hash);
    addEventListener('hashchange', () => this.go(location.hash));
    this.view.controls.addEventListener('end', () => this.remember());
    this.view.now();
    document.documentElement.dataset.state = 'shown';
    await this.view.cloud.load((whole) => this.loaded(whole));
    this.panel.refresh();
    document.documentElement.dataset.state = 'whole';
  }

  chooseLoop(loop: number | null): void {
    this.loop = loop;
    this.view.chooseLoop(loop);
    this.panel.show(loop);
    this.element.classList.toggle('with-loop', loop !== null);
    this.remember();
  }

  chooseScan(scan: number | null, look: boolean): void {
    this.scan = scan;
    this.view.mark(scan);
    if (scan === null) { return; }
    this.slider.value = String(scan);
    if (look) { this.view.look(this.view.path.at(scan), 40, 45); }
    this.tell(this.scanWords(scan));
    this.remember();
  }

  follow(link: Link): void {
    if (link.kind === 'loop') {
      this.showLoop(link.first);
    } else if (link.kind === 'answer') {
      this.chooseAnswer(link.first, true);
    } else {
      this.view.showScans(link.first, link.last);
      this.chooseScan(link.first, false);
    }
    this.holder.scrollIntoView({ block: 'nearest' });
  }

  chooseAnswer(i: number, look: boolean): void {
    const { answers } = this.data;
    if (!answers) { return; }
    this.tell(answerWords(answers, i));
    if (answers.placed[i] || Number.isFinite(answers.truth[3 * i])) {
      this.view.markAnswer(i);
      if (look) { this.view.look(this.view.answers!.at(i), 50, 30); }
    }
  }

  showLoop(loop: number): void {
    const [a, b] = this.view.loops.ends(loop);
    this.view.look(this.view.loops.middle(loop), Math.max(30, a.distanceTo(b)), 35);
    this.chooseLoop(loop);
  }

  private scanWords(i: number): string {
    const { scans, keyframes, info } = this.data;
    const k = keyframeOfScan(keyframes, i);
    const name = keyframes.scan[k] === i ? ` (keyframe k${k})` : '';
    const problem = info.problems[String(i)] ? `; ${info.problems[String(i)]}` : '';
    const p = [0, 1, 2].map((a) => fixed(scans.position[3 * i + a], 2)).join(', ');
    return `Scan ${i}${name} at ${timeOfDay(scans.stamp_s[i])}: ${kStates[scans.state[i]]}, tracking ${kTrackings[scans.tracking[i]]}, ` +
      `${p} m, 1 sigma ${fixed(sigmaOf(scans, i), 2)} m, ${fixed(scans.speed[i], 1)} m/s${problem}`;
  }

  private tell(text: string): void {
    this.told.textContent = text;
  }

  private bar(): HTMLElement {
    const search = make('input', { type: 'search', placeholder: 'scan, k12, loop 120-7, time', 'aria-label': 'find a scan, keyframe, loop or time', id: 'search' });
    search.addEventListener('keydown', (e) => { if (e.key === 'Enter') { this.found(find(this.data, search.value)); } });
    const button = (text: string, title: string, act: () => void) => make('button', { onclick: act, title }, text);
    return make('div', { class: 'map-bar' }, search, button('whole map', 'h', () => this.view.overview()),
      button('from above', 't', () => this.navigation.above()), button('measure', 'm', () => this.measure.set(!this.measure.on)),
      button('PNG', 'save the picture', () => this.picture()), button('link', 'copy the address of this view', () => this.link()), this.loading);
  }

  private stage(): HTMLElement {
    const { info } = this.data;
    const ride = make('button', { onclick: () => this.navigation.ride(), title: 'drive along (space)' }, '▶');
    const aside = make('aside', {}, make('h2', {}, 'Findings'), findingList(info.findings, (l) => this.follow(l)));
    const edits = editBar(this.data, { undo: () => { void this.change('undo', ''); }, save: () => { void this.change('save', ''); },
      ask: (pair) => { void this.propose(pair); } });
    return make('div', { class: 'stage' },
      make('div', { class: 'left' }, this.holder, make('div', { class: 'ride' }, ride, this.slider), this.toolbar.legend),
      make('div', { class: 'right' }, edits, this.proposed, this.panel.element, aside));
  }

  private below(): HTMLElement {
    const { info, loops, answers } = this.data;
    return make('main', {},
      part('What is shown', innerWidth > 900, this.toolbar.element),
      part(answers ? 'Over the answers' : 'Over the scans', innerWidth > 900, this.plots.element),
      ...(answers ? [part(`Answers (${answers.count})`, false, answerTable(answers, (i) => { this.chooseAnswer(i, true); this.holder.scrollIntoView({ block: 'nearest' }); }).element)] : []),
      part(`Loop candidates (${loops.count})`, false, loopTable(this.data, (i) => this.showLoop(i)).element),
      part(`Scans (${this.data.scans.count})`, false, scanTable(this.data, (i) => this.follow({ kind: 'scans', first: i, last: i })).element),
      ...info.tables.map((t) => part(`${t.title} (${t.rows.length})`, false, plainTable(t).element)),
      footer(info, [info.note, timeWords(info.time_parts), cloudWords(info)], this.keys()));
  }

  private keys(): Key[] {
    const key = (k: string, words: string, act: () => void): Key => ({ key: k, words, act });
    const move = (x: number, y: number) => () => this.navigation.pan(x, y);
    return [
      key('h', 'whole map', () => this.view.overview()), key('t', 'from above', () => this.navigation.above()), key('m', 'measure', () => this.measure.set(!this.measure.on)),
      key('n', 'next loop', () => this.step(1)), key('p', 'previous loop', () => this.step(-1)),
      key('1', 'odometry', () => this.panel.setPlacement('before')), key('2', 'this loop', () => this.panel.setPlacement('loop')), key('3', 'map', () => this.panel.setPlacement('map')),
      key('/', 'search', () => document.getElementById('search')?.focus()), key('d', 'dark or light', () => this.theme.toggle()),
      key(' ', 'drive along', () => this.navigation.ride()), key('Escape', 'close', () => { this.chooseLoop(null); this.measure.set(false); }),
      key('ArrowLeft', 'left', move(-1, 0)), key('ArrowRight', 'right', move(1, 0)), key('ArrowUp', 'up', move(0, 1)), key('ArrowDown', 'down', move(0, -1)),
      key('+', 'nearer', () => this.navigation.zoom(0.8)), key('-', 'farther', () => this.navigation.zoom(1.25)),
    ];
  }

  private found(what: Found): void {
    if ('problem' in what) {
      this.tell(what.problem);
    } else if ('loop' in what) {
      this.showLoop(what.loop);
    } else {
      this.chooseScan(what.scan, true);
    }
  }

  private clicks(): void {
    const canvas = this.view.renderer.domElement;
    let from = { x: 0, y: 0 };
    canvas.addEventListener('pointerdown', (e) => { from = { x: e.clientX, y: e.clientY }; });
    canvas.addEventListener('click', (e) => {
      if (Math.hypot(e.clientX - from.x, e.clientY - from.y) > 5) { return; }
      const box = canvas.getBoundingClientRect();
      const [x, y] = [e.clientX - box.left, e.clientY - box.top];
      if (this.measure.on) { this.measure.click(x, y); return; }
      const answer = this.view.answers ? pickAnswer(this.view.answers, (p) => this.view.project(p), x, y) : null;
      if (answer !== null) { this.chooseAnswer(answer, false); return; }
      const loop = pickLoop(this.view, x, y);
      if (loop !== null) { this.chooseLoop(loop); return; }
      const scan = pickScan(this.view, x, y);
      if (scan !== null) { this.chooseScan(scan, false); }
    });
  }

  /// The next loop of those that are shown.
  private step(by: number): void {
    const { shown } = this.view.loops;
    if (shown.length > 0) {
      const at = this.loop === null ? (by > 0 ? -1 : 0) : shown.indexOf(this.loop);
      this.showLoop(shown[(at + by + shown.length) % shown.length]);
    }
  }

  private picture(): void {
    this.view.now();
    this.view.renderer.domElement.toBlob((blob) => { if (blob) { save(`${this.data.info.name.replace(/[^\w-]+/g, '_')}.png`, blob); } });
  }

  private link(): void {
    this.remember();
    void navigator.clipboard?.writeText(location.href);
    this.tell('The address of this page now leads to this view.');
  }

  private remember(): void {
    const loop = this.loop === null ? null : pairName(this.data, this.loop);
    history.replaceState(null, '', fragmentOf(this.view, { loop, scan: this.scan }));
  }

  /// To the view that a fragment tells of; what it does not tell stays.
  private go(fragment: string): void {
    const place = parse(fragment);
    const { shown, camera, controls } = this.view;
    shown.cloud = kCloudColours.find((c) => c === place.cloud) ?? (shown.cloud as CloudColour);
    shown.path = kPathColours.find((c) => c === place.path) ?? (shown.path as PathColour);
    this.view.update();
    this.toolbar.synchronise();
    if (place.loop) { this.found(find(this.data, place.loop)); }
    if (place.scan !== undefined && place.scan < this.data.scans.count) { this.chooseScan(place.scan, !place.camera); }
    if (place.camera && place.target) {
      camera.position.copy(place.camera);
      controls.target.copy(place.target);
      controls.update();
    }
    this.view.draw();
  }

  private loaded(whole: boolean): void {
    const { cloud } = this.view;
    const all = this.data.info.cloud.points;
    this.loading.textContent = !whole ? `reading the cloud: ${Math.round((100 * cloud.loaded) / all)} %` : '';
    this.view.draw();
  }

  private themed(): void {
    this.view.theme(this.theme.dark);
    this.panel.theme();
    this.toolbar.synchronise();
    this.plots.draw();
  }
}
