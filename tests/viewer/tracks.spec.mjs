// Checks the tracks below the slider of times: times of day, volumes and cuts.
import { expect, test as base } from './fixtures.mjs';

const test = base.extend({
  viewport: { width: 1440, height: 900 },
  view: ({ server }, use) => use(`domain=${server.station}&moment=REF&tilt=0&zoom=0.4&field-of-view=0`),
  // Times of the volumes, on a timeline that has all of them.
  times: async ({ viewer, view, server }, use) => {
    const times = async () => (await server.grids()).filter(({ moment }) => moment === 'REF').map(({ time }) => time);
    await expect.poll(async () => (await times()).length, 'volumes').toBe(server.volumes.length);
    await viewer.open(view);
    const all = await times();
    await expect.poll(() => viewer.page.evaluate(() => Number(document.getElementById('times').max) + 1)).toBe(all.length);
    await use(all);
  },
});
const clockOf = (time) => time.slice(11, 16);
const labels = (viewer) => viewer.byId('time-labels').locator('span');
const boxes = (viewer) => viewer.byId('volume-track').locator('span');
const cuts = (viewer) => viewer.byId('cut-track').locator('button');

test('the slider has times, and volumes with their scan patterns', async ({ viewer, server, times }) => {
  await expect(labels(viewer)).toHaveText(times.map(clockOf));
  await expect(viewer.byId('clock')).toHaveText('UTC');
  const { volumes } = await server.json(`stations/${server.station}/volumes`);
  await expect(boxes(viewer)).toHaveCount(times.length);
  for (const [i, { vcp, sweeps }] of volumes.entries()) {
    await expect(boxes(viewer).nth(i)).toHaveText(`VCP ${vcp}`);
    await expect(boxes(viewer).nth(i)).toHaveAttribute('title', new RegExp(`^Volume of ${times[i].slice(11, 19)} UTC\n.*${vcp}\n${sweeps} cuts`));
  }
  await expect(boxes(viewer).last(), 'the shown volume has a frame').toHaveClass(/shown/);
  // A label and a box are where the thumb of the slider is.
  await viewer.settled(() => boxes(viewer).nth(1).click());
  expect((await viewer.data('drawn')).endsWith(times[1]), await viewer.data('drawn')).toBe(true);
  await expect(boxes(viewer).nth(1)).toHaveClass(/shown/);
  const slider = await viewer.byId('times').boundingBox();
  const thumb = slider.x + 8 + (slider.width - 16) / (times.length - 1);
  for (const one of [labels(viewer).nth(1), boxes(viewer).nth(1)]) {
    const { x, width } = await one.boundingBox();
    expect(Math.abs(x + width / 2 - thumb)).toBeLessThan(2);
  }
  await viewer.keep('tracks');
});

test('the cuts of the shown volume are boxes, and a press shows a cut', async ({ viewer, server, times }) => {
  const { sweeps } = await server.json(`stations/${server.station}/volumes/${times.at(-1)}/sweeps`);
  await expect(cuts(viewer)).toHaveText(sweeps.map(({ elevation_deg: degrees }) => `${degrees.toFixed(1)}°`));
  const [from, to] = [sweeps[1].start, sweeps[1].end].map((time) => time.slice(11, 19));
  const told = `${sweeps[1].elevation_deg.toFixed(1)}°, cut 2 of ${sweeps.length}\n${from} – ${to} UTC\n`;
  const title = await cuts(viewer).nth(1).getAttribute('title');
  expect(title.startsWith(told), title).toBe(true);
  expect(title).toMatch(/VEL/);
  const pressed = viewer.byId('cut-track').locator('[aria-pressed="true"]');
  await expect(pressed, 'a volume in 3D shows no single cut').toHaveCount(0);
  // Two cuts in succession that have reflectivity, above the first tilt.
  const has = (one) => one?.elevation_deg > 2 && one.moments.some(({ moment }) => moment === 'REF');
  const high = sweeps.findIndex((one, i) => has(one) && has(sweeps[i + 1]));
  await viewer.settled(() => cuts(viewer).nth(high).click());
  expect(await viewer.told('view'), 'a press goes to 2D').toBe('2d');
  await expect(viewer.byId('layers-told')).toContainText(`${sweeps[high].elevation_deg.toFixed(1)}° ${sweeps[high].start.slice(11, 19)}`);
  await expect(pressed).toHaveText(`${sweeps[high].elevation_deg.toFixed(1)}°`);
  // Arrows go from box to box, and Enter shows one.
  await cuts(viewer).nth(high).focus();
  await viewer.key('ArrowRight');
  await expect(cuts(viewer).nth(high + 1)).toBeFocused();
  await viewer.settled(() => viewer.key('Enter'));
  await expect(pressed).toHaveText(`${sweeps[high + 1].elevation_deg.toFixed(1)}°`);
  // The frame follows keys, and a step shows the cuts of the volume before.
  await viewer.settled(() => viewer.press('tilt-lower'));
  await expect(pressed).toHaveText(`${sweeps[high].elevation_deg.toFixed(1)}°`);
  await viewer.settled(() => viewer.press('earlier'));
  await expect(cuts(viewer).first()).toHaveAttribute('title', new RegExp(`\n${times.at(-2).slice(11, 15)}`));
  await viewer.keep('tracks-flat');
});

