// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Tables in pages of rows: sorted by a click on a name, filtered by words, saved as CSV.
import { make, save } from './dom';

export interface ColumnOf<Row> {
  name: string;
  value: (row: Row) => string | number;
  text?: (row: Row) => string; // where it is not the value
}

export interface TableOptions<Row> {
  file: string; // name of the CSV
  rows_a_page?: number;
  choose?: (row: Row) => void;
  empty: string;
}

export function csvOf<Row>(columns: ColumnOf<Row>[], rows: Row[]): string {
  const cell = (v: string | number) => {
    const text = String(v);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const lines = [columns.map((c) => cell(c.name)), ...rows.map((r) => columns.map((c) => cell(c.value(r))))];
  return lines.map((l) => l.join(',') + '\r\n').join('');
}

const textOf = <Row>(c: ColumnOf<Row>, row: Row) => (c.text ? c.text(row) : String(c.value(row)));

export function compare(a: string | number, b: string | number): number {
  if (typeof a === 'number' && typeof b === 'number') {
    return Number.isNaN(a) ? (Number.isNaN(b) ? 0 : 1) : Number.isNaN(b) ? -1 : a - b;
  }
  return String(a).localeCompare(String(b));
}

export class Table<Row> {
  readonly element = make('div', { class: 'table' });
  private readonly head = make('tr');
  private readonly body = make('tbody');
  private readonly count = make('span', { class: 'count', role: 'status' });
  private sorted: { column: number; down: boolean } | null = null;
  private words = '';
  private page = 0;
  private wanted: Row[];

  constructor(private readonly columns: ColumnOf<Row>[], private readonly rows: Row[], private readonly options: TableOptions<Row>) {
    this.wanted = rows;
    const filter = make('input', { type: 'search', placeholder: 'filter by words', 'aria-label': 'filter the table' });
    filter.addEventListener('input', () => { this.words = filter.value.toLowerCase(); this.page = 0; this.arrange(); });
    const turn = (step: number) => () => { this.page += step; this.draw(); };
    this.element.append(
      make('div', { class: 'tools' }, filter, make('button', { onclick: turn(-1), 'aria-label': 'previous rows' }, '‹'),
        this.count, make('button', { onclick: turn(1), 'aria-label': 'next rows' }, '›'),
        make('button', { onclick: () => this.saveCsv() }, 'CSV')),
      make('div', { class: 'wide' }, make('table', {}, make('thead', {}, this.head), this.body)));
    columns.forEach((c, i) => this.head.append(
      make('th', { scope: 'col' }, make('button', { class: 'sort', onclick: () => this.sort(i) }, c.name))));
    this.draw();
  }

  private saveCsv(): void {
    save(this.options.file, new Blob([csvOf(this.columns, this.wanted)], { type: 'text/csv' }));
  }

  private sort(column: number): void {
    const down = this.sorted?.column === column && !this.sorted.down;
    this.sorted = { column, down };
    Array.from(this.head.children).forEach((th, i) =>
      i === column ? th.setAttribute('aria-sort', down ? 'descending' : 'ascending') : th.removeAttribute('aria-sort'));
    this.arrange();
  }

  private arrange(): void {
    const words = this.words.split(/\s+/).filter((w) => w !== '');
    this.wanted = this.rows.filter((r) => {
      const text = words.length > 0 ? this.columns.map((c) => textOf(c, r)).join(' ').toLowerCase() : '';
      return words.every((w) => text.includes(w));
    });
    if (this.sorted) {
      const { column, down } = this.sorted;
      const value = this.columns[column].value;
      this.wanted.sort((a, b) => (down ? compare(value(b), value(a)) : compare(value(a), value(b))));
    }
    this.draw();
  }

  private draw(): void {
    const size = this.options.rows_a_page ?? 12;
    const pages = Math.max(1, Math.ceil(this.wanted.length / size));
    this.page = Math.min(Math.max(this.page, 0), pages - 1);
    const begin = this.page * size;
    const shown = this.wanted.slice(begin, begin + size);
    this.count.textContent = this.wanted.length === 0 ? this.options.empty
      : `${begin + 1}–${begin + shown.length} of ${this.wanted.length}`;
    this.body.replaceChildren(...shown.map((row) => this.line(row)));
  }

  private line(row: Row): HTMLElement {
    const choose = this.options.choose;
    const line = make('tr', choose ? { tabindex: 0, class: 'link' } : {}, ...this.columns.map((c) =>
      make('td', { class: typeof c.value(row) === 'number' ? 'number' : undefined }, textOf(c, row))));
    if (choose) {
      line.addEventListener('click', () => choose(row));
      line.addEventListener('keydown', (e) => { if (e.key === 'Enter') { choose(row); } });
    }
    return line;
  }
}
