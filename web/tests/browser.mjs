// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A real browser without a network, with what it complained about and what it asked for.
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const kFlags = [
  '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic',
  '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--disable-dev-shm-usage', '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1',
];

/// In a new profile, which goes when it is closed.
export const launch = (executable) => chromium.launch({ executablePath: executable, headless: true, args: kFlags });

export const urlOf = (file) => pathToFileURL(resolve(file)).href;

/// What the driver says of screenshots is no complaint about the page.
const kOfScreenshots = /GPU stall due to ReadPixels/;

/// Opens a page and waits until it is shown, or until all of its cloud has been read too.
export async function open(browser, url, { width = 1400, height = 900, dark = false, until = 'whole' } = {}) {
  const context = await browser.newContext({
    viewport: { width, height }, colorScheme: dark ? 'dark' : 'light', hasTouch: width < 500, acceptDownloads: true,
  });
  const page = await context.newPage();
  const complaints = [];
  const requests = [];
  page.on('console', (m) => {
    if (['error', 'warning'].includes(m.type()) && !kOfScreenshots.test(m.text())) { complaints.push(m.text()); }
  });
  page.on('pageerror', (e) => complaints.push(String(e)));
  page.on('request', (r) => requests.push(r.url()));
  const begin = performance.now();
  await page.goto(url);
  const reach = async (states) => {
    await page.waitForFunction((s) => s.includes(document.documentElement.dataset.state), states, { timeout: 120000 });
    return performance.now() - begin;
  };
  const shown_ms = await reach(['shown', 'whole']);
  const whole_ms = until === 'whole' ? await reach(['whole']) : NaN;
  return { page, complaints, requests, shown_ms, whole_ms, close: () => context.close() };
}
