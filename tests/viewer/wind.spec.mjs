// Checks the pictures of the wind on the storm of Moore on 3 May 1999: beam glyphs on a sweep of velocities, and
// columns of rotation in the volume of reflectivity.
import { expect, report, test as base } from './fixtures.mjs';
import { image } from './pixels.mjs';

const [width, height] = [600, 450];
const test = base.extend({
  viewport: { width, height },
  above: ({ server }, use) =>
    use(`domain=${server.station}&azimuth=180&tilt=0&field-of-view=0&exaggeration=1&look-at-km=-37.4,-9.2,0&zoom=8`),
});

// Returns where two pictures differ, as pixels from the middle.
function changesBetween(one, other) {
  const changes = [];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      if (one.at(x, y).some((channel, c) => Math.abs(channel - other.at(x, y)[c]) > 12))
        changes.push([x - width / 2, y - height / 2]);
  return changes;
}

test('one click puts beam glyphs on a sweep of velocities', async ({ viewer, above }) => {
  await viewer.open(`${above}&moment=VEL&volume=0`);
  expect(viewer.asked('/view/layers.js'), 'the program is not loaded before the click').toBe(0);
  await viewer.settled(() => viewer.press('layer-glyphs'));
  expect(viewer.asked('/view/layers.js')).toBe(1);
  const glyphs = Number(await viewer.data('glyphs'));
  report(`${glyphs} glyphs`);
  expect(glyphs).toBeGreaterThan(60);
  expect([await viewer.told('glyphs'), await viewer.told('elevation')]).toEqual(['1', '0.5']);
  await viewer.keep('wind-glyphs');
  await viewer.catchCopies();
  expect(await viewer.copiedBy('command')).toMatch(/--moment VEL .*--product ppi .*--glyphs/);
  // A link brings the glyphs back, and they turn with the picture.
  await viewer.open(`domain=KTLX&moment=VEL&volume=0&elevation=0.5&glyphs=1&azimuth=200&tilt=65&zoom=3`);
  expect(Number(await viewer.data('glyphs'))).toBeGreaterThan(60);
  await viewer.keep('wind-glyphs-aslant');
  // Reflectivity has no beam glyphs.
  await viewer.settled(() => viewer.press('moment-REF'));
  expect(await viewer.data('glyphs')).toBe('0');
});

test('one click shows the rotation of the storm as columns', async ({ viewer, server, above }) => {
  await expect.poll(async () => Boolean(await server.grid(server.station, 'AZSH')), { timeout: 120_000 }).toBe(true);
  await viewer.open(`${above}&moment=REF`);
  const before = image(await viewer.pixels(width, height));
  await viewer.settled(() => viewer.press('layer-rotation'));
  expect(await viewer.told('rotation')).toBe('1');
  await expect(viewer.byId('layers-told')).toHaveText('rotation: azimuthal shear of 0.008/s or more, 2 km deep or more');
  await expect(viewer.byId('legend')).toContainText('anticyclonic');
  const changes = changesBetween(before, image(await viewer.pixels(width, height)));
  const mean = [0, 1].map((i) => changes.reduce((sum, one) => sum + one[i], 0) / changes.length);
  report(`${changes.length} pixels show rotation, on average ${mean.map(Math.round)} pixels from the tornado`);
  expect(changes.length).toBeGreaterThan(200);
  expect(Math.hypot(...mean), 'the columns are at the tornado').toBeLessThan(90);
  await viewer.keep('wind-rotation');
  await viewer.catchCopies();
  expect(await viewer.copiedBy('command')).toContain(' --rotation ');
  await viewer.settled(() => viewer.press('layer-rotation'));
  expect(changesBetween(before, image(await viewer.pixels(width, height)))).toEqual([]);
});
