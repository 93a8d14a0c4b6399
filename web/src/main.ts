// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Finds out which page this is and fills it.
import { Blocks } from './blocks';
import { make } from './dom';
import { MapInfo, readMap } from './map_data';
import { MapPage } from './map_page';

function fail(problem: unknown): void {
  const text = problem instanceof Error ? problem.message : String(problem);
  document.getElementById('app')?.prepend(make('p', { class: 'failure', role: 'alert' }, `This page cannot be shown in full: ${text}`));
  console.error(problem);
}

async function start(): Promise<void> {
  const info = JSON.parse(document.getElementById('page-data')?.textContent ?? '{}') as MapInfo;
  const app = document.getElementById('app') as HTMLElement;
  const page = new MapPage(await readMap(info, new Blocks(document)));
  app.replaceChildren(page.element);
  await page.begin();
}

start().catch(fail);
