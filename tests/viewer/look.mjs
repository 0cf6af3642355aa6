// What the page of the viewer draws and does, in Chromium (scripts/check-viewer).
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { Browser } from './devtools.mjs';

const [address, list, difference, directory, pictures] = process.argv.slice(2);
const stations = list.split(',');
const station = stations[0];
const [width, height] = [400, 266];
// The largest difference that the page may have from the slicer: CIEDE2000, 99th percentile of the pixels that show echo.
const mostDifference = 2;

let failed = false;
function check(what, holds, more = '') {
  console.log(holds ? what : `FAILED: ${what} ${more}`);
  failed ||= !holds;
}

const browser = await Browser.start();
const page = await browser.page(width, height);
const drawn = 'document.documentElement.dataset.drawn';
const address_of = (view) => `${address}/view/#${view}`;

async function show(view) {
  await page.evaluate(`delete ${drawn}; location.hash = ${JSON.stringify(view)}`);
  await page.until(drawn);
}

// The pixels of the picture as bytes of a portable pixmap.
async function pixels() {
  const text = await page.evaluate(`(() => {
    const picture = document.getElementById('picture');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [picture.width, picture.height];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let text = '';
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return copy.width + ' ' + copy.height + ' ' + btoa(text);
  })()`);
  const [w, h, bytes] = text.split(' ');
  return Buffer.concat([Buffer.from(`P6\n${w} ${h}\n255\n`), Buffer.from(bytes, 'base64')]);
}
const shadesOf = (ppm) => new Set(Array.from({ length: Math.floor((ppm.length - 15) / 3) }, (_, i) => ppm.readUIntBE(15 + 3 * i, 3)));

// ---- The first picture
const began = performance.now();
await page.goto(address_of(''));
await page.until(drawn);
console.log(`first picture after ${Math.round(performance.now() - began)} ms, ${page.bytes} bytes on the wire`);
check('the first picture has many colors', shadesOf(await pixels()).size > 200);
check('the title names the station', (await page.evaluate('document.title')).includes(station));
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
check('every request went to the server of the page', page.requests.every((url) => url.startsWith(`${address}/`) || url.startsWith('data:') || url.startsWith('blob:')), page.requests.join(' '));

// ---- The volume against the slicer
async function gridsOf(domain) {
  for (let tries = 0; tries < 300; ++tries) {
    const { grids } = await (await fetch(`${address}/api/v1/grids?domain=${domain}&limit=10000`)).json();
    if (grids.some(({ moment }) => moment === 'REF')) return grids;
    await new Promise((done) => setTimeout(done, 100));
  }
  throw new Error(`there is no grid of ${domain}`);
}
const grids = (await Promise.all(stations.map(gridsOf))).flat();
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
const files = new Map();
async function gridFile(domain, moment) {
  const grid = grids.find((one) => one.domain === domain && one.moment === moment);
  if (!grid) return null;
  if (!files.has(grid.path)) {
    const file = join(directory, `${domain}-${moment}.scg`);
    const answer = await fetch(`${address}${grid.path}/file`);
    writeFileSync(file, Buffer.from(await answer.arrayBuffer()));
    files.set(grid.path, file);
  }
  return files.get(grid.path);
}
if (pictures) mkdirSync(pictures, { recursive: true });
let compared = 0;
for (const [number, [one, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at]] of scenes.entries()) {
  const file = stations[one] && (await gridFile(stations[one], moment));
  if (!file) continue;
  await show(`domain=${stations[one]}&moment=${moment}&ground=0&azimuth=${azimuth}&tilt=${tilt}&zoom=${zoom}&field-of-view=${field}` +
    `&exaggeration=${exaggeration}&opacity=${opacity}&look-at-km=${at.join(',')}`);
  const picture = join(pictures || directory, `scene-${number}.ppm`);
  writeFileSync(picture, await pixels());
  const more = pictures ? [join(pictures, `scene-${number}-slicer.png`)] : [];
  const words = [azimuth, tilt, zoom, field, exaggeration, opacity, ...at.map((km) => km * 1000)].map(String);
  const [p99, mean, most, count] = execFileSync(difference, [file, picture, ...words, ...more], { encoding: 'utf8' }).trim().split(' ').map(Number);
  const ms = await page.evaluate('document.documentElement.dataset.frameMs');
  check(`scene ${number}, ${stations[one]} ${moment}: dE ${p99} (mean ${mean}, most ${most}) over ${count} pixels, ${ms} ms`, p99 <= mostDifference && count > 300);
  if (compared++ > 0) continue;
  // The comparison can fail: other heights are another picture.
  words[4] = String(exaggeration * 1.5);
  const other = Number(execFileSync(difference, [file, picture, ...words], { encoding: 'utf8' }).split(' ')[0]);
  check(`with other heights the difference is ${other}`, other > mostDifference);
}
check(`${compared} scenes were compared`, compared >= 4);

