// Gives each check of the viewer a data server with the volumes of the check's Playwright project, and a page. A check
// fails if the page has an error that the check did not provoke.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';

import { test as base, expect } from '@playwright/test';

import { root, startServer } from './server.mjs';
import { Slicer, mostDifference } from './slicer.mjs';
import { ViewerPage, gridsOf } from './viewer_page.mjs';

export { expect };

const build = resolve(root, process.env.STORMCELLAR_BUILD || 'build/release');
export const program = join(build, 'cli/stormcellar');
export const daemon = join(build, 'daemon/stormcellard');

// Simulates a scene, and returns the paths of the files.
export function simulate(directory, scene = join(root, 'scenes/small-storm.toml')) {
  execFileSync(program, ['synth', scene, '-o', directory], { stdio: 'ignore' });
  const files = readdirSync(directory, { recursive: true, withFileTypes: true }).filter((one) => one.isFile());
  return files.map((one) => join(one.parentPath ?? one.path, one.name)).sort();
}

// A server, its volumes, and a slicer to compare with.
class Server {
  constructor({ address, volumes, directory }) {
    Object.assign(this, { address, volumes, directory, program });
    this.stations = volumes.map((file) => basename(file).slice(0, 4));
    this.slicer = new Slicer({ address, directory, difference: join(build, 'tests/viewer/viewer_difference') });
  }
  get station() {
    return this.stations[0];
  }
  get other() {
    return this.stations.at(-1);
  }
  async json(path) {
    return (await fetch(`${this.address}/api/v1/${path}`)).json();
  }
  // Returns the grids of stations. Waits for them, because the server may answer before it has gridded all volumes.
  grids(stations = new Set(this.stations)) {
    return gridsOf(this.address, [...stations]);
  }
  // Returns the newest grid of a station and a moment.
  async grid(station, moment = 'REF') {
    return (await this.grids([station])).findLast((one) => one.domain === station && one.moment === moment);
  }
}

// Replaces the files of the page by those in a directory, so that changes of the page need no build of the server.
const takePageFrom = (page, directory) =>
  page.route(/\/view\/([\w.]*)(#|$)/, async (route) => {
    const file = join(directory, basename(new URL(route.request().url()).pathname).replace(/^view$/, 'index.html'));
    const response = await route.fetch();
    await (existsSync(file) ? route.fulfill({ response, body: readFileSync(file) }) : route.fulfill({ response }));
  });

export const test = base.extend({
  // Paths of raw volumes. If there are none, the server gets a simulated volume.
  volumes: [[], { option: true, scope: 'worker' }],
  server: [
    async ({ volumes }, use) => {
      const directory = mkdtempSync(join(tmpdir(), 'stormcellar-viewer-'));
      const files = volumes.length > 0 ? volumes : simulate(join(directory, 'made')).slice(0, 1);
      const { address, stop } = await startServer(program, files);
      const server = new Server({ address, volumes: files, directory });
      await server.grids();
      await use(server);
      await stop();
      rmSync(directory, { recursive: true, force: true });
    },
    { scope: 'worker', timeout: 120_000 },
  ],
  // The address for the page. A check may put a relay before the server.
  address: ({ server }, use) => use(server.address),
  // Matches the errors of the page that a check provokes.
  provoked: [/(?!)/, { option: true }],
  viewer: async ({ page, address, provoked }, use) => {
    if (process.env.STORMCELLAR_PAGE) await takePageFrom(page, process.env.STORMCELLAR_PAGE);
    const viewer = new ViewerPage(page, address);
    await use(viewer);
    expect(viewer.trouble.filter((line) => !provoked.test(line)), 'nothing of the page failed').toEqual([]);
    const elsewhere = (url) => ![`${address}/`, 'data:', 'blob:'].some((begin) => url.startsWith(begin));
    expect(viewer.requests.filter(elsewhere), 'every request goes to the server of the page').toEqual([]);
  },
  // Skips checks whose volumes are not on this machine.
  needVolumes: [
    async ({ volumes }, use, info) => {
      const missing = volumes.filter((file) => !existsSync(file));
      info.skip(missing.length > 0, `not here: ${missing.map((file) => basename(file)).join(' ')}`);
      await use();
    },
    { auto: true },
  ],
});

// Prints a figure, because passing checks print nothing.
export const report = (text) => console.log(`  ${text}`);

// Checks that a picture of the page differs little from the slicer's picture.
export function expectLikeSlicer(what, { p99, mean, most, count }) {
  report(`${what}: dE ${p99} (mean ${mean}, most ${most}) over ${count} pixels`);
  expect(p99, `${what}: dE`).toBeLessThanOrEqual(mostDifference);
  expect(count, `${what}: pixels`).toBeGreaterThan(300);
}
