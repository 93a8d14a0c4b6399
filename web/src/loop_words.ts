// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A loop in words: verdict, evidence with its scale, and the command that changes it.
import { brief, fixed, metres } from './dom';
import { MapData, kVerdicts } from './map_data';

export function pairName(data: MapData, loop: number): string {
  const { keyframes, loops } = data;
  return `${keyframes.scan[loops.source[loop]]}-${keyframes.scan[loops.target[loop]]}`;
}

export function verdictWords(data: MapData, loop: number): string {
  const { loops, info } = data;
  const word = kVerdicts[loops.verdict[loop]];
  const reason = info.reasons[loops.reason[loop]] ?? '';
  return reason ? `${word}: ${reason}` : word;
}

/// Metres driven between the two keyframes.
export function drivenBetween(data: MapData, loop: number): number {
  const { keyframes, loops } = data;
  return keyframes.path_m[loops.source[loop]] - keyframes.path_m[loops.target[loop]];
}

export function loopFacts(data: MapData, loop: number): [string, string][] {
  const { loops, info } = data;
  const motion = loops.motion.subarray(7 * loop, 7 * loop + 3);
  const facts: [string, string][] = [
    ['verdict', verdictWords(data, loop)],
    ['P(correct)', `${fixed(loops.p[loop], Math.abs(loops.p[loop] - info.min_loop_p) < 0.005 ? 5 : 3)} (at least ${info.min_loop_p} is needed)`],
    ['proposed by', info.origins[loops.origin[loop]]],
    ['driven between', metres(drivenBetween(data, loop))],
    ['motion found', `${[...motion].map((v) => fixed(v, 2)).join(', ')} m`],
  ];
  if (loops.chi2[loop] > 0) {
    facts.push(['in the pose graph', `weight ${fixed(loops.weight[loop], 2)}, chi2 ${fixed(loops.chi2[loop], 1)}`]);
  }
  return facts;
}

/// Each number of the evidence: its words, the number, what it is measured in.
export function evidenceRows(data: MapData, loop: number): [string, string, string][] {
  const { loops, info } = data;
  const width = info.evidence.length;
  return info.evidence
    .map((e, i): [string, string, string, number] =>
      [e.words, brief(loops.evidence[width * loop + i]), e.scale, loops.evidence[width * loop + i]])
    .filter((row) => Number.isFinite(row[3]))
    .map(([words, value, scale]) => [words, value, scale]);
}

/// A word of a POSIX shell command.
export function shellWord(text: string): string {
  return /^[\w./+:@%,=-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;
}

export function command(data: MapData, loop: number, change: 'veto' | 'force' | 'forget'): string {
  return `loopmark loops ${shellWord(data.info.run)} --${change} ${pairName(data, loop)}`;
}

/// The change that makes sense for the loop as it stands.
export function changesFor(data: MapData, loop: number): ('veto' | 'force' | 'forget')[] {
  switch (kVerdicts[data.loops.verdict[loop]]) {
    case 'accepted': return ['veto'];
    case 'rejected': return ['force'];
    default: return ['forget'];
  }
}
