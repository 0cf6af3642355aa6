// Names the browsers and volumes with which Playwright checks the viewer (scripts/check-viewer).
import { existsSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { defineConfig } from '@playwright/test';

import { chromiumOptions } from './viewer_page.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const data = resolve(root, process.env.STORMCELLAR_DATA || '../shared/data');
const volume = (name) => join(data, 'volumes', name);
// The volumes of a station in a folder; where there are none, one that is not here.
function inFolder(folder, station) {
  const names = existsSync(join(data, folder)) ? readdirSync(join(data, folder)).sort() : [];
  const found = names.filter((name) => name.startsWith(station));
  return (found.length > 0 ? found : [station]).map((name) => join(data, folder, name));
}

const squallLine = volume('KLBB20160601_150025_V06');
const supercells = volume('KTLX19990503_235621.gz');
const clearAir = volume('KLOT20220317_000842_V06');
// The checks use a simulated volume if no real one is here.
const storms = existsSync(squallLine) ? [squallLine, supercells] : existsSync(clearAir) ? [clearAir] : [];
const sequence = inFolder('sequence-kbgm', 'KBGM');
// Three sites that reach each other, one of them at the sea.
const neighbors = ['KCCX', 'KDIX', 'KENX'].flatMap((site) => inFolder('mosaic-northeast', site));

// Firefox draws WebGL only where there is a screen; it asks nothing of its makers.
const firefox = {
  browserName: 'firefox',
  channel: 'moz-firefox',
  hasTouch: false,
  launchOptions: {
    executablePath: '/usr/bin/firefox-esr',
    headless: false,
    firefoxUserPrefs: {
      'app.normandy.enabled': false,
      'app.update.enabled': false,
      'browser.safebrowsing.malware.enabled': false,
      'browser.safebrowsing.phishing.enabled': false,
      'browser.shell.checkDefaultBrowser': false,
      'browser.startup.homepage_override.mstone': 'ignore',
      'datareporting.policy.dataSubmissionEnabled': false,
      'network.captive-portal-service.enabled': false,
      'network.connectivity-service.enabled': false,
      'services.settings.server': 'http://127.0.0.1:9/',
      'toolkit.telemetry.enabled': false,
      'webgl.force-enabled': true,
      'webgl.disable-fail-if-major-performance-caveat': true,
      'gfx.webrender.software': true,
      'webgl.out-of-process': false,
    },
  },
};

export default defineConfig({
  testDir: '.',
  outputDir: join(resolve(root, process.env.STORMCELLAR_BUILD || 'build/release'), 'tests/viewer/results'),
  workers: 1, // pictures are drawn by all processors
  forbidOnly: true,
  retries: 1, // shown as flaky
  timeout: 600_000, // a machine may compile beside
  expect: { timeout: 30_000 },
  reporter: 'list',
  use: { launchOptions: chromiumOptions, hasTouch: true },
  projects: [
    {
      name: 'storms',
      testMatch: /(look|parts|layers|readout|share|places|editor|honest|pictures|sweeps|access)\.spec\.mjs/,
      grepInvert: /@sequence/,
      use: { volumes: storms },
    },
    { name: 'clear-air', testMatch: 'clear_air.spec.mjs', use: { volumes: [clearAir] } },
    { name: 'newcomer', testMatch: 'newcomer.spec.mjs', use: { volumes: [supercells] } },
    { name: 'sequence', testMatch: /(time|pictures|sweeps)\.spec\.mjs/, use: { volumes: sequence } },
    { name: 'region', testMatch: /(region|water)\.spec\.mjs/, use: { volumes: neighbors } },
    { name: 'firefox', testMatch: 'first_picture.spec.mjs', use: { volumes: storms, ...firefox } },
    {
      name: 'index-page',
      testMatch: 'index_page.spec.mjs',
      use: { launchOptions: { ...chromiumOptions, args: ['--host-resolver-rules=MAP radar.example 127.0.0.1'] } },
    },
  ],
});
