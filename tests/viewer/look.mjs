// Checks what the page of the viewer draws and does, in Chromium (scripts/check-viewer).
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, Slicer, check, gridsOf, mostDifference, placeOf, shadesOf, viewOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, list, difference, directory, pictures] = process.argv.slice(2);
const stations = list.split(',');
const station = stations[0];
const [width, height] = [400, 266];

const browser = await Browser.start();
const page = await browser.page(width, height);
const viewer = new CheckedPage(page, address);

// ---- The first picture
const began = performance.now();
await viewer.open(`domain=${station}`);
console.log(`first picture after ${Math.round(performance.now() - began)} ms, ${page.bytes} bytes on the wire`);
if (station === 'KLBB') check(`the first picture takes at most 350,000 bytes: ${page.bytes}`, page.bytes <= 350_000);
check('the first picture has many colors', shadesOf(await viewer.pixels()).size > 200);
check('the title names the station', (await page.evaluate('document.title')).includes(station));
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
check('every request went to the server of the page', page.requests.every((url) => url.startsWith(`${address}/`) || url.startsWith('data:') || url.startsWith('blob:')), page.requests.join(' '));

// ---- The volume against the slicer
const grids = await gridsOf(address, stations);
const slicer = new Slicer(address, grids, difference, directory);
const scenes = [
  // number of the station, moment, azimuth, tilt, zoom, field of view, exaggeration, opacity, look at (km)
  [0, 'REF', 180, 55, 1, 0, 5, 1, [0, 0, 5]],
  [0, 'REF', 180, 0, 2, 0, 3, 1, [0, 0, 5]],
  [0, 'REF', 217, 71, 3, 0, 3, 1.5, [20, -10, 4]],
  [0, 'REF', 180, 60, 2, 40, 3, 1, [0, 0, 4]],
  [0, 'REF', 300, 80, 4, 40, 2, 2, [-30, 20, 4]],
  [0, 'REF', 90, 85, 2, 60, 5, 4, [10, 10, 6]],
  [0, 'REF', 45, 30, 6, 40, 4, 1, [40, 40, 3]],
  [0, 'REF', 180, 88, 1.5, 20, 8, 0.3, [0, 0, 5]],
  [0, 'VEL', 180, 55, 1.5, 40, 3, 1, [0, 0, 4]],
  [0, 'VEL', 150, 20, 3, 0, 3, 2, [0, 0, 4]],
  [0, 'SW', 200, 65, 2, 40, 3, 1, [0, 0, 4]],
  [0, 'ZDR', 180, 50, 2, 40, 3, 1, [0, 0, 4]],
  [1, 'REF', 180, 65, 4, 40, 3, 1, [-20, 20, 5]],
  [1, 'REF', 120, 78, 8, 40, 2, 1, [-30, 10, 5]],
];
if (pictures) mkdirSync(pictures, { recursive: true });
let compared = 0;
// The short form draws every third scene, which still shows both projections, two moments and both volumes.
const isShort = Boolean(process.env.STORMCELLAR_SHORT);
for (const [number, [one, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at]] of scenes.entries()) {
  if (isShort && number % 3 !== 0) continue;
  const file = stations[one] && (await slicer.fileOf(stations[one], moment));
  if (!file) continue;
  const scene = { station: stations[one], moment, azimuth, tilt, zoom, field, exaggeration, opacity, at };
  await viewer.show(viewOf(scene));
  const picture = join(pictures || directory, `scene-${number}.ppm`);
  writeFileSync(picture, await viewer.pixels());
  const more = pictures ? [join(pictures, `scene-${number}-slicer.png`)] : [];
  const { p99, mean, most, count } = slicer.compare(file, picture, scene, more);
  check(`scene ${number}, ${scene.station} ${moment}: dE ${p99} (mean ${mean}, most ${most}) over ${count} pixels, ${await viewer.frameMs()} ms`,
    p99 <= mostDifference && count > 300);
  if (compared++ > 0) continue;
  // The comparison can fail: other heights are another picture.
  const other = slicer.compare(file, picture, { ...scene, exaggeration: exaggeration * 1.5 }).p99;
  check(`with other heights the difference is ${other}`, other > mostDifference);
}
check(`${compared} scenes were compared`, compared >= 4);

// ---- What is hidden
// Green stands for 20 to 35 dBZ; stronger echo is yellow and red.
const echoes = `domain=${station}&moment=REF&ground=0&azimuth=180&tilt=0&zoom=1.5&field-of-view=0`;
const colorsOf = (ppm) => [...shadesOf(ppm)].map((rgb) => [rgb >> 16, (rgb >> 8) & 255, rgb & 255]);
const greens = (ppm) => colorsOf(ppm).filter(([r, g]) => g > r + 25).length;
await viewer.show(echoes);
const all = greens(await viewer.pixels());
await viewer.show(`${echoes}&least=36`);
const strong = await viewer.pixels();
check(`above 36 dBZ nothing is green (${greens(strong)} shades, ${all} before)`, all > 20 && greens(strong) === 0 && shadesOf(strong).size > 5);

