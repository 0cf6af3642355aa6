// Checks the data server's own page: its layout at several widths, events in an EventSource, and what pages of other
// servers may read (scripts/check-browser).
import { mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import { daemon, expect, program, simulate, test as base } from './fixtures.mjs';
import { startBeside, startServer } from './server.mjs';

const scene = new URL('../../scenes/small-storm.toml', import.meta.url);

const test = base.extend({
  // A daemon that has one volume, a server of what it keeps, and a volume that may come.
  live: [
    async ({}, use) => {
      const directory = mkdtempSync(join(tmpdir(), 'stormcellar-index-'));
      const own = join(directory, 'scene.toml');
      writeFileSync(own, readFileSync(scene, 'utf8').replace('"XSYN"', '"KFTG"'));
      const [first, second] = simulate(join(directory, 'made'), own);
      for (const name of ['drop', 'state']) mkdirSync(join(directory, name));
      const drop = (file) => renameSync(file, join(directory, 'drop', basename(file)));
      drop(first);
      const config = join(directory, 'stormcellard.toml');
      writeFileSync(config, '[paths]\ndrop = "drop"\nstate = "state"\ncache = "cache"\n');
      const watching = startBeside(daemon, ['--config', config]);
      let said = '';
      watching.child.stderr.setEncoding('utf8').on('data', (text) => (said += text));
      await expect.poll(() => said, { timeout: 60_000 }).toContain('gridded KFTG');
      const { address, stop } = await startServer(program, ['--config', config]);
      await use({ address, comes: () => drop(second) });
      await stop();
      await watching.stop();
      rmSync(directory, { recursive: true, force: true });
    },
    { scope: 'worker', timeout: 120_000 },
  ],
  // A server of somebody else.
  another: async ({}, use) => {
    const other = createServer((request, response) => {
      response.setHeader('Content-Type', 'text/html');
      response.end('<title>another server</title>');
    });
    await new Promise((done) => other.listen(0, '127.0.0.1', done));
    await use(`http://127.0.0.1:${other.address().port}/`);
    other.close();
  },
});

// Returns what sticks out of the box that it is in. A function of the page.
function misplaced() {
  const out = [];
  if (document.documentElement.scrollWidth > innerWidth) out.push('the page scrolls sideways');
  for (const section of document.querySelectorAll('section')) {
    const right = section.getBoundingClientRect().right - parseFloat(getComputedStyle(section).paddingRight);
    for (const element of section.querySelectorAll('td, th, time, a, i, p, summary'))
      if (element.getBoundingClientRect().right > right + 1) out.push(element.outerHTML);
  }
  return out;
}

for (const width of [360, 796, 1920]) {
  for (const colorScheme of ['light', 'dark']) {
    test.describe(`${width} pixels, ${colorScheme}`, () => {
      test.use({ viewport: { width, height: 900 }, colorScheme });
      test('everything is in its place', async ({ page, live }) => {
        const trouble = [];
        page.on('console', (message) => trouble.push(message.text()));
        page.on('pageerror', (error) => trouble.push(error.message));
        page.on('response', (response) => response.status() >= 400 && trouble.push(response.url()));
        await page.goto(`${live.address}/`);
        expect(await page.evaluate(misplaced)).toEqual([]);
        expect(trouble).toEqual([]);
        const pictures = process.env.STORMCELLAR_PICTURES;
        if (pictures) await page.screenshot({ path: join(pictures, `index-${width}-${colorScheme}.png`), fullPage: true });
      });
    });
  }
}

test('an EventSource hears of a volume', async ({ page, live }) => {
  await page.goto(`${live.address}/`);
  await page.evaluate(() => {
    window.heard = [];
    const events = new EventSource('/api/v1/events?station=KFTG');
    events.onopen = () => window.heard.push('open');
    for (const kind of ['volume_begun', 'volume_complete'])
      events.addEventListener(kind, (event) => window.heard.push(`${kind} ${JSON.parse(event.data).station}`));
  });
  const heard = () => page.evaluate(() => window.heard);
  await expect.poll(heard).toContain('open');
  live.comes();
  await expect.poll(heard, { timeout: 60_000 }).toContain('volume_complete KFTG');
});

test.describe('another server', () => {
  test('cannot read ours', async ({ page, live, another }) => {
    await page.goto(another);
    const read = (url) => page.evaluate((url) => fetch(url).then((answer) => answer.text(), () => 'refused'), url);
    expect(await read('/'), 'its page reads itself').toContain('another server');
    expect(await read(`${live.address}/api/v1/stations`)).toBe('refused');
  });

  test('is what another name is taken for', async ({ page, live }) => {
    const answer = await page.goto(`http://radar.example:${new URL(live.address).port}/`);
    expect(answer.status()).toBe(421);
  });
});
