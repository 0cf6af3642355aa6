// Checks the timeline of the page with several volumes of one station.
import { expect, test as base } from './fixtures.mjs';

const count = (viewer) => viewer.page.evaluate(() => Number(document.getElementById('times').max) + 1);
const shown = (viewer) => viewer.data('drawn');

const test = base.extend({
  viewport: { width: 796, height: 532 },
  view: ({ server }, use) => use(`domain=${server.station}&moment=REF&tilt=0&field-of-view=0`),
  // Times of the volumes. Waits for all of them, because the server may answer before it has gridded the later volumes.
  times: async ({ server }, use) => {
    const times = async () => (await server.grids()).filter(({ moment }) => moment === 'REF').map(({ time }) => time);
    await expect.poll(async () => (await times()).length, 'volumes').toBe(server.volumes.length);
    await use(await times());
  },
  // The newest volume, on a timeline that has all of them.
  newest: async ({ viewer, view, times }, use) => {
    await viewer.open(view);
    await expect.poll(() => count(viewer), 'times of the timeline').toBeGreaterThanOrEqual(times.length);
    await use();
  },
});

test('the newest volume is shown, and steps go back', async ({ viewer, newest }) => {
  expect(await count(viewer)).toBeGreaterThanOrEqual(5);
  expect(await viewer.told('time')).toBe('latest');
  await viewer.settled(() => viewer.press('earlier'));
  const second = await shown(viewer);
  await viewer.settled(() => viewer.press('earlier'));
  expect((await shown(viewer)) < second, 'a step shows the volume before').toBe(true);
});

test('keys follow the newest volume, set a loop, and step in the loop', async ({ viewer, newest }) => {
  await viewer.settled(() => viewer.press('earlier'));
  await viewer.settled(() => viewer.press('earlier'));
  const third = await shown(viewer);
  await viewer.settled(() => viewer.key('l'));
  expect(await viewer.told('time'), 'L follows the newest volume').toBe('latest');
  await viewer.settled(() => viewer.key(','));
  await viewer.key('>');
  await viewer.settled(() => viewer.key(','));
  await viewer.key('<');
  await expect(viewer.byId('loop-all'), '< and > set a loop').toHaveJSProperty('hidden', false);
  expect(await shown(viewer)).toBe(third);
});

// The page must never show a picture of another time than its texts say.
test('playback stays in its loop', async ({ page, viewer, newest }) => {
  await viewer.settled(() => viewer.key(','));
  await viewer.press('loop-to');
  await viewer.settled(() => viewer.press('earlier'));
  await viewer.press('loop-from');
  const first = await shown(viewer);
  await viewer.give('speed', 15);
  await page.evaluate(() => {
    window.seen = [];
    window.seenAtMs = [];
    const look = () => {
      const { drawn } = document.documentElement.dataset;
      if (!drawn || drawn === window.seen.at(-1)) return;
      window.seen.push(drawn);
      window.seenAtMs.push(performance.now());
    };
    new MutationObserver(look).observe(document.documentElement, { attributes: true });
  });
  await viewer.press('play');
  const seen = await viewer.until(() => window.seen.length >= 12 && window.seen);
  await viewer.press('play');
  expect(new Set(seen).size, 'volumes').toBe(2);
  expect(seen).toContain(first);
  const atMs = await page.evaluate(() => window.seenAtMs);
  const stays = seen.slice(1, -1).flatMap((one, i) => (one === first ? [] : [atMs[i + 2] - atMs[i + 1]]));
  expect(Math.min(...stays), 'ms for which the last volume of the loop is shown').toBeGreaterThan(1200);
});

