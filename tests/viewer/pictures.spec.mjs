// Compares the pictures that the page saves with the page.
import { expect, test } from './fixtures.mjs';
import { decoded } from './pixels.mjs';

test.use({ viewport: { width: 796, height: 532 } });

const view = (station, slices) => `domain=${station}&moment=REF&zoom=2&exaggeration=3&quality=${encodeURIComponent(slices)}`;

// Returns the number of pixels of letters over the page's picture, and how many of these a saved picture has at the
// same places.
async function lettersIn(page, href) {
  const saved = await decoded(page, href);
  const letters = await page.locator('#labels').evaluate((labels) => {
    const shown = labels.getContext('2d').getImageData(0, 0, labels.width, labels.height).data;
    const found = [];
    for (let y = 80; y < labels.height; ++y) {
      for (let x = 0; x < labels.width - 100; ++x) {
        const at = 4 * (y * labels.width + x);
        if (shown[at + 3] === 255 && shown[at] >= 180) found.push([x, y, shown[at]]);
      }
    }
    return found;
  });
  const isSame = ([x, y, red]) => x < saved.width && y < saved.height && Math.abs(saved.at(x, y)[0] - red) < 3;
  return { letters: letters.length, same: letters.filter(isSame).length };
}

// Returns how many pixels differ between two saved pictures.
async function differing(page, ...both) {
  const [one, other] = await Promise.all(both.map((href) => decoded(page, href)));
  const { width, height } = one;
  if (width !== other.width || height !== other.height) return width * height;
  let off = 0;
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const [a, b] = [one.at(x, y), other.at(x, y)];
      if (Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) > 12) ++off;
    }
  }
  return off;
}

test.describe('a saved picture', () => {
  // 2026-11-28: at half resolution, names were at twice their distances.
  test('has names at the same places as the page', async ({ page, viewer, server: { station } }) => {
    await viewer.open(view(station, '64 slices, half resolution'));
    await viewer.catchLinks();
    const { href } = await viewer.takenBy('save');
    const { letters, same } = await lettersIn(page, href);
    expect(letters, 'pixels of letters').toBeGreaterThan(200);
    expect(same, 'pixels of letters that are where the page shows them').toBeGreaterThan(0.99 * letters);
  });

  // 2026-11-28: 7 of 8 pictures had the time of the next picture.
  test('shows the time that it names, also during playback', { tag: '@sequence' }, async ({ page, viewer, server }) => {
    await viewer.open(view(server.station, '64 slices'));
    await viewer.catchLinks();
    await viewer.until(() => Number(document.getElementById('times').max) >= 4);
    await viewer.press('play');
    const played = [];
    for (let i = 0; i < 5; ++i) played.push(await viewer.takenBy('save'));
    await viewer.press('play');
    const { grids } = await server.json(`grids?domain=${server.station}&moment=REF`);
    const times = grids.map(({ time }) => time);
    for (const { name, title, href } of played) {
      const at = times.findIndex((time) => name.includes(time.replace(/:/g, '')));
      await viewer.settled(() => viewer.give('times', at, 'input'));
      const still = await viewer.takenBy('save');
      expect(title, `the title beside ${name}`).toContain(times[at].slice(0, 19).replace('T', ' '));
      expect(still.name).toBe(name);
      expect(await differing(page, href, still.href), `pixels of ${name} that differ`).toBeLessThan(50);
    }
  });

  // 2026-11-28: a picture of velocities had SW in its name.
  test('names the drawn moment while another moment is loading', async ({ page, viewer, server: { station } }) => {
    await viewer.open(view(station, '64 slices'));
    await viewer.catchLinks();
    await page.evaluate(() => {
      document.getElementById('moment-VEL').click();
      document.getElementById('save').click();
    });
    const { name } = await viewer.until(() => window.taken, null, 60_000);
    expect(name).toContain('_VEL_');
    expect(await viewer.data('drawn')).toContain('/VEL/');
  });
});

// Keeps the texts that are drawn from now on, by the id of their canvas; a saved picture has no id.
const catchTexts = (page) =>
  page.evaluate(() => {
    window.drawnTexts = {};
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
      (window.drawnTexts[this.canvas.id] ??= []).push(text);
      fillText.call(this, text, ...at);
    };
  });
const textsOn = (page, id) => page.evaluate((id) => window.drawnTexts[id] ?? [], id);

