// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// A picture of a page: node look.mjs CHROMIUM PAGE OUT.png [WIDTH HEIGHT [light|dark [FRAGMENT [full|window]]]]
import { launch, open, urlOf } from './browser.mjs';

const [executable, file, out, width = '1400', height = '900', theme = 'light', fragment = '', part = 'full'] = process.argv.slice(2);
const browser = await launch(executable);
const b = await open(browser, urlOf(file) + fragment, { width: Number(width), height: Number(height), dark: theme === 'dark' });
await b.page.waitForTimeout(600);
await b.page.screenshot({ path: out, fullPage: part === 'full' });
console.log(JSON.stringify({ shown_ms: Math.round(b.shown_ms), whole_ms: Math.round(b.whole_ms), complaints: b.complaints, requests: b.requests.length }));
await browser.close();
