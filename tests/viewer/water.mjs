// Compares land and water of the page's ground, pixel by pixel, with `stormcellar frame` (scripts/check-viewer).
//   node water.mjs ADDRESS STATION VOLUME PROGRAM DIRECTORY
import { CheckedPage, check, gridsOf, image, pictureOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, volume, program, directory] = process.argv.slice(2);
// The map of a picture with labels, of 480 x 320 pixels, has so many, from this row on.
const [width, height, firstRow] = [380, 250, 39];
const browser = await Browser.start();
const page = await browser.page(width, height);
const viewer = new CheckedPage(page, address);
const grid = (await gridsOf(address, [station])).find(({ moment }) => moment === 'REF');
const { ny } = await (await fetch(`${address}${grid.path}`)).json();

// Seen from low down, from high up only, not seen, beyond the grid, as render/image/shades.h has them.
const land = [[40, 44, 50], [29, 32, 37], [23, 25, 29], [25, 28, 33]];
const water = [[22, 31, 46], [17, 24, 36], [15, 20, 28], [14, 19, 29]];
const isOneOf = (shades, color) => shades.some((shade) => shade.every((one, c) => Math.abs(one - color[c]) <= 1));
const kindOf = (color) => (isOneOf(land, color) ? 'land' : isOneOf(water, color) ? 'water' : '');

const zoom = ((1.04 * ny) / height).toFixed(4);
await viewer.open(`domain=${station}&moment=REF&volume=0&azimuth=180&tilt=0&field-of-view=0&zoom=${zoom}`);
const ours = image(await viewer.pixels());
const theirs = await pictureOf(page, program, [volume, '--product', 'composite', '--zoom', zoom], 480, 320, directory);
const count = { land: 0, water: 0, off: 0 };
for (let y = 0; y < height; ++y) {
  for (let x = 0; x < width; ++x) {
    const [one, other] = [kindOf(ours.at(x, y)), kindOf(theirs.at(x, y + firstRow))];
    if (one === '' || other === '') continue; // lines, hatch, echo
    ++count[other];
    if (one !== other) ++count.off;
  }
}
check(`of ${count.land} pixels of land and ${count.water} of water ${count.off} are the other one`,
  count.land > 3000 && count.water > 3000 && count.off <= 0.01 * (count.land + count.water));
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
await browser.end();
