// Checks sweeps of raw volumes: which cut the page shows, the list of cuts, what the page says of layers, and loops.
import { expect, report, test as base } from './fixtures.mjs';
import { image } from './pixels.mjs';

const isOf = (row, moment) => row.moments.some((one) => one.moment === moment);
const told = (viewer) => viewer.byId('layers-told');

const test = base.extend({
  viewport: { width: 500, height: 400 },
  // Cuts of the newest volume with reflectivity: all of them, the cut of the lowest elevation that pictures take, and
  // another cut of this elevation, if there is one.
  cuts: async ({ server }, use) => {
    const { volumes } = await server.json(`stations/${server.station}/volumes`);
    const { sweeps } = await server.json(`stations/${server.station}/volumes/${volumes.at(-1).time}/sweeps`);
    const having = sweeps.filter((row) => isOf(row, 'REF'));
    const lowest = Math.min(...having.map(({ elevation_deg }) => elevation_deg));
    const atLowest = having.filter(({ elevation_deg }) => elevation_deg <= lowest + 0.2);
    const chosen = atLowest.find(({ moments }) => moments.some((one) => one.moment === 'REF' && one.chosen));
    await use({ having, chosen, other: atLowest.find((row) => row !== chosen) });
  },
  above: ({ server }, use) =>
    use(`domain=${server.station}&moment=REF&volume=0&azimuth=180&tilt=0&field-of-view=0&quality=${encodeURIComponent('64 slices')}`),
});

// 2026-11-28: the page showed the Doppler half, and offered no other cut.
test('the page shows the cut that pictures take, and any other cut on request', async ({ page, viewer, cuts: { having, chosen, other }, above }) => {
  await viewer.open(`${above}&elevation=0.5`);
  await expect(told(viewer)).toContainText(chosen.start.slice(11, 19));
  await expect(page.locator('#sweep-elevation option'), 'each cut is in the list').toHaveCount(having.length);
  if (!other) return;
  const kind = isOf(other, 'VEL') === isOf(chosen, 'VEL') ? '' : isOf(other, 'VEL') ? ' Doppler' : ' long range';
  await viewer.settled(() => viewer.give('sweep-elevation', other.sweep));
  await expect(told(viewer)).toContainText(`${other.start.slice(11, 19)}${kind}`);
  expect(await viewer.number('sweep')).toBe(other.sweep);
  await viewer.catchCopies();
  expect(await viewer.copiedBy('command')).toContain(`--product ppi --sweep ${other.sweep} `);
});

test('the page leaves out echo that is probably no weather, and says how much', async ({ viewer, above }) => {
  await viewer.open(`${above}&elevation=0.5`);
  await expect(told(viewer)).not.toContainText('weather only');
  await viewer.settled(() => viewer.press('sweep-weather'));
  await expect(told(viewer)).toContainText(/, weather only: \d+ % of the echo left out/);
  await viewer.keep('weather-only');
  await viewer.catchCopies();
  expect(await viewer.copiedBy('command')).toContain('--product ppi --sweep 0 --quality 0.5 ');
  await viewer.open(`${above}&elevation=0.5&weather=1`);
  await expect(told(viewer)).toContainText('weather only');
});

