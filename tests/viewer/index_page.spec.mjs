// Checks the index page of the data server: its layout at several widths, events in an EventSource, and which data
// pages of other servers may read (scripts/check-browser).
import { mkdirSync, mkdtempSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';

import { daemon, expect, program, simulate, test as base } from './fixtures.mjs';
import { startBeside, startServer } from './server.mjs';

const scene = new URL('../../scenes/small-storm.toml', import.meta.url);

const test = base.extend({
  // A daemon with one volume, a server of its data, and another volume that a test may add.
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
  // Another web server, whose page asks for our data.
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

// Returns texts about elements that stick out of their box. Runs in the page.
function misplaced() {
  const out = [];
  if (document.documentElement.scrollWidth > innerWidth) out.push('the page scrolls sideways');
  for (const section of document.querySelectorAll('section:not([hidden])')) {
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
        await expect(page.locator('tr', { hasText: 'KFTG' })).toContainText('REF');
        expect(await page.evaluate(misplaced)).toEqual([]);
        expect(trouble).toEqual([]);
        const pictures = process.env.STORMCELLAR_PICTURES;
        if (pictures) await page.screenshot({ path: join(pictures, `index-${width}-${colorScheme}.png`), fullPage: true });
      });
    });
  }
}

test('the examples name a station of the server', async ({ page, live }) => {
  await page.goto(`${live.address}/`);
  await expect(page.locator('.lead')).toContainText('1 station; the newest volume');
  const example = page.locator('details', { hasText: 'rclone' }).locator('code');
  await expect(example).toContainText(/\/s3":[^/]+\/\d{4}\/\d\d\/\d\d\/KFTG\//);
});

test.describe('without scripts', () => {
  test.use({ javaScriptEnabled: false });
  test('the page links to the lists and has examples', async ({ page, live }) => {
    await page.goto(`${live.address}/`);
    await expect(page.getByRole('link', { name: 'for stations' })).toHaveAttribute('href', '/api/v1/stations');
    await page.getByText('GR2Analyst, GRLevel2').click();
    await expect(page.getByText(`${live.address}/nexrd2`)).toBeVisible();
  });
});

// Opens the page with these answers of the API.
async function open(page, live, { stations, domains = { domains: [] } }) {
  for (const [name, json] of Object.entries({ stations, domains })) await page.route(`**/api/v1/${name}`, (route) => route.fulfill({ json }));
  await page.goto(`${live.address}/`);
}
const ago = (age_s) => ({ time: '2026-05-01T11:58:00Z', age_s });
const station = (name, facts) => ({ station: name, newest_volume: null, newest_grid: null, moments: [], silent_s: null, ...facts });
const listOf = (...stations) => ({ time: '2026-05-01T12:00:00.5Z', stations });

test('a row tells the ages of a station\'s data, and how long the station has been silent', async ({ page, live }) => {
  const domain = (name, part_of = null) => ({ domain: name, part_of, moments: [{ moment: 'REF', newest: '2026-05-01T11:56:00Z', age_s: 240 }] });
  await open(page, live, {
    stations: listOf(
      station('KABR', { name: 'Aberdeen', state: 'SD', newest_volume: ago(10800), silent_s: 10800 }),
      station('KTLX', { newest_volume: ago(120), newest_grid: ago(120), moments: ['REF', 'VEL'] }),
    ),
    domains: { domains: [domain('KTLX'), domain('northeast'), domain('northeast.KTLX', 'northeast'), { ...domain('empty'), moments: [] }] },
  });
  await expect(page.locator('.lead')).toHaveText('2 stations, 1 of them silent; the newest volume began 2 min ago.');
  await expect(page.locator('.asof')).toContainText('As of 2026-05-01 12:00:00 UTC.');
  const cells = (name) => page.locator('tr', { hasText: name }).locator('th, td');
  await expect(cells('KABR')).toHaveText(['KABR Aberdeen, SD', 'silent for 3 h 0 min', '3 h 0 min 2026-05-01 11:58:00', 'none', '', /^\s*volumes\s+about\s*$/]);
  await expect(cells('KTLX')).toHaveText(['KTLX', 'live', /2 min/, /2 min/, 'REF VEL', /volumes\s+grids\s+about/]);
  await expect(page.locator('#domains tbody tr')).toHaveText(/northeast\s+4 min 2026-05-01 11:56:00\s+REF\s+grids/);
  await expect(page.locator('code', { hasText: 'siphon' })).toContainText("stations('KTLX').time(datetime(2026, 5, 1, 11, 58))");
});

test('old data have a date instead of an age', async ({ page, live }) => {
  await open(page, live, { stations: listOf(station('KAAA', { newest_volume: ago(1096 * 86400) }), station('KBBB', { newest_volume: ago(3 * 86400) })) });
  await expect(page.locator('td.volume')).toHaveText(['2026-05-01 11:58:00', '2026-05-01 11:58:00']);
  await expect(page.locator('.lead')).toHaveText('2 stations; the newest volume is of 2026-05-01.');
});

test('ages are written in fitting units', async ({ page, live }) => {
  const day = 86400;
  const ages = { 0: '0 s', 89: '89 s', 90: '1 min', 5399: '89 min', 19259: '5 h 20 min', [2 * day - 1]: '47 h 59 min' };
  const stations = Object.keys(ages).map((age, i) => station(`KAA${i}`, { newest_volume: ago(Number(age)) }));
  await open(page, live, { stations: listOf(...stations) });
  await expect(page.locator('td.volume b')).toHaveText(Object.values(ages));
});

test('the page says if data are from the future, and data from the future do not make a station live', async ({ page, live }) => {
  await open(page, live, {
    stations: listOf(station('KAAA', { newest_grid: ago(-180 * 86400) }), station('KBBB', { newest_volume: ago(-120) }), station('KCCC', { newest_volume: undefined })),
  });
  await expect(page.locator('.lead')).toHaveText('3 stations; the newest volume has a time in the future.');
  await expect(page.locator('td.state')).toHaveText(['archive', 'live', 'archive']);
  await expect(page.locator('td.volume')).toHaveText(['not known', /^in the future/, 'not known']);
});

test('names cannot break the page', async ({ page, live }) => {
  const evil = `"><script>document.title = 'broken'</script>$&`;
  await open(page, live, { stations: listOf(station(evil, { name: evil, moments: [evil], newest_volume: ago(1) })) });
  await expect(page.locator('th b')).toHaveText(evil);
  await expect(page.getByRole('link', { name: 'about' })).toHaveAttribute('href', `/api/v1/stations?station=${encodeURIComponent(evil)}`);
  expect(await page.title()).toMatch(/^Weather radar: 127/);
});

test('the page says that there are no data yet, or that the server fails', async ({ page, live }) => {
  await open(page, live, { stations: listOf() });
  await expect(page.locator('.lead')).toHaveText('Nothing has come yet.');
  await expect(page.locator('section:visible')).toHaveText([/There are none yet/, /Connect a program/]);
  await page.route('**/api/v1/stations', (route) => route.fulfill({ status: 503 }));
  await page.reload();
  await expect(page.locator('.lead')).toHaveText('The lists could not be read (stations: 503).');
});

test('an EventSource receives the events of a volume', async ({ page, live }) => {
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
  test('cannot read the data of our server', async ({ page, live, another }) => {
    await page.goto(another);
    const read = (url) => page.evaluate((url) => fetch(url).then((answer) => answer.text(), () => 'refused'), url);
    expect(await read('/'), 'its page reads itself').toContain('another server');
    expect(await read(`${live.address}/api/v1/stations`)).toBe('refused');
  });

  test('cannot reach our server by another host name', async ({ page, live }) => {
    const answer = await page.goto(`http://radar.example:${new URL(live.address).port}/`);
    expect(answer.status()).toBe(421);
  });
});
