// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Runs a file of tests where there is a browser; ends with 77 (skipped) where there is none:
//   node run.mjs CHROMIUM PAGES FILE [LOOPMARK]
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const [chromium, pages, file, loopmark = ''] = process.argv.slice(2);
if (!existsSync(chromium)) {
  console.log('skipped: no Chromium (Debian: apt-get install chromium)');
  process.exit(77);
}
const here = dirname(fileURLToPath(import.meta.url));
const { status } = spawnSync(process.execPath, ['--test', join(here, file)], {
  stdio: 'inherit', env: { ...process.env, CHROMIUM: chromium, PAGES: pages, LOOPMARK: loopmark },
});
process.exit(status ?? 1);