test('page and saved picture tell scale, station, Nyquist velocity and radar status', async ({ page, viewer, server }) => {
  const { station } = server;
  await page.route(/\/api\/v1\/grids\/[^/]+\/VEL\/[^/]+$/, async (route) => {
    const response = await route.fetch();
    const facts = await response.json();
    facts.provenance.radar_troubles = [`${station}: on auxiliary power`];
    await route.fulfill({ response, json: facts });
  });
  await viewer.open(view(station, '64 slices').replace('REF', 'VEL'));
  const { stations } = await server.json(`stations?station=${station}`);
  const { path } = await server.grid(station, 'VEL');
  const { sweeps } = await server.json(`stations/${station}/volumes/${path.split('/').pop()}/sweeps`);
  const speeds = sweeps
    .filter(({ moments }) => moments.some(({ moment, chosen }) => moment === 'VEL' && chosen))
    .map(({ nyquist_mps }) => Number(nyquist_mps.toFixed(1)));
  const [least, most] = [Math.min(...speeds), Math.max(...speeds)];
  const nyquist = `Nyquist velocity ${least === most ? '' : `${least} to `}${most} m/s`;
  const told = `${nyquist} · The radar reports ${station}: on auxiliary power`;
  const place = [stations[0].name, stations[0].state].filter(Boolean).join(', ');
  await expect(viewer.byId('title')).toContainText(`${station}  ${place}  20`);
  await expect(viewer.byId('station-told')).toHaveText(told);
  await viewer.catchLinks();
  await catchTexts(page);
  await viewer.takenBy('save');
  expect(await textsOn(page, 'labels'), 'the scale').toContainEqual(expect.stringMatching(/^\d+ km at the center$/));
  const saved = (await textsOn(page, '')).join('  ');
  expect(saved).toContain(`${station}  ${place}`);
  expect(saved).toContain(told);
  // The lowest cut alone has one Nyquist velocity. Moments without velocities have none.
  await viewer.show(`${view(station, '64 slices').replace('REF', 'VEL')}&volume=0&elevation=0.5`);
  await expect(viewer.byId('station-told')).toHaveText(/^Nyquist velocity [\d.]+ m\/s · /);
  await viewer.settled(() => viewer.press('moment-REF'));
  await expect(viewer.byId('station-told')).toBeHidden();
});

// 2026-11-30: low windows did not tell that heights were exaggerated.
test('page and saved picture tell how much heights are exaggerated', async ({ page, viewer, server: { station } }) => {
  await viewer.open(view(station, '64 slices').replace('exaggeration=3', 'exaggeration=2.5'));
  const told = viewer.byId('legend').getByText('heights × 2.5');
  for (const [width, height] of [[796, 532], [700, 360], [640, 360], [360, 640]]) {
    await viewer.resize(width, height);
    await expect(told, `at ${width} x ${height}`).toBeVisible();
    const [{ x, y, ...size }, foot] = await Promise.all([told.boundingBox(), viewer.byId('foot').boundingBox()]);
    expect([x + size.width <= width, y + size.height <= foot.y], `in its place at ${width} x ${height}`).toEqual([true, true]);
    await viewer.keep(`heights-${width}`);
  }
  await viewer.catchLinks();
  await catchTexts(page);
  await viewer.takenBy('save');
  expect(await textsOn(page, '')).toContain('heights\u00a0×\u00a02.5');
  await viewer.give('exaggeration', 1, 'input');
  await viewer.drawn();
  await expect(viewer.byId('legend')).not.toContainText('heights');
});

// 2026-11-28: the button of the next moment was highlighted while the old picture was still shown.
test('the button of the drawn moment is highlighted', async ({ page, viewer, server: { station } }) => {
  await viewer.open(view(station, '64 slices'));
  await viewer.settled(() => viewer.press('moment-VEL'));
  const lit = () => page.evaluate(() => ['aria-pressed', 'aria-busy'].map((name) => document.querySelector(`#moments [${name}=true]`)?.textContent ?? ''));
  const held = new Promise((hold) => page.route(/\/packed/, (route) => hold(route)));
  await viewer.press('moment-SW');
  const route = await held;
  expect(await lit(), 'the highlighted moment, and the moment that is loading').toEqual(['VEL', 'SW']);
  await route.continue();
  await viewer.until(() => document.documentElement.dataset.drawn?.includes('/SW/'), null, 60_000);
  expect(await lit(), 'then').toEqual(['SW', '']);
});
