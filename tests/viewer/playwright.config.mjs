// Names the browsers and volumes with which Playwright checks the viewer (scripts/check-viewer).
import { existsSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { defineConfig } from '@playwright/test';

import { data, root } from './server.mjs';
import { chromiumOptions } from './viewer_page.mjs';

const volume = (name) => join(data, 'volumes', name);
// Returns the volumes of a station in a folder. Without any, returns a path that does not exist, so that checks are
// skipped.
function inFolder(folder, station) {
  const names = existsSync(join(data, folder)) ? readdirSync(join(data, folder)).sort() : [];
  const found = names.filter((name) => name.startsWith(station));
  return (found.length > 0 ? found : [station]).map((name) => join(data, folder, name));
}

const squallLine = volume('KLBB20160601_150025_V06');
const supercells = volume('KTLX19990503_235621.gz');
const hurricane = volume('KCRP20170826_044114.trimmed.ar2v');
const clearAir = volume('KLOT20220317_000842_V06');
// Volumes of storms. If none is on this machine, the checks use a simulated volume.
const storms = existsSync(squallLine) ? [squallLine, supercells] : existsSync(clearAir) ? [clearAir] : [];
const sequence = inFolder('sequence-kbgm', 'KBGM');
// Three sites whose grids overlap, one of them at the sea.
const neighbors = ['KCCX', 'KDIX', 'KENX'].flatMap((site) => inFolder('mosaic-northeast', site));

// Firefox needs a screen to draw WebGL. Requests to its maker are turned off.
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

// What the page must have, and the checks of it:
//   2D first                     flat, sweeps          times below the slider   time, tracks
//   a reading that is right      readout, look         storms, sections, lines  cells, wind, layers, look
//   a first picture as in frame  look, pictures        overlays                 overlays
//   velocity for work            dealiased, glance     plain words, keys        words, glance
//   age, health, progress        honest, scan          everybody, any window    access, glance
//   loading, without WebGL       stills                never freezes          busy
export default defineConfig({
  testDir: '.',
  outputDir: join(resolve(root, process.env.STORMCELLAR_BUILD || 'build/release'), 'tests/viewer/results'),
  workers: 1, // a picture already uses all processors
  forbidOnly: true,
  retries: 1, // a check that passes at the second try is reported as flaky
  timeout: 600_000, // long enough while the machine also compiles
  expect: { timeout: 30_000 },
  reporter: 'list',
  use: { launchOptions: chromiumOptions, hasTouch: true },
  projects: [
    {
      name: 'storms',
      testMatch: /(look|flat|panes|moments|words|scan|parts|layers|readout|share|places|editor|honest|pictures|sweeps|stills|glance|cells|access|busy)\.spec\.mjs/,
      grepInvert: /@sequence/,
      use: { volumes: storms },
    },
    { name: 'clear-air', testMatch: 'clear_air.spec.mjs', use: { volumes: [clearAir] } },
    { name: 'dealiased', testMatch: 'dealiased.spec.mjs', use: { volumes: [hurricane] } },
    { name: 'wind', testMatch: 'wind.spec.mjs', use: { volumes: [supercells] } },
    { name: 'newcomer', testMatch: 'newcomer.spec.mjs', use: { volumes: [supercells] } },
    { name: 'sequence', testMatch: /(time|tracks|stills|overlays|pictures|sweeps)\.spec\.mjs/, use: { volumes: sequence } },
    { name: 'region', testMatch: /(region|water)\.spec\.mjs/, use: { volumes: neighbors } },
    { name: 'firefox', testMatch: 'first_picture.spec.mjs', use: { volumes: storms, ...firefox } },
    {
      name: 'index-page',
      testMatch: 'index_page.spec.mjs',
      use: { launchOptions: { ...chromiumOptions, args: ['--host-resolver-rules=MAP radar.example 127.0.0.1'] } },
    },
  ],
});