// ---- What mouse, keys and fingers do, on a page that has room beside its controls
const [x, y] = [250, 300];
await page.resize(796, 532);
// With little to draw, no touch waits until the browser cancels it.
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=50&zoom=1.5&field-of-view=0&least=70`);
await viewer.changes('dragging turns', 'azimuth', () => page.drag([x, y], [40, 0]), (before, after) => after !== before);
await viewer.changes('dragging tilts', 'tilt', () => page.drag([x, y], [0, 30]), (before, after) => after < before);
await viewer.changes('the wheel zooms', 'zoom', () => page.wheel(x, y, -300), (before, after) => after > before);
const shift = 8;
await viewer.settled(() => page.drag([x, y], [30, 10], { modifiers: shift }));
check(`dragging with Shift moves: ${await viewer.told('look-at-km')}`, (await viewer.told('look-at-km')) !== null);
await viewer.changes('an arrow turns', 'azimuth', () => page.key('ArrowRight'), (before, after) => after !== before);
await viewer.changes('+ zooms', 'zoom', () => page.key('+'), (before, after) => after > before);
await viewer.changes('P makes a perspective', 'field-of-view', () => page.key('p'), (before, after) => before === 0 && after > 0);
await viewer.changes('T makes a map without perspective', 'field-of-view', () => page.key('t'), (before, after) => before > 0 && after === 0);
const above = await viewer.told('look-at-km');
await viewer.settled(() => page.drag([x, y], [40, 20]));
check(`a drag moves the map, and north stays up: ${await viewer.told('look-at-km')}`, (await viewer.number('tilt')) === 0 && (await viewer.number('azimuth')) === 180 && (await viewer.told('look-at-km')) !== above);
await viewer.changes('S looks from the south', 'tilt', () => page.key('s'), (_, after) => after > 80);
await viewer.changes('O looks obliquely', 'tilt', () => page.key('o'), (_, after) => after > 30 && after < 80);
await viewer.changes('two fingers zoom', 'zoom', async () => {
  await page.touch('touchStart', [[280, 300], [320, 300]]);
  for (const apart of [10, 20, 30]) await page.touch('touchMove', [[280 - apart, 300], [320 + apart, 300]]);
  await page.touch('touchEnd', []);
}, (before, after) => after > before * 1.5);
await viewer.changes('one finger turns', 'azimuth', async () => {
  await page.touch('touchStart', [[300, 300]]);
  for (const on of [10, 20, 30]) await page.touch('touchMove', [[300 + on, 300]]);
  await page.touch('touchEnd', []);
}, (before, after) => after !== before);
await viewer.changes('the compass turns north up', 'azimuth', () => page.evaluate("document.getElementById('compass').click()"), (before, after) => before !== 180 && after === 180);

// ---- The column under a click, against the server's own probe
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=1.5&field-of-view=0&least=70`);
const place = async (px, py) => {
  await page.evaluate("document.getElementById('reading').textContent = ''");
  await page.drag([px, py], [0, 0]);
  return page.until("document.getElementById('reading').innerText", 5).catch(() => '');
};
let read = 0;
const grid = grids.find((one) => one.domain === station && one.moment === 'REF');
for (const [px, py] of [[150, 300], [200, 250], [250, 220], [300, 200], [330, 270], [360, 300], [420, 330]]) {
  const text = await place(px, py);
  if (!text) {
    console.log(`at ${px}, ${py} is`, await page.evaluate(`document.elementFromPoint(${px}, ${py}).outerHTML.slice(0, 80)`));
    continue;
  }
  const [latitude, longitude] = placeOf(text);
  const { levels: cells } = await (await fetch(`${address}${grid.path}/probe?at=${latitude},${longitude}`)).json();
  const values = cells.filter(({ state }) => state === 'value').map(({ value }) => value);
  const greatest = Math.max(...values);
  if (values.length > 0 && text.includes(String(greatest))) ++read;
  else if (values.length === 0 && /not seen|no echo|range folded/i.test(text)) ++read;
  else console.log(`at ${px}, ${py} the page says ${JSON.stringify(text)}, the server ${greatest}`);
}
// The page writes places to three decimals, which may lie in the next cell.
check(`${read} of 7 readings are those of the server`, read >= 5);
check('nothing failed in between', page.trouble.length === 0, page.trouble.join('\n'));

await browser.end();
