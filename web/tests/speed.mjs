// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// How fast a page opens and turns in a browser without a graphics card: node speed.mjs CHROMIUM PAGE...
import { statSync } from 'node:fs';
import { launch, open, urlOf } from './browser.mjs';

const [executable, ...files] = process.argv.slice(2);
const browser = await launch(executable);
for (const file of files) {
  const b = await open(browser, urlOf(file));
  const { x, y, width, height } = await b.page.locator('.map canvas').boundingBox();
  await b.page.evaluate(() => {
    globalThis.pictures = 0;
    const count = () => { ++globalThis.pictures; requestAnimationFrame(count); };
    requestAnimationFrame(count);
  });
  await b.page.mouse.move(x + width / 2, y + height / 2);
  await b.page.mouse.down({ button: 'right' });
  const begin = performance.now();
  for (let i = 0; performance.now() - begin < 4000; ++i) {
    await b.page.mouse.move(x + width / 2 + 200 * Math.sin(i / 40), y + height / 2);
  }
  const rate = (1000 * (await b.page.evaluate(() => globalThis.pictures))) / (performance.now() - begin);
  await b.page.mouse.up({ button: 'right' });
  const points = await b.page.evaluate(() => JSON.parse(document.getElementById('page-data').textContent).cloud.points);
  console.log(`${file}: ${(statSync(file).size / 1e6).toFixed(1)} MB, ${points} points, shown after ${Math.round(b.shown_ms)} ms, ` +
    `whole after ${Math.round(b.whole_ms)} ms, ${rate.toFixed(0)} pictures/s while it turns`);
  await b.close();
}
await browser.close();
