// Compares land, water and roads of the page's ground, pixel by pixel, with `stormcellar frame`.
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

// Returns the ground below a grid, from the page and from `stormcellar frame`.
async function bothGrounds(page, viewer, server, product = ['composite']) {
  const [station, volume] = [server.stations[1], server.volumes[1]]; // at the sea
  const { path } = await server.grid(station);
  const { ny } = await (await fetch(`${server.address}${path}`)).json();
  const zoom = ((1.04 * ny) / height).toFixed(4);
  await viewer.open(`domain=${station}&moment=REF&volume=0&azimuth=180&tilt=0&field-of-view=0&zoom=${zoom}`);
  const ours = image(await viewer.pixels());
  return [ours, await pictureOf(page, server.program, [volume, '--zoom', zoom, '--product', ...product], 480, 320, server.directory)];
}

test('land and water are the same as in stormcellar frame', async ({ page, viewer, server }) => {
  const [ours, theirs] = await bothGrounds(page, viewer, server);
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

test('interstates are where stormcellar frame draws them', async ({ page, viewer, server }) => {
  const [ours, theirs] = await bothGrounds(page, viewer, server, ['cappi', '--height-km', '16']); // above all echo
  const isRoad = ([red, green, blue], least) => red - green >= least / 2 && red - blue >= least;
  const count = { road: 0, off: 0 };
  for (let y = 1; y < height - 1; ++y) {
    for (let x = 1; x < width - 1; ++x) {
      if (!isRoad(ours.at(x, y), 30)) continue;
      ++count.road;
      const near = [-1, 0, 1].flatMap((dy) => [-1, 0, 1].map((dx) => theirs.at(x + dx, y + firstRow + dy)));
      if (!near.some((color) => isRoad(color, 10))) ++count.off;
    }
  }
  report(`of ${count.road} pixels of interstates ${count.off} are not near one`);
  expect(count.road, 'pixels of interstates').toBeGreaterThan(300);
  expect(count.off, 'pixels without an interstate in the still').toBeLessThanOrEqual(0.05 * count.road);
});
