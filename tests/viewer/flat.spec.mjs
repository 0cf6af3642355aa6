// Checks 2D, the map of one tilt: how the user comes to the map and back, that the map never turns, and the choice of a
// tilt.
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { expect, program, test as base } from './fixtures.mjs';
import { data, startServer } from './server.mjs';
import { gridsOf } from './viewer_page.mjs';

const isOf = (row, moment) => row.moments.some((one) => one.moment === moment);

const test = base.extend({
  viewport: { width: 800, height: 600 },
  // A view in 3D with little echo, which is drawn quickly.
  solid: ({ server: { station } }, use) =>
    use(`domain=${station}&moment=REF&azimuth=217&tilt=71&zoom=2&field-of-view=40&look-at-km=10,-20,4&least=60`),
  flat: ({ server: { station } }, use) => use(`domain=${station}&moment=REF&view=2d&least=40`),
  // Cuts of the newest volume with reflectivity.
  cuts: async ({ server }, use) => {
    const { station } = server;
    const { volumes } = await server.json(`stations/${station}/volumes`);
    const { sweeps } = await server.json(`stations/${station}/volumes/${volumes.at(-1).time}/sweeps`);
    await use(sweeps.filter((row) => isOf(row, 'REF')));
  },
});

const cameraOf = async (viewer) => [await viewer.number('azimuth'), await viewer.number('tilt'), await viewer.number('field-of-view')];
const map = [180, 0, 0];
// Returns the place under a pixel of a map, in pixels of the page from the middle of the grid at zoom 1.
async function placeAt(viewer, [x, y], [width, height] = [800, 600]) {
  const zoom = await viewer.number('zoom');
  const kmAPixel = (1.04 * 460) / height / zoom;
  const [east, north] = ((await viewer.told('look-at-km')) ?? '0,0,0').split(',').map(Number);
  return [east + (x - width / 2) * kmAPixel, north - (y - height / 2) * kmAPixel];
}
const expectSamePlace = (what, a, b) => a.forEach((km, i) => expect(Math.abs(km - b[i]), what).toBeLessThan(1));

test('a button and keys lead to 2D and back, and the address tells 2D from 3D', async ({ viewer, solid }) => {
  await viewer.open(solid);
  await viewer.settled(() => viewer.key('m'));
  const before = await viewer.page.evaluate(() => location.hash);
  await expect(viewer.byId('mode-3d')).toHaveAttribute('aria-pressed', 'true');
  await viewer.settled(() => viewer.byId('mode-2d').click());
  await expect(viewer.byId('mode-2d')).toHaveAttribute('aria-pressed', 'true');
  expect(await cameraOf(viewer)).toEqual(map);
  expect([await viewer.told('view'), await viewer.told('volume'), await viewer.told('maximum')]).toEqual(['2d', '0', null]);
  expect(await viewer.text('layers-told')).toMatch(/sweep of \w{4}: 0\.\d° \d\d:\d\d:\d\d/);
  expectSamePlace('2D shows the place of 3D', await placeAt(viewer, [400, 300]), [10, -20]);
  await viewer.settled(() => viewer.key('3'));
  expect(await viewer.page.evaluate(() => location.hash), 'camera and layers come back').toBe(before);
  await viewer.settled(() => viewer.key('2'));
  const link = await viewer.page.evaluate(() => location.hash);
  await viewer.open(link.slice(1));
  expect(await viewer.page.evaluate(() => location.hash), 'a link leads to 2D').toBe(link);
  await expect(viewer.byId('mode-2d')).toHaveAttribute('aria-pressed', 'true');
  await viewer.settled(() => viewer.key('o'));
  await expect(viewer.byId('mode-3d'), 'an oblique view is in 3D').toHaveAttribute('aria-pressed', 'true');
  await viewer.key('?');
  await expect(viewer.byId('reading'), 'the table of keys').toContainText('2D, 3D');
});

test('2D shows one tilt, gate by gate, and no volume', async ({ viewer, server: { station } }) => {
  const view = `domain=${station}&moment=REF&ground=0`;
  await viewer.open(`${view}&view=2d`);
  const flat = await viewer.pixels();
  await viewer.show(`${view}&volume=0&elevation=0.5&azimuth=180&tilt=0&field-of-view=0`);
  expect(Buffer.compare(flat, await viewer.pixels()), 'the picture is that of the sweep from above').toBe(0);
});