test.describe('the page says what it does not draw', () => {
  test.use({ provoked: /404|500|ERR_CONNECTION_RESET/ });

  // Speeds up time, so that the ten seconds until the page asks again take half a second.
  const hurry = ({ page }) =>
    page.evaluate(() => {
      const [clock, timer] = [performance.now.bind(performance), setTimeout];
      performance.now = () => 20 * clock();
      window.setTimeout = (act, ms, ...more) => timer(act, ms > 10_000 && ms < 11_000 ? ms / 20 : ms, ...more);
    });

  // 2026-11-28: the page named a surface that it did not draw.
  test('a surface of a missing moment', async ({ viewer, above }) => {
    await viewer.open(`${above}&surface=20&surface-moment=ZZZ`);
    await expect(told(viewer)).toContainText('not shown: no ZZZ');
  });

  // 2026-11-28: the page said that there is no sweep.
  test('a sweep that fails to load', async ({ page, viewer, server: { station }, above }) => {
    await viewer.open(above);
    await hurry(viewer);
    await page.route(/\/sweeps\//, (route) => route.abort('connectionreset'));
    await viewer.show(`${above}&elevation=9`);
    await expect(told(viewer)).not.toContainText('loading');
    await expect(told(viewer)).toContainText('could not be loaded');
    await page.unroute(/\/sweeps\//);
    await expect(told(viewer), 'the sweep is asked for again').toContainText(`sweep of ${station}: `);
  });

  // 2026-11-28: after one failed answer, the page said forever that there is no such moment.
  test('a surface that fails to load', async ({ page, viewer, above }) => {
    await viewer.open(above);
    await hurry(viewer);
    await page.route(/\/VEL\/.*\/packed/, (route) => route.fulfill({ status: 500, json: { error: 'trouble' } }));
    await viewer.show(`${above}&surface=20&surface-moment=VEL`);
    await expect(told(viewer)).toContainText('VEL could not be loaded');
    await page.unroute(/\/VEL\/.*\/packed/);
    await expect(told(viewer), 'the surface is asked for again').toHaveText(/m\/s$/);
  });
});

// 2026-11-28: echo hidden by a box, by layers that are off or by a veil that is off looked like clear air.
test('the page says which echo is hidden', async ({ viewer, server: { station } }) => {
  await viewer.open(`domain=${station}&moment=REF`);
  const wordsOfViews = {
    'moment=REF&crop-km=-50,50,-50,50,14,16': 'echo outside the box from 14.0 km to 16.0 km is hidden',
    'moment=REF&volume=0': 'echo is hidden',
    'moment=REF&opacity=0.01': 'opacity × 0.01',
    'moment=VEL&folded=0': 'range-folded air is hidden',
    'moment=REF&folded=0': '',
    'moment=VEL': '',
  };
  for (const [view, words] of Object.entries(wordsOfViews)) {
    await viewer.show(`domain=${station}&${view}`);
    expect(await viewer.text('layers-told'), view).toBe(words);
  }
});

// 2026-11-28: the sweep was cut off at the grid's box.
test('the whole sweep is drawn, also beyond the grid', async ({ viewer, cuts: { chosen }, above }, info) => {
  const reaches = Math.max(...chosen.moments.filter(({ moment }) => moment === 'REF').map(({ gates, gate_spacing_m }) => gates * gate_spacing_m));
  info.skip(reaches <= 3e5, `the sweep ends at ${reaches / 1000} km`);
  // At this zoom the grid is a square a third as high as the picture.
  await viewer.open(`${above}&elevation=0.5&zoom=0.333&ground=0`);
  const picture = image(await viewer.pixels());
  let [within, beyond] = [0, 0];
  for (let y = 0; y < picture.height; ++y) {
    for (let x = 0; x < picture.width; ++x) {
      const color = picture.at(x, y);
      if (Math.max(...color) - Math.min(...color) <= 50) continue;
      const away = Math.max(Math.abs(x - picture.width / 2), Math.abs(y - picture.height / 2)) - picture.height / 6;
      if (away < -3) ++within;
      if (away > 3) ++beyond;
    }
  }
  report(`of a sweep that reaches ${reaches / 1000} km ${within} pixels are drawn within the grid, ${beyond} beyond`);
  expect(within, 'pixels within the grid').toBeGreaterThan(50);
  expect(beyond, 'pixels beyond the grid').toBeGreaterThan(0);
});

test.describe('a loop', { tag: '@sequence' }, () => {
  // Counts the pixels that are not black in a small copy of the picture.
  const look = ({ page }) =>
    page.evaluate(() => {
      const pen = Object.assign(document.createElement('canvas'), { width: 100, height: 80 }).getContext('2d', { willReadFrequently: true });
      window.shown = () => {
        pen.drawImage(document.getElementById('picture'), 0, 0, 100, 80);
        const { data } = pen.getImageData(0, 0, 100, 80);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) if (Math.max(data[i], data[i + 1], data[i + 2]) > 60) ++count;
        return count;
      };
    });
  // Plays all times twice. Checks that the page never shows an empty map, and returns what the page says of its layers
  // at each time.
  async function play(viewer, view) {
    const { page } = viewer;
    await viewer.open(view);
    await look(viewer);
    await viewer.until(() => Number(document.getElementById('times').max) >= 4);
    const full = await page.evaluate(() => window.shown());
    await page.evaluate(() => {
      window.seen = [];
      window.isWatching = true;
      const look = () => {
        const [time] = document.getElementById('title').textContent.match(/\d\d:\d\d:\d\d/) ?? [];
        window.seen.push([time, document.getElementById('layers-told').textContent, window.shown()]);
        if (window.isWatching) requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await viewer.press('play');
    const allTimes = (from) => new Set(window.seen.slice(from).map(([time]) => time)).size >= 5;
    await viewer.until(allTimes, 0, 60_000);
    await viewer.until(allTimes, await page.evaluate(() => window.seen.length), 60_000);
    await viewer.press('play');
    const seen = await page.evaluate(() => {
      window.isWatching = false;
      return window.seen;
    });
    const least = Math.min(...seen.map(([, , count]) => count));
    report(`${seen.length} looks at a loop: at least ${least} of ${full} pixels`);
    expect(full, 'pixels of a picture').toBeGreaterThan(20);
    expect(least, 'pixels of the emptiest picture').toBeGreaterThanOrEqual(0.1 * full);
    return new Map(seen.map(([time, line]) => [time, line]));
  }

  // 2026-11-28: at 4 frames a second, all 24 pictures were empty.
  test('of sweeps is never empty, and names a sweep of the shown volume', async ({ viewer, above }) => {
    const lines = await play(viewer, `${above}&ground=0&elevation=0.5`);
    const secondsOf = (time) => Date.parse(`2000-01-01T${time}Z`) / 1000;
    expect(lines.size, 'times').toBeGreaterThanOrEqual(5);
    expect(new Set(lines.values()).size, 'names').toBe(lines.size);
    for (const [time, line] of lines) {
      const apart = Math.abs(secondsOf(line.match(/\d\d:\d\d:\d\d/)?.[0]) - secondsOf(time));
      expect(apart, `seconds between ${line} and ${time}`).toBeLessThan(400);
    }
  });

  // The last loops have little memory, so that the grid is in parts and its layers are made of windows (2026-11-28:
  // half of the pictures were empty). There is room for one sweep besides the shown sweep.
  for (const [memory, layer] of [
    ['', 'surface=8&surface-moment=VEL'],
    ['', 'height-km=3'],
    ['memory=4&', 'height-km=3'],
    ['memory=4&', 'maximum=1'],
    ['memory=4&', 'elevation=0.5'],
  ]) {
    test(`of ${memory}${layer} is never empty`, async ({ viewer, above }) => {
      await play(viewer, `${memory}${above}&ground=0&${layer}`);
    });
  }

  // 2026-11-28: the pointer read a gate of the previous sweep.
  test('lets a resting pointer read gates of the drawn sweep', async ({ viewer, above }) => {
    await viewer.open(`${above}&ground=0&elevation=0.5&zoom=4`);
    await viewer.until(() => Number(document.getElementById('times').max) >= 4);
    await viewer.hover([260, 240]);
    for (let i = 0; i < 4; ++i) {
      await expect(viewer.byId('hover')).toContainText('seen at');
      await viewer.settled(() => viewer.press('earlier'));
      const [line, reading] = [await viewer.text('layers-told'), await viewer.text('hover')];
      const secondsOf = (text, before) => {
        const [time] = text.slice(text.indexOf(before) + before.length).match(/\d\d:\d\d:\d\d/) ?? [];
        return Date.parse(`2000-01-01T${time}Z`) / 1000;
      };
      const afterStart = secondsOf(reading, 'seen at ') - secondsOf(line, '° ');
      expect(afterStart, `${line}; the pointer reads ${reading}`).toBeGreaterThanOrEqual(0);
      expect(afterStart, `${line}; the pointer reads ${reading}`).toBeLessThan(60);
    }
  });
});
