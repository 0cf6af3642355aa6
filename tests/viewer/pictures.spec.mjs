// Checks pictures that the page saves against what it shows.
import { expect, test } from './fixtures.mjs';

test.use({ viewport: { width: 796, height: 532 } });

const view = (station, slices) => `domain=${station}&moment=REF&zoom=2&exaggeration=3&quality=${encodeURIComponent(slices)}`;

// Returns how many pixels of letters the page shows over its picture, and how many of them a saved picture has there.
function lettersIn(page, href) {
  return page.evaluate(async (href) => {
    const image = new Image();
    image.src = href;
    await image.decode();
    const labels = document.getElementById('labels');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [image.width, image.height];
    const pen = copy.getContext('2d');
    pen.drawImage(image, 0, 0);
    const saved = pen.getImageData(0, 0, copy.width, copy.height).data;
    const shown = labels.getContext('2d').getImageData(0, 0, labels.width, labels.height).data;
    let [letters, same] = [0, 0];
    for (let y = 80; y < labels.height; ++y) {
      for (let x = 0; x < labels.width - 100; ++x) {
        const at = 4 * (y * labels.width + x);
        if (shown[at + 3] < 255 || shown[at] < 180) continue;
        ++letters;
        const there = 4 * (y * copy.width + x);
        if (x < copy.width && y < copy.height && Math.abs(saved[there] - shown[at]) < 3) ++same;
      }
    }
    return { letters, same };
  }, href);
}

// Returns how many pixels differ between two saved pictures.
function differing(page, one, other) {
  return page.evaluate(async (both) => {
    const pixels = async (href) => {
      const image = new Image();
      image.src = href;
      await image.decode();
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [image.width, image.height];
      const pen = copy.getContext('2d');
      pen.drawImage(image, 0, 0);
      return pen.getImageData(0, 0, copy.width, copy.height).data;
    };
    const [one, other] = [await pixels(both[0]), await pixels(both[1])];
    let off = 0;
    for (let i = 0; i < one.length; i += 4) if (Math.abs(one[i] - other[i]) + Math.abs(one[i + 1] - other[i + 1]) > 12) ++off;
    return one.length === other.length ? off : one.length;
  }, [one, other]);
}

test.describe('a saved picture', () => {
  // 2026-11-28: with half resolution they were at twice their distances.
  test('has names where the page has them', async ({ page, viewer, server: { station } }) => {
    await viewer.open(view(station, '64 slices, half resolution'));
    await viewer.catchLinks();
    const { href } = await viewer.takenBy('save');
    const { letters, same } = await lettersIn(page, href);
    expect(letters, 'pixels of letters').toBeGreaterThan(200);
    expect(same, 'those that are where the page shows them').toBeGreaterThan(0.99 * letters);
  });

  // 2026-11-28: 7 of 8 had the time of the next one.
  test('is of the time that it names, while it plays', { tag: '@sequence' }, async ({ page, viewer, server }) => {
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

  // 2026-11-28: velocities were named SW.
  test('is of the drawn moment, while another one comes', async ({ page, viewer, server: { station } }) => {
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

// 2026-11-28: it was that of the next one, over the picture before.
test('the lit button is that of the drawn moment', async ({ page, viewer, server: { station } }) => {
  await viewer.open(view(station, '64 slices'));
  await viewer.settled(() => viewer.press('moment-VEL'));
  const lit = () => page.evaluate(() => ['aria-pressed', 'aria-busy'].map((name) => document.querySelector(`#moments [${name}=true]`)?.textContent ?? ''));
  const held = new Promise((hold) => page.route(/\/packed/, (route) => hold(route)));
  await viewer.press('moment-SW');
  const route = await held;
  expect(await lit(), 'what is lit and what is waited for').toEqual(['VEL', 'SW']);
  await route.continue();
  await viewer.until(() => document.documentElement.dataset.drawn?.includes('/SW/'), null, 60_000);
  expect(await lit(), 'then').toEqual(['SW', '']);
});
