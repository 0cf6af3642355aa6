// Compares land and water of the page's ground, pixel by pixel, with `stormcellar frame`.
import { expect, report, test } from './fixtures.mjs';
import { image } from './pixels.mjs';
import { pictureOf } from './slicer.mjs';

// A picture of 480 x 320 pixels with labels has a map of this size, which begins at this row.
const [width, height, firstRow] = [380, 250, 39];
test.use({ viewport: { width, height } });

// Shades as in render/image/shades.h: seen from low down, seen from high up only, not seen, beyond the grid.
const land = [[40, 44, 50], [29, 32, 37], [23, 25, 29], [25, 28, 33]];
const water = [[22, 31, 46], [17, 24, 36], [15, 20, 28], [14, 19, 29]];
const isOneOf = (shades, color) => shades.some((shade) => shade.every((one, c) => Math.abs(one - color[c]) <= 1));
const kindOf = (color) => (isOneOf(land, color) ? 'land' : isOneOf(water, color) ? 'water' : '');

test('land and water are the same as in stormcellar frame', async ({ page, viewer, server }) => {
  const [station, volume] = [server.stations[1], server.volumes[1]]; // at the sea
  const { path } = await server.grid(station);
  const { ny } = await (await fetch(`${server.address}${path}`)).json();
  const zoom = ((1.04 * ny) / height).toFixed(4);
  await viewer.open(`domain=${station}&moment=REF&volume=0&azimuth=180&tilt=0&field-of-view=0&zoom=${zoom}`);
  const ours = image(await viewer.pixels());
  const theirs = await pictureOf(page, server.program, [volume, '--product', 'composite', '--zoom', zoom], 480, 320, server.directory);
  const count = { land: 0, water: 0, off: 0 };
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const [one, other] = [kindOf(ours.at(x, y)), kindOf(theirs.at(x, y + firstRow))];
      if (one === '' || other === '') continue; // a line, hatch or echo
      ++count[other];
      if (one !== other) ++count.off;
    }
  }
  report(`of ${count.land} pixels of land and ${count.water} of water ${count.off} are the other one`);
  expect(count.land, 'pixels of land').toBeGreaterThan(3000);
  expect(count.water, 'pixels of water').toBeGreaterThan(3000);
  expect(count.off, 'pixels of land for water, or of water for land').toBeLessThanOrEqual(0.01 * (count.land + count.water));
});
