// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Plots over the scans: zoomed by dragging, one cursor for all, linked to the map.
import uPlot from 'uplot';
import { css, kind } from './colour';
import { make } from './dom';
import { MapData, sigmaOf } from './map_data';

export interface PlotOf {
  title: string;
  unit: string;
  names: string[];
  values: (Float32Array | number[])[];
}

const kHeight_px = 190;

export function mapPlots(data: MapData): PlotOf[] {
  const { scans } = data;
  const each = (f: (i: number) => number) => Float32Array.from({ length: scans.count }, (_, i) => f(i));
  const plots: PlotOf[] = [
    { title: 'Uncertainty of the position', unit: 'm', names: ['1 sigma', 'height alone'], values: [each((i) => sigmaOf(scans, i)), each((i) => scans.sigma_m[3 * i + 2])] },
    { title: 'Moved by the loops', unit: 'm', names: ['moved'], values: [scans.moved] },
    { title: 'Height', unit: 'm', names: ['z'], values: [each((i) => scans.position[3 * i + 2])] },
    { title: 'Tracking: points that fit the local map', unit: '', names: ['share'], values: [scans.inliers] },
    { title: 'Speed', unit: 'm/s', names: ['speed'], values: [scans.speed] },
  ];
  if (scans.error_m.length > 0) {
    plots.unshift({ title: 'Error against the truth', unit: 'm', names: ['error'], values: [scans.error_m] });
  }
  return plots;
}

function axisColours(): { text: string; grid: string } {
  const style = getComputedStyle(document.documentElement);
  return { text: style.getPropertyValue('--quiet').trim(), grid: style.getPropertyValue('--line').trim() };
}

export interface Linked {
  hover: (scan: number | null) => void;
  choose: (scan: number) => void;
}

export class Plots {
  readonly element = make('div', { class: 'plots' });
  private plots: uPlot[] = [];

  constructor(private readonly all: PlotOf[], private readonly scans: number, private readonly linked: Linked) {
    let width = 0;
    new ResizeObserver(() => {
      if (this.element.clientWidth !== width && this.element.clientWidth > 0) {
        width = this.element.clientWidth;
        this.draw();
      }
    }).observe(this.element);
  }

  /// Again, where colours or widths have changed.
  draw(): void {
    this.plots.forEach((p) => p.destroy());
    const columns = this.element.clientWidth > 1100 ? 3 : this.element.clientWidth > 640 ? 2 : 1;
    const width = Math.floor((this.element.clientWidth - 16 * (columns - 1)) / columns);
    const holders = this.all.map((p) => make('figure', { 'aria-label': p.title }));
    this.element.replaceChildren(...holders);
    this.plots = this.all.map((p, i) => this.plot(p, width, holders[i]));
  }

  private plot(p: PlotOf, width: number, holder: HTMLElement): uPlot {
    const { text, grid } = axisColours();
    const axis = { stroke: text, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 }, font: '11px system-ui' };
    const over = Array.from({ length: this.scans }, (_, i) => i);
    const plot = new uPlot({
      width, height: kHeight_px, title: p.unit ? `${p.title} [${p.unit}]` : p.title,
      scales: { x: { time: false } },
      axes: [{ ...axis, size: 28 }, { ...axis, size: 52 }],
      legend: { show: p.names.length > 1 },
      cursor: { sync: { key: 'scans' }, drag: { x: true, y: false }, points: { size: 6 } },
      series: [{ label: 'scan' }, ...p.names.map((label, i) =>
        ({ label, stroke: css(kind(i)), width: 1.5, points: { show: this.scans < 3 } }))],
      hooks: { setCursor: [(u: uPlot) => this.hovered(u)] },
    }, [over, ...p.values] as uPlot.AlignedData, holder);
    this.clicks(plot);
    return plot;
  }

  private hovered(plot: uPlot): void {
    if (plot.over.matches(':hover')) { this.linked.hover(plot.cursor.idx ?? null); }
  }

  /// A click chooses the scan; a drag zooms; a double click shows all again.
  private clicks(plot: uPlot): void {
    let from = 0;
    plot.over.addEventListener('mousedown', (e) => { from = e.clientX; });
    plot.over.addEventListener('click', (e) => {
      if (Math.abs(e.clientX - from) < 4 && plot.cursor.idx !== null && plot.cursor.idx !== undefined) {
        this.linked.choose(plot.cursor.idx);
      }
    });
    plot.over.addEventListener('mouseleave', () => this.linked.hover(null));
  }
}
