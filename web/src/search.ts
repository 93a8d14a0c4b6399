// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a person types to find a place: a scan (120), a keyframe (k12), a loop (120-7), a time of day (13:04:05) or a
// stamp in seconds.
import { MapData } from './map_data';
import { pairName } from './loop_words';

export type Found = { scan: number } | { loop: number } | { problem: string };

export function timeOfDay(stamp_s: number): string {
  const day = ((stamp_s % 86400) + 86400) % 86400;
  const two = (v: number) => String(Math.floor(v)).padStart(2, '0');
  return `${two(day / 3600)}:${two((day / 60) % 60)}:${two(day % 60)}`;
}

function nearestStamp(stamps: Float64Array, wanted: (stamp: number) => number): number {
  let best = 0;
  for (let i = 1; i < stamps.length; ++i) {
    if (wanted(stamps[i]) < wanted(stamps[best])) { best = i; }
  }
  return best;
}

function findLoop(data: MapData, text: string): Found {
  const [a, b] = text.split('-');
  for (let i = 0; i < data.loops.count; ++i) {
    if ([`${a}-${b}`, `${b}-${a}`].includes(pairName(data, i))) { return { loop: i }; }
  }
  return { problem: `No loop candidate joins scans ${a} and ${b}.` };
}

export function find(data: MapData, words: string): Found {
  const text = words.trim();
  const { scans, keyframes } = data;
  if (/^\d+-\d+$/.test(text)) { return findLoop(data, text); }
  if (/^k\d+$/.test(text)) {
    const k = Number(text.slice(1));
    return k < keyframes.count ? { scan: keyframes.scan[k] } : { problem: `The last keyframe is k${keyframes.count - 1}.` };
  }
  if (/^\d+$/.test(text) && Number(text) < scans.count) { return { scan: Number(text) }; }
  const clock = /^(\d+):(\d\d)(?::(\d\d(?:\.\d+)?))?$/.exec(text);
  if (clock) {
    const wanted = Number(clock[1]) * 3600 + Number(clock[2]) * 60 + Number(clock[3] ?? 0);
    return { scan: nearestStamp(scans.stamp_s, (s) => Math.abs((((s % 86400) + 86400) % 86400) - wanted)) };
  }
  const stamp = Number(text);
  if (text !== '' && Number.isFinite(stamp) && stamp >= scans.stamp_s[0] && stamp <= scans.stamp_s[scans.count - 1]) {
    return { scan: nearestStamp(scans.stamp_s, (s) => Math.abs(s - stamp)) };
  }
  return { problem: `Nothing is called “${text}”: type a scan (0 to ${scans.count - 1}), k12, a loop 120-7, or a time 13:04:05.` };
}