test('the map moves and zooms, but never turns', async ({ viewer, flat }) => {
  const at = [300, 350];
  const by = [60, -40];
  await viewer.open(`${flat}&zoom=2`);
  for (const [what, drag] of [['a drag', viewer.drag], ['a drag with Shift', viewer.shiftDrag]]) {
    const before = await placeAt(viewer, at);
    await viewer.settled(() => drag.call(viewer, at, by));
    expectSamePlace(`${what} moves the map`, await placeAt(viewer, [at[0] + by[0], at[1] + by[1]]), before);
    expect(await cameraOf(viewer), `after ${what}`).toEqual(map);
  }
  const under = await placeAt(viewer, at);
  await viewer.changes('the wheel zooms', 'zoom', () => viewer.wheel(at, -300), (before, after) => after > before);
  expectSamePlace('the wheel keeps the place under the pointer', await placeAt(viewer, at), under);
  const spread = async () => {
    await viewer.touch('touchStart', [[280, 350], [320, 350]]);
    for (const apart of [10, 20, 30]) await viewer.touch('touchMove', [[280 - apart, 350], [320 + apart, 350]]);
    await viewer.touch('touchEnd', []);
  };
  await viewer.changes('two fingers zoom', 'zoom', spread, (before, after) => after > 1.5 * before);
  expectSamePlace('two fingers keep the place between them', await placeAt(viewer, at), under);
  for (const key of ['Shift+ArrowLeft', 'Shift+ArrowUp', 'p', 't']) await viewer.settled(() => viewer.key(key));
  await viewer.settled(() => viewer.press('compass'));
  expect(await cameraOf(viewer)).toEqual(map);
  await expect(viewer.byId('views')).toBeHidden();
});

test('a list names each cut, and keys and buttons change the tilt', async ({ viewer, flat, cuts }) => {
  const told = viewer.byId('layers-told');
  await viewer.open(flat);
  const list = viewer.byId('tilt');
  const texts = await list.locator('option').allTextContents();
  expect(texts).toHaveLength(cuts.length);
  for (const { elevation_deg, start } of cuts)
    expect(texts.filter((text) => text.startsWith(`${elevation_deg.toFixed(1)}° ${start.slice(11, 19)}`))).toHaveLength(1);
  const isSplit = cuts.some((row) => isOf(row, 'VEL')) && cuts.some((row) => !isOf(row, 'VEL'));
  if (isSplit) expect(texts.some((text) => text.endsWith(' long range'))).toBe(true);
  const tilts = [...new Set(cuts.map(({ elevation_deg }) => elevation_deg.toFixed(1)))];
  const chosen = () => list.evaluate((one) => one.selectedOptions[0].textContent);
  const first = await chosen();
  expect(first).toContain(tilts[0]);
  await expect(viewer.byId('tilt-lower'), 'there is no lower tilt').toHaveAttribute('aria-disabled', 'true');
  await viewer.settled(() => viewer.key('ArrowUp'));
  expect(Number.parseFloat(await chosen())).toBeGreaterThan(Number.parseFloat(first) + 0.2);
  await expect(told).toContainText(await chosen());
  await viewer.settled(() => viewer.byId('tilt-higher').click());
  await viewer.settled(() => viewer.key('ArrowDown'));
  await viewer.settled(() => viewer.byId('tilt-lower').click());
  expect(await chosen(), 'two tilts up and down again').toBe(first);
  const highest = cuts.reduce((best, row) => (row.elevation_deg > best.elevation_deg ? row : best));
  await viewer.press('scan-open');
  const ofHighest = viewer.byId(`cut-${highest.sweep}`);
  await expect(ofHighest).toHaveAttribute('aria-pressed', 'false');
  await viewer.settled(() => ofHighest.click());
  await expect(ofHighest, 'the list of the scan shows a cut, too').toHaveAttribute('aria-pressed', 'true');
  await expect(told).toContainText(highest.start.slice(11, 19));
  await expect(viewer.byId('tilt-higher'), 'there is no higher tilt').toHaveAttribute('aria-disabled', 'true');
  await viewer.press('scan-open');
  const other = texts.find((text) => Number.parseFloat(text) === Number.parseFloat(first) && text !== first);
  if (!other) return;
  await viewer.settled(() => list.selectOption({ label: other }));
  await expect(told, 'the other cut of this tilt').toContainText(other);
  expect(await viewer.told('sweep')).not.toBeNull();
});

