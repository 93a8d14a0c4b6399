// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the page of a map holds. Frames and units as in docs/conventions.md: T_map_lidar, metres, seconds.
import { AnswerInfo, Answers, readAnswers } from './answers';
import { Blocks } from './blocks';

export interface Link {
  kind: 'scans' | 'loop' | 'answer';
  first: number; // scan, loop or answer
  last: number; // scan
}

export interface Finding {
  severity: 'problem' | 'look' | 'good';
  text: string;
  links: { text: string; link: Link }[];
}

export interface ChunkInfo {
  name: string; // of its blocks
  first: number; // keyframe
  keyframes: number;
  points: number;
  levels: number[]; // points up to and with each level of detail
  scale_m: number; // of the integers
  reach_m: number; // longest distance of a point from its keyframe
}

export interface MapInfo {
  page: 'map';
  title: string;
  name: string;
  version: string;
  run: string; // as the commands name it
  facts: [string, string][];
  note: string;
  findings: Finding[];
  components: { name: string; scans: number }[];
  sessions: { name: string; first_scan: number; scans: number }[];
  origins: string[];
  reasons: string[];
  problems: Record<string, string>; // by scan
  evidence: { name: string; words: string; scale: string }[];
  min_loop_p: number;
  height_m: [number, number]; // of most points, in the map
  intensity: [number, number]; // that 0 and 255 stand for
  cloud: { points: number; of: number; voxel_m: number; rounded_m: number };
  level_voxels_m: number[];
  chunks: ChunkInfo[];
  tables: { title: string; columns: string[]; rows: string[][] }[];
  time_parts: [string, number][];
  licences: string;
  edits: { possible: boolean; unsaved: string[] }; // of a page that comes from a server
  answers?: AnswerInfo;
  message?: string; // about what was done last
}

export const kVerdicts = ['accepted', 'rejected', 'vetoed', 'forced'] as const;
export const kStates = ['tracked', 'recovered', 'new segment', 'damaged'] as const;
export const kTrackings = ['good', 'degenerate', 'lost'] as const;

export interface Scans {
  count: number;
  stamp_s: Float64Array;
  position: Float32Array; // x y z in the map
  odometry: Float32Array; // the same before the loops
  before: Float32Array; // what the map is compared with: odometry, or the map before the last change
  truth: Float32Array; // fitted to the map; empty where unknown
  error_m: Float32Array; // against it
  sigma_m: Float32Array; // x y z
  state: Uint8Array;
  tracking: Uint8Array;
  inliers: Float32Array;
  speed: Float32Array;
  moved: Float32Array; // by the loops, metres
  component: Uint16Array;
  segment: Uint16Array;
}

export interface Keyframes {
  count: number;
  scan: Uint32Array;
  pose: Float32Array; // x y z qx qy qz qw in the map
  odometry: Float32Array; // the same before the loops
  before: Float32Array; // as Scans.before
  path_m: Float32Array;
}

export interface Loops {
  count: number;
  source: Uint32Array; // keyframes
  target: Uint32Array;
  p: Float32Array;
  verdict: Uint8Array;
  origin: Uint8Array;
  reason: Uint16Array;
  motion: Float32Array; // T_target_source: x y z qx qy qz qw
  answered: Uint8Array;
  weight: Float32Array;
  chi2: Float32Array;
  evidence: Float32Array; // a row a loop; not a number where the loop has none
}

export interface MapData {
  info: MapInfo;
  blocks: Blocks;
  scans: Scans;
  keyframes: Keyframes;
  loops: Loops;
  answers: Answers | null;
}

async function readScans(b: Blocks): Promise<Scans> {
  const f32 = (name: string) => b.readOr<Float32Array>(`scan.${name}`, new Float32Array());
  const stamp_s = await b.read<Float64Array>('scan.stamp');
  const odometry = await f32('odometry');
  return {
    count: stamp_s.length, stamp_s,
    position: await f32('position'), odometry, before: odometry, truth: await f32('truth'),
    error_m: await f32('error'), sigma_m: await f32('sigma'),
    state: await b.read<Uint8Array>('scan.state'), tracking: await b.read<Uint8Array>('scan.tracking'),
    inliers: await f32('inliers'), speed: await f32('speed'), moved: await f32('moved'),
    component: await b.read<Uint16Array>('scan.component'), segment: await b.read<Uint16Array>('scan.segment'),
  };
}

async function readLoops(b: Blocks): Promise<Loops> {
  const f32 = (name: string) => b.read<Float32Array>(`loop.${name}`);
  const source = await b.read<Uint32Array>('loop.source');
  return {
    count: source.length, source, target: await b.read<Uint32Array>('loop.target'), p: await f32('p'),
    verdict: await b.read<Uint8Array>('loop.verdict'), origin: await b.read<Uint8Array>('loop.origin'),
    reason: await b.read<Uint16Array>('loop.reason'), motion: await f32('motion'),
    answered: await b.read<Uint8Array>('loop.answered'), weight: await f32('weight'), chi2: await f32('chi2'),
    evidence: await f32('evidence'),
  };
}

export async function readMap(info: MapInfo, blocks: Blocks): Promise<MapData> {
  const scan = await blocks.read<Uint32Array>('keyframe.scan');
  const odometry = await blocks.read<Float32Array>('keyframe.odometry');
  const keyframes = {
    count: scan.length, scan, pose: await blocks.read<Float32Array>('keyframe.pose'),
    odometry, before: odometry,
    path_m: await blocks.read<Float32Array>('keyframe.path'),
  };
  const answers = info.answers ? await readAnswers(info.answers, blocks) : null;
  return { info, blocks, scans: await readScans(blocks), keyframes, loops: await readLoops(blocks), answers };
}

/// The keyframe at or before a scan.
export function keyframeOfScan(k: Keyframes, scan: number): number {
  let low = 0;
  let high = k.count - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (k.scan[middle] <= scan) { low = middle; } else { high = middle - 1; }
  }
  return low;
}

export function sigmaOf(s: Scans, i: number): number {
  return Math.hypot(s.sigma_m[3 * i], s.sigma_m[3 * i + 1], s.sigma_m[3 * i + 2]);
}

export function sessionOf(info: MapInfo, scan: number): number {
  let session = 0;
  info.sessions.forEach((s, i) => { session = scan >= s.first_scan ? i : session; });
  return session;
}
