// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a page has done by the server that it comes from (loopmark view).
import { Blocks } from './blocks';
import { MapData, MapInfo, readMap } from './map_data';

async function ask(action: string, words: string): Promise<string> {
  const answer = await fetch(action, { method: 'POST', body: words });
  const text = await answer.text();
  if (!answer.ok) {
    throw new Error(text || `the server answered with ${answer.status}`);
  }
  return text;
}

/// Has the map solved again; what has not changed, the cloud above all, is taken from `old`.
export async function solveAgain(old: MapData, action: 'loops' | 'undo' | 'save', words: string): Promise<MapData> {
  const answer = new DOMParser().parseFromString(await ask(action, words), 'text/html'); // scripts in it do not run
  const info = JSON.parse(answer.getElementById('page-data')?.textContent ?? '{}') as MapInfo;
  const data = await readMap({ ...old.info, ...info }, new Blocks(answer));
  data.blocks = old.blocks;
  data.scans.before = old.scans.position;
  data.keyframes.before = old.keyframes.pose;
  return data;
}

/// What registration says of two scans that are no candidate yet.
export const proposal = (pair: string): Promise<string> => ask('why', pair);