test('the ends of the loop are dragged, and the last volumes are chosen', async ({ page, viewer, newest, times }) => {
  const last = times.length - 1;
  const box = await viewer.byId('times').boundingBox();
  const xOf = (index) => box.x + 8 + ((box.width - 16) * index) / last;
  const ends = () => Promise.all(['from', 'to'].map(async (end) => Number(await viewer.byId(`loop-drag-${end}`).getAttribute('aria-valuenow'))));
  expect(await ends(), 'a loop over all').toEqual([0, last]);
  for (const [end, index, by] of [['from', 1, 1], ['to', last - 1, -1]]) {
    const handle = await viewer.byId(`loop-drag-${end}`).boundingBox();
    const [x, y] = [handle.x + handle.width / 2, handle.y + handle.height - 4];
    await viewer.drag([x, y], [by * (xOf(1) - xOf(0)) - (end === 'from' ? x - xOf(0) : x - xOf(last)), 0]);
    expect((await ends())[end === 'from' ? 0 : 1], `${end} after a drag`).toBe(index);
  }
  await expect(viewer.byId('loop-drag-from')).toHaveAttribute('aria-valuetext', times[1]);
  await viewer.byId('loop-drag-from').focus();
  await viewer.key('ArrowLeft');
  expect(await ends(), 'after an arrow').toEqual([0, last - 1]);
  await viewer.keep('time-loop');
  await viewer.give('loop-last', 6);
  const six = [Math.max(0, last - 5), last];
  expect(await ends()).toEqual(six);
  await viewer.press('loop-all');
  expect(await ends()).toEqual([0, last]);
  await expect(viewer.byId('loop-last')).toHaveValue('0');
  const [play, speed] = await Promise.all(['play', 'speed'].map((id) => viewer.byId(id).boundingBox()));
  expect(speed.x - play.x - play.width, 'the speed is beside Play').toBeLessThan(12);
});

test.describe('in another time zone', () => {
  test.use({ timezoneId: 'America/New_York' });
  test('the title tells the local time', async ({ viewer, newest, times }) => {
    const local = new Date(times.at(-1)).toLocaleTimeString('en-GB', { hour: '2-digit', minute: '2-digit', timeZone: 'America/New_York' });
    await expect(viewer.byId('title')).toContainText(new RegExp(`:\\d\\d UTC \\(([A-Z][a-z]+ \\d+, )?${local} E[DS]T\\)`));
  });
});

test('frames between volumes are made, and the title says so', async ({ viewer, newest }) => {
  await viewer.settled(() => viewer.press('earlier'));
  const before = await count(viewer);
  const kept = await shown(viewer);
  await viewer.give('between', 60);
  await expect.poll(() => count(viewer), 'times with frames every minute').toBeGreaterThan(3 * before);
  await viewer.drawn();
  expect(await shown(viewer), 'the volume that is shown stays').toBe(kept);
  await viewer.press('later');
  const title = viewer.byId('title');
  // Wait longer, because the server makes the frame first.
  await expect(title).toContainText('interpolated, not observed', { timeout: 60_000 });
  await expect(title).toContainText(':00 UTC');
  expect(await viewer.told('between')).toBe('60');
  // 2026-11-28: the page said that there was no volume of a time that has one.
  await expect(viewer.byId('notice')).toHaveText('');
});

// 2026-11-28: the page said "no volume of" a time that has a volume.
test('a link to a volume shows the volume, although there are frames beside it', async ({ viewer, view, times }) => {
  await viewer.open(`${view}&time=${times[1]}&between=60`);
  expect((await shown(viewer)).endsWith(times[1]), await shown(viewer)).toBe(true);
  expect(await viewer.text('notice')).toBe('');
});

// 2026-11-28: the page went to the oldest volume if the user paused before another time was shown.
test('pausing keeps the newest volume', async ({ viewer, times, newest }) => {
  await viewer.press('play');
  await viewer.press('play');
  await viewer.press('moment-VEL');
  await viewer.until(() => document.documentElement.dataset.drawn?.includes('/VEL/'));
  expect((await shown(viewer)).endsWith(times.at(-1)), await shown(viewer)).toBe(true);
  expect(await viewer.text('notice')).toBe('');
});

