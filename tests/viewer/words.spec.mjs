// Checks the words of the page: plain names, tooltips, the table of keys, and keys after a click.
import { expect, test } from './fixtures.mjs';

test.use({ viewport: { width: 1000, height: 700 } });

const near = (station) => `domain=${station}&moment=REF&zoom=0.3&least=30`;

// Private language of the renderer, and what the page says instead.
const words = [
  ['settings', /Exactness|as time allows|Heights times|Hide echo|In between|Grids take|Raw volume\b|Grid \(netCDF\)|smooth-reflectivity/],
  ['settings', /Quality/],
  ['settings', /automatic/],
  ['settings', /finest: 512 slices \(color error [\d.]+\)/],
  ['settings', /fast: 64 slices \(/],
  ['settings', /Vertical exaggeration/],
  ['settings', /Smooth motion/],
  ['settings', /Hide below/],
  ['settings', /Color-blind safe/],
  ['settings', /Memory: \d+ of 256 MiB/],
  ['settings', /Drawn in \d+ ms: .* slices.*, color error [\d.]+/],
  ['settings', /Download Level II/],
  ['settings', /Download netCDF/],
  ['settings', /Copy command line/],
  ['layers', /Sweep in its place|Plane at a height|Surface of a value|on the ground$|Encloses|Veil|Haze/],
  ['layers', /Radar tilt \(raw gates\)/],
  ['layers', /Constant height \(CAPPI\)/],
  ['layers', /Composite \(highest value above each place\)/],
  ['layers', /Isosurface/],
  ['layers', /Clip box/],
  ['layers', /Show unseen air/],
  ['layers', /Show range-folded air/],
  ['legend', /seen only/],
  ['legend', /lowest beam above 3 km/],
  ['state', /dE|slices|ms/],
];

test('panels use plain words', async ({ viewer, server: { station } }) => {
  await viewer.open(near(station));
  const isRefused = (pattern) => /Exactness|Sweep in|seen only|dE/.test(pattern.source);
  for (const [id, pattern] of words) {
    const text = await viewer.text(id);
    if (isRefused(pattern)) expect(text, id).not.toMatch(pattern);
    else expect(text, id).toMatch(pattern);
  }
  await expect(viewer.byId('least-value')).toHaveText('30 dBZ');
  await viewer.show(`domain=${station}&moment=REF&zoom=0.3`);
  await expect(viewer.byId('least-value')).toHaveText('off');
  await viewer.settled(() => viewer.give('exaggeration', 3, 'input'));
  await expect(viewer.byId('exaggeration-value')).toHaveText(/3$/);
});

test('the reading of a click names the nearest city and the radar', async ({ viewer, server: { station } }) => {
  await viewer.open(near(station));
  await viewer.click([500, 330]);
  const reading = viewer.byId('reading');
  await expect(reading).toContainText(/\d+\.\d{3} [NS], \d+\.\d{3} [EW]/);
  await expect(reading).toContainText(/km (N|NE|E|SE|S|SW|W|NW) of [A-Z]/);
  await expect(reading).toContainText(new RegExp(`km at \\d+° from ${station}`));
});

test('the tooltip of a moment names it in full, and each other button has a tooltip, too', async ({ viewer, server: { station } }) => {
  await viewer.open(near(station));
  await expect(viewer.byId('moment-REF')).toHaveAttribute('title', 'Reflectivity');
  await expect(viewer.byId('moment-VEL')).toHaveAttribute('title', /^Radial velocity: negative toward the radar/);
  const without = await viewer.page.evaluate(() => {
    const all = [...document.querySelectorAll('#head button, #foot button, #settings button, #compass')];
    return all.filter((one) => !one.hidden && !one.title && !one.getAttribute('aria-label')).map((one) => one.id);
  });
  expect(without, 'buttons without a tooltip').toEqual([]);
});

test('keys work after a click on a button, but do not act while the user types', async ({ viewer, server: { station } }) => {
  await viewer.open(near(station));
  await viewer.byId('layers-open').click();
  await expect(viewer.byId('layers-open')).toBeFocused();
  await viewer.changes('T after a click on Layers', 'tilt', () => viewer.key('t'), (_, after) => after === 0);
  await viewer.settled(() => viewer.byId('layer-maximum').click());
  await viewer.changes('O after a click on a checkbox', 'tilt', () => viewer.key('o'), (_, after) => after > 30);
  await viewer.settled(() => viewer.key('v'));
  expect(await viewer.told('volume'), 'V hides the volume').toBe('0');
  await viewer.byId('layers-open').focus();
  await viewer.key('Escape');
  await expect(viewer.byId('layers'), 'Escape closes the panel').toBeHidden();
  // Space presses the focused button, and does not also play.
  await viewer.key(' ');
  await expect(viewer.byId('layers')).toBeVisible();
  await expect(viewer.byId('play')).toHaveText('Play');
  // A list takes letters for itself.
  const before = await viewer.told('tilt');
  await viewer.byId('open').click();
  await viewer.byId('colors').focus();
  await viewer.key('t');
  expect(await viewer.told('tilt')).toBe(before);
});

for (const [width, height] of [[390, 800], [1000, 700]])
  test(`? shows a table of keys at ${width} x ${height}`, async ({ viewer, server: { station } }) => {
    await viewer.resize(width, height);
    await viewer.open(near(station));
    await viewer.key('?');
    const reading = viewer.byId('reading');
    await expect(reading.locator('tr').filter({ hasText: 'north up' }).locator('kbd')).toHaveText('T');
    expect(await reading.locator('kbd').count()).toBeGreaterThan(30);
    const box = await reading.boundingBox();
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(width);
    expect(box.y).toBeGreaterThanOrEqual(0);
    await viewer.keep(`keys-${width}`);
    await viewer.key('Escape');
    await expect(reading).toBeHidden();
  });

test('the map of radars uses plain words', async ({ viewer, server: { station } }) => {
  await viewer.open(near(station));
  await viewer.press('to-map');
  await expect(viewer.byId('start-help')).toHaveText('Click a radar, or Select area to merge several. Drag to move.');
  await expect(viewer.byId('start-box')).toHaveText('Select area');
  await expect(viewer.byId('start-all')).toHaveText('Fit all');
  // The volumes are years old: their dates are told, not "10 years ago".
  await expect(viewer.byId('found')).toContainText(/\d{4}-\d\d-\d\d \d\d:\d\d UTC/);
  await viewer.byId('search').fill('Xyzzyville');
  await expect(viewer.byId('found')).toHaveText('No radar or city of that name.');
  await viewer.byId('search').fill('pacg');
  await expect(viewer.byId('found')).toHaveText('PACG (Biorka Island) is a radar, but has no data here.');
});