test('a cut without the shown moment cannot be pressed', async ({ viewer, server, times }) => {
  const { sweeps } = await server.json(`stations/${server.station}/volumes/${times.at(-1)}/sweeps`);
  await viewer.settled(() => viewer.press('moment-VEL'));
  const lacking = sweeps.findIndex((one) => !one.moments.some(({ moment }) => moment === 'VEL'));
  expect(lacking, 'a cut without velocity').toBeGreaterThanOrEqual(0);
  await expect(cuts(viewer).nth(lacking)).toHaveAttribute('aria-disabled', 'true');
  await expect(cuts(viewer).nth(lacking)).toHaveAttribute('title', /lacks the shown moment/);
});

test('interpolated frames look different from volumes', async ({ viewer, times }) => {
  await viewer.give('between', 60);
  await expect.poll(() => boxes(viewer).count()).toBeGreaterThan(3 * times.length);
  const between = viewer.byId('volume-track').locator('.between');
  expect(await between.count()).toBe((await boxes(viewer).count()) - times.length);
  await expect(between.first()).toHaveAttribute('title', /interpolated, not observed/);
  const [made, observed] = await Promise.all(
    [between, viewer.byId('volume-track').locator('span:not(.between)')].map((one) =>
      one.first().evaluate((box) => getComputedStyle(box).backgroundImage),
    ),
  );
  expect(made).toContain('gradient');
  expect(observed).toBe('none');
  await viewer.press('earlier');
  await expect(viewer.byId('title')).toContainText('interpolated, not observed', { timeout: 60_000 });
  await expect(viewer.byId('cut-track')).toContainText('It is no scan');
});

test.describe('in another time zone', () => {
  test.use({ timezoneId: 'America/New_York' });
  test('the times are local if the user wants, also at the next visit', async ({ viewer, view, times }) => {
    const local = (time) => new Date(time).toLocaleTimeString('en-GB', { hour: '2-digit', minute: '2-digit', timeZone: 'America/New_York' });
    await expect(labels(viewer).last(), 'UTC at first').toHaveText(clockOf(times.at(-1)));
    await viewer.byId('clock').click();
    await expect(viewer.byId('clock')).toHaveText(/^E[DS]T$/);
    await expect(labels(viewer)).toHaveText(times.map(local));
    await expect(cuts(viewer).first()).toHaveAttribute('title', new RegExp(`${local(times.at(-1))}.* E[DS]T`));
    await viewer.open(view);
    await expect(labels(viewer).last()).toHaveText(local(times.at(-1)));
  });
});

test('on a phone, the slider has times of which none covers another', async ({ viewer, times }) => {
  await viewer.resize(390, 800);
  await expect(viewer.byId('cut-track')).toBeHidden();
  await expect(labels(viewer).last()).toHaveText(clockOf(times.at(-1)));
  const places = await labels(viewer).evaluateAll((all) => all.map((one) => one.getBoundingClientRect()).map(({ left, right }) => [left, right]));
  expect(places.length).toBeGreaterThan(1);
  for (const [i, [left, right]] of places.entries()) {
    expect(left).toBeGreaterThan(places[i - 1]?.[1] ?? 0);
    expect(right).toBeLessThan(390);
  }
  const slider = await viewer.byId('times').boundingBox();
  expect(slider.width, 'pixels of the slider').toBeGreaterThan(250);
  await viewer.keep('tracks-390');
});