// ---- What is hidden
// Green stands for 20 to 35 dBZ; stronger echo is yellow and red.
const echoes = `domain=${station}&moment=REF&ground=0&azimuth=180&tilt=0&zoom=1.5&field-of-view=0`;
const colorsOf = (ppm) => [...shadesOf(ppm)].map((rgb) => [rgb >> 16, (rgb >> 8) & 255, rgb & 255]);
const greens = (ppm) => colorsOf(ppm).filter(([r, g]) => g > r + 25).length;
await show(echoes);
const all = greens(await pixels());
await show(`${echoes}&least=36`);
const strong = await pixels();
check(`above 36 dBZ nothing is green (${greens(strong)} shades, ${all} before)`, all > 20 && greens(strong) === 0 && shadesOf(strong).size > 5);

// ---- What mouse, keys and fingers do, on a page that has room beside its controls
const told = (name) => page.evaluate(`new URLSearchParams(location.hash.slice(1)).get(${JSON.stringify(name)})`);
const number = async (name) => Number(await told(name));
// Waits for the fine picture after an act.
async function settled(act) {
  await page.evaluate(`delete ${drawn}`);
  await act();
  await page.until(drawn);
}
async function changes(what, name, act, holds) {
  const before = await number(name);
  await settled(act);
  const after = await number(name);
  check(`${what}: ${name} ${before} to ${after}`, holds(before, after));
}
const [x, y] = [250, 300];
await page.resize(796, 532);
// With little to draw, no touch waits until the browser cancels it.
await show(`domain=${station}&moment=REF&azimuth=180&tilt=50&zoom=1.5&field-of-view=0&least=70`);
await changes('dragging turns', 'azimuth', () => page.drag([x, y], [40, 0]), (before, after) => after !== before);
await changes('dragging tilts', 'tilt', () => page.drag([x, y], [0, 30]), (before, after) => after < before);
await changes('the wheel zooms', 'zoom', () => page.wheel(x, y, -300), (before, after) => after > before);
const shift = 8;
await settled(() => page.drag([x, y], [30, 10], { modifiers: shift }));
check(`dragging with Shift moves: ${await told('look-at-km')}`, (await told('look-at-km')) !== null);
await changes('an arrow turns', 'azimuth', () => page.key('ArrowRight'), (before, after) => after !== before);
await changes('+ zooms', 'zoom', () => page.key('+'), (before, after) => after > before);
await changes('T looks from the top', 'tilt', () => page.key('t'), (_, after) => after === 0);
await changes('S looks from the south', 'tilt', () => page.key('s'), (_, after) => after > 80);
await changes('P makes a perspective', 'field-of-view', () => page.key('p'), (before, after) => before === 0 && after > 0);
await changes('two fingers zoom', 'zoom', async () => {
  await page.touch('touchStart', [[280, 300], [320, 300]]);
  for (const apart of [10, 20, 30]) await page.touch('touchMove', [[280 - apart, 300], [320 + apart, 300]]);
  await page.touch('touchEnd', []);
}, (before, after) => after > before * 1.5);
await changes('one finger turns', 'azimuth', async () => {
  await page.touch('touchStart', [[300, 300]]);
  for (const on of [10, 20, 30]) await page.touch('touchMove', [[300 + on, 300]]);
  await page.touch('touchEnd', []);
}, (before, after) => after !== before);

// ---- The column under a click, against the server's own probe
await show(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=1.5&field-of-view=0&least=70`);
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
  const [latitude, longitude] = text.match(/-?\d+\.\d+/g).map(Number);
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
process.exit(failed ? 1 : 0);
