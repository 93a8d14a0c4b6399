// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a person should know first, in sentences that lead into the view.
import { make } from './dom';
import { Finding, Link } from './map_data';

const kMarks = { problem: '▲', look: '●', good: '✓' } as const;
const kWords = { problem: 'problem', look: 'look at this', good: 'good' } as const;
const kShown = 6; // links of a finding; the others stand in the tables

export function findingList(findings: Finding[], follow: (link: Link) => void): HTMLElement {
  return make('ul', { class: 'findings' }, ...findings.map((f) => make('li', { class: f.severity },
    make('span', { class: 'mark', role: 'img', 'aria-label': kWords[f.severity] }, kMarks[f.severity]),
    make('span', {}, f.text, ...f.links.slice(0, kShown).flatMap((l) =>
      [' ', make('button', { class: 'inline', onclick: () => follow(l.link) }, l.text)]),
    f.links.length > kShown ? ` and ${f.links.length - kShown} more` : null))));
}