// 2026-11-28: the page called the later volume the nearest.
test('a link to a time between two volumes shows the nearest volume', async ({ viewer, view, times }) => {
  const wanted = new Date(Date.parse(times[1]) + 60_000).toISOString();
  await viewer.open(`${view}&time=${wanted}`);
  expect((await shown(viewer)).endsWith(times[1]), await shown(viewer)).toBe(true);
  await expect(viewer.byId('notice')).toContainText('the nearest');
});

test.describe('an instant for which there is no frame', () => {
  test.use({ provoked: /404/ });

  // 2026-11-28: the page called the next volume the nearest.
  test('shows the nearest volume, and a step skips the instant', async ({ viewer, view, times }) => {
    const soon = new Date(Date.parse(times[0]) + 46_000).toISOString().slice(0, 19);
    await viewer.open(`${view}&time=${soon}Z&between=60`);
    expect((await shown(viewer)).endsWith(times[0]), await shown(viewer)).toBe(true);
    await expect(viewer.byId('notice')).toContainText('the nearest');
    await viewer.settled(() => viewer.press('later'));
    expect((await shown(viewer)).endsWith(times[0]), await shown(viewer)).toBe(false);
    await expect(viewer.byId('notice')).toHaveText('');
  });
});

test('in 2D, arrows step through the times and keep the tilt', async ({ viewer, newest }) => {
  await viewer.settled(() => viewer.key('2'));
  await viewer.settled(() => viewer.key('ArrowUp'));
  const seen = [await viewer.text('layers-told')];
  for (const key of ['ArrowLeft', 'ArrowLeft', 'ArrowRight']) {
    await viewer.settled(() => viewer.key(key));
    seen.push(await viewer.text('layers-told'));
  }
  expect(seen[3], 'back at an earlier time').toBe(seen[1]);
  expect(new Set(seen).size, 'sweeps of three times').toBe(3);
  const tilts = seen.map((text) => Number(text.match(/[\d.]+(?=°)/)[0]));
  expect(tilts[0], 'the second tilt').toBeGreaterThan(0.7);
  expect(Math.max(...tilts) - Math.min(...tilts), `tilts ${tilts}`).toBeLessThan(0.25);
});

test('panes show one time, step by step and in a loop', async ({ page, viewer, view, times }) => {
  // Times of day of the sweeps in both panes, in seconds; no number where a pane says that it loads.
  const sweeps = () =>
    page.locator('.pane-told').evaluateAll((all) =>
      all.map(({ textContent }) => {
        const [, hours, minutes, seconds] = / (\d\d):(\d\d):(\d\d) /.exec(textContent) ?? [];
        return 3600 * Number(hours) + 60 * Number(minutes) + Number(seconds);
      }),
    );
  const apartS = 180; // the cuts of a tilt follow each other sooner, and volumes later
  const expectOneTime = async (what) => {
    const [reflectivity, velocity] = await sweeps();
    expect(Math.abs(reflectivity - velocity), `${what}: seconds between the sweeps`).toBeLessThan(apartS);
    return reflectivity;
  };
  await viewer.open(`${view}&view=2d&time=${times[0]}&pane=VEL`);
  await expect(page.locator('.pane')).toHaveCount(2);
  const seen = new Set([await expectOneTime('at first')]);
  for (const _ of times.slice(1)) {
    await viewer.settled(() => viewer.key('.'));
    seen.add(await expectOneTime('after a step'));
  }
  expect(seen.size, 'each step shows another volume').toBe(times.length);
  await viewer.give('speed', 8);
  await viewer.key(' ');
  const looped = new Set();
  await expect
    .poll(async () => looped.add(await expectOneTime('in a loop')).size, { message: 'volumes of the loop', timeout: 60_000 })
    .toBe(times.length);
  await viewer.key(' ');
});
