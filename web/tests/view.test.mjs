// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// loopmark view in a real browser. CHROMIUM: the browser; PAGES: a run (tests/browser/sample_run.cpp); LOOPMARK: the program.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { launch, open } from './browser.mjs';

let browser;
let server;
let url;
let printed = '';

before(async () => {
  browser = await launch(process.env.CHROMIUM);
  server = spawn(process.env.LOOPMARK, ['view', process.env.PAGES, '--no-open'], { stdio: ['ignore', 'pipe', 'inherit'] });
  url = await new Promise((found, failed) => {
    server.stdout.on('data', (bytes) => {
      printed += bytes;
      const address = /http:\S+/.exec(printed);
      if (address) { found(address[0]); }
    });
    server.on('exit', (status) => failed(new Error(`view ended with ${status}`)));
  });
});
after(async () => {
  await browser.close();
  server.kill('SIGKILL');
});

const message = (page) => page.locator('.edits [role=status]').textContent();
const solved = (page, words) => page.waitForFunction(
  (w) => document.querySelector('.edits [role=status]')?.textContent.includes(w), words, { timeout: 30000 });

/// A pair that is accepted: keyframes 39 and 0 of the run; behind every fifth keyframe stands a scan that is none.
const kPair = '46-0';

test('a veto moves the map, undo takes it back, all without a request to elsewhere', async () => {
  const b = await open(browser, url);
  assert.match(await message(b.page), /None yet/);
  await b.page.locator('#search').fill(kPair);
  await b.page.locator('#search').press('Enter');
  await b.page.locator('.act', { hasText: 'veto and solve again' }).click();
  await solved(b.page, 'poses moved by up to');
  assert.match(await message(b.page), /^veto 46-0: poses moved by up to (?!0\.000)\d+\.\d+ m/);
  assert.match(await b.page.locator('.edits code').textContent(), /^loopmark loops \S+ --veto 46-0$/);
  assert.match(await b.page.locator('.loop-panel').textContent(), /vetoed by a person/);
  await b.page.getByRole('button', { name: 'undo' }).click();
  await solved(b.page, 'undone');
  assert.ok(await b.page.getByRole('button', { name: 'save into the run' }).isDisabled());
  assert.deepEqual(b.complaints, []);
  assert.ok(b.requests.every((r) => r.startsWith(url) || r.startsWith('blob:')), b.requests.join(' '));
  await b.close();
});

test('two places are tried as a loop before it counts', async () => {
  const b = await open(browser, url);
  await b.page.getByLabel('two scans to be tried as a loop').fill('k35-k4');
  await b.page.getByRole('button', { name: 'try as a loop' }).click();
  await b.page.waitForSelector('pre:has-text("P(correct)")', { timeout: 30000 });
  await b.page.getByLabel('two scans to be tried as a loop').fill('1-99999');
  await b.page.getByRole('button', { name: 'try as a loop' }).click();
  await b.page.waitForFunction(() => document.querySelector('.told').textContent.includes('there is no such scan'));
  await b.close();
});

test('a change is saved into the run, and what is not saved is told at the end', async () => {
  const b = await open(browser, url);
  const change = async (pair, what) => {
    await b.page.locator('#search').fill(pair);
    await b.page.locator('#search').press('Enter');
    await b.page.locator('.act', { hasText: what }).click();
    await solved(b.page, pair);
  };
  await change(kPair, 'veto');
  await b.page.getByRole('button', { name: 'save into the run' }).click();
  await solved(b.page, 'Saved.');
  assert.ok(existsSync(`${process.env.PAGES}.before-1`));
  await change(kPair, 'forget');
  await b.close();
  server.removeAllListeners('exit');
  const ended = new Promise((resolve) => server.on('close', resolve));
  server.kill('SIGINT');
  assert.equal(await ended, 0);
  assert.match(printed, /not saved; to make these changes: loopmark loops \S+ --forget 46-0/);
});