for (const [width, height] of [[390, 844], [560, 420], [1000, 700], [1440, 900]])
  test(`the controls of 2D are in their place at ${width} x ${height}`, async ({ viewer, flat }) => {
    await viewer.resize(width, height);
    await viewer.open(`${flat}&zoom=0.05`);
    const boxOf = (id) => viewer.byId(id).boundingBox();
    const isApart = (a, b) => a.x >= b.x + b.width || b.x >= a.x + a.width || a.y >= b.y + b.height || b.y >= a.y + a.height;
    for (const id of ['mode', 'tilts']) {
      const box = await boxOf(id);
      expect(box.height, 'high enough for a finger').toBeGreaterThanOrEqual(44);
      expect(box.x).toBeGreaterThanOrEqual(0);
      expect(box.x + box.width).toBeLessThanOrEqual(width);
      for (const other of ['head', 'foot', 'compass', 'scale', 'reset-view', 'bar', 'legend']) {
        const there = await boxOf(other);
        expect(!there || isApart(box, there), `${id} covers ${other}`).toBe(true);
      }
    }
    await viewer.keep(`flat-${width}`);
  });

// Two volumes of KLOT that came in chunks. The first volume repeats its low cuts (MRLE).
const chunks = ['L2D_230', 'OPENRADAR_KLOT'].map((name) => join(data, 'chunks', name));
const repeated = test.extend({
  address: async ({}, use, info) => {
    info.skip(!chunks.every((folder) => existsSync(folder)), 'the chunks are not here');
    const directory = mkdtempSync(join(tmpdir(), 'stormcellar-repeats-'));
    const files = chunks.map((folder) => {
      const names = readdirSync(folder).sort();
      const file = join(directory, `KLOT${names[0].slice(0, 15).replace('-', '_')}_V06`);
      writeFileSync(file, Buffer.concat(names.map((name) => readFileSync(join(folder, name)))));
      return file;
    });
    const { address, stop } = await startServer(program, files);
    const times = async () => (await gridsOf(address, ['KLOT'])).filter(({ moment }) => moment === 'REF').length;
    await expect.poll(times, 'volumes').toBe(2);
    await use(address);
    await stop();
    rmSync(directory, { recursive: true, force: true });
  },
});

repeated('a loop shows repeated cuts in order of time', async ({ viewer }) => {
  const told = async () => (await viewer.text('layers-told')).match(/\d\d:\d\d:\d\d/)[0];
  await viewer.open('domain=KLOT&moment=REF&view=2d&zoom=0.5');
  await viewer.until(() => document.getElementById('times').max === '1');
  const newest = await told();
  const back = [];
  for (let i = 0; i < 3; ++i) {
    await viewer.settled(() => viewer.key('ArrowLeft'));
    back.push(await told());
  }
  expect(back, 'the last repeat comes first on the way back').toEqual(['12:41:39', '12:38:48', '12:38:48']);
  const link = await viewer.page.evaluate(() => location.hash.slice(1));
  await viewer.settled(() => viewer.key('ArrowRight'));
  expect(await told()).toBe(back[0]);
  await viewer.settled(() => viewer.key('ArrowRight'));
  expect(await told()).toBe(newest);
  await viewer.show(link);
  expect(await told(), 'a link shows the repeat').toBe(back[1]);
  await viewer.page.evaluate(() => {
    window.seen = [];
    const look = () => {
      const [time] = document.getElementById('layers-told').textContent.match(/\d\d:\d\d:\d\d/) ?? [];
      if (time !== window.seen.at(-1)) window.seen.push(time);
      requestAnimationFrame(look);
    };
    look();
  });
  await viewer.press('play');
  const seen = await viewer.until(() => window.seen.length >= 7 && window.seen.slice(0, 7));
  expect(seen).toEqual([back[1], back[0], newest, back[1], back[0], newest, back[1]]);
});
