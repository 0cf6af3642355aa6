// Checks how a user gets in and around: the map of all stations by mouse, keys, fingers, words (scripts/check-viewer).
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, check, gridsOf, placeOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, list, pictures] = process.argv.slice(2);
const stations = list.split(',');
await gridsOf(address, stations);

const browser = await Browser.start();
const page = await browser.page(700, 440);
const viewer = new CheckedPage(page, address);
if (pictures) mkdirSync(pictures, { recursive: true });
const keep = async (name) => pictures && writeFileSync(join(pictures, `${name}.png`), await page.screenshot());
const texts = (id) => page.evaluate(`document.getElementById('${id}').innerText`);
const isOnMap = () => page.evaluate("!document.getElementById('start').hidden");
// Where the stations are on the map, once it is drawn.
async function places() {
  await page.until("!document.getElementById('start').hidden && document.documentElement.dataset.map");
  const text = await page.evaluate('document.documentElement.dataset.map');
  return new Map(text.split(',').map((one) => one.split(' ')).map(([icao, x, y]) => [icao, [Number(x), Number(y)]]));
}

// ---- With one station alone there is nothing to choose
if (stations.length < 2) {
  await viewer.open();
  check('a lone station is opened at once', !(await isOnMap()));
  await page.evaluate("document.getElementById('to-map').click()");
  check('its map is a button away', (await places()).has(stations[0]));
  await browser.end();
  process.exit();
}

// ---- By mouse
await page.goto(`${address}/view/`);
const [station, other] = stations;
const [x, y] = (await places()).get(station);
const [ox, oy] = (await places()).get(other);
check(`the map has ${list} at different places`, Math.hypot(x - ox, y - oy) > 20);
await page.until(`document.getElementById('found').innerText.includes('${station}')`);
await page.mouse('mouseMoved', x + 3, y + 2);
const card = await page.until("document.getElementById('start-card').innerText");
check(`the pointer is told what is under it: ${card}`, card.startsWith(station) && card.includes('REF'));
await keep('map');
await viewer.settled(() => page.drag([x + 3, y + 2], [0, 0]));
check('a click opens a station', !(await isOnMap()) && (await viewer.told('domain')) === station);
await page.evaluate('history.back()');
check('going back leads to the map again', (await places()).size >= stations.length);
const before = (await places()).get(station);
await page.drag([500, 300], [30, 20]);
await page.until(`document.documentElement.dataset.map.includes('${station} ${before[0] + 30} ${before[1] + 20}')`);
await page.wheel(500, 300, -300);
await page.until(`!document.documentElement.dataset.map.includes('${station} ${before[0] + 30} ${before[1] + 20}')`);
check('the map moves and zooms', await isOnMap());

// ---- By words
await page.evaluate("document.getElementById('search').focus()");
for (const letter of other.toLowerCase()) await page.key(letter);
check(`the list finds ${other}`, (await texts('found')).startsWith(other) && !(await texts('found')).includes(station));
await viewer.settled(() => page.key('Enter'));
check('Enter opens what was found', (await viewer.told('domain')) === other);
await page.evaluate("document.getElementById('to-map').click()");
await places();

// ---- By keys
await page.evaluate("document.getElementById('map').focus(); document.getElementById('start-all').click(); document.getElementById('map').focus()");
await page.key('ArrowRight');
await page.until("document.getElementById('start-card').innerText");
const first = (await texts('start-card')).slice(0, 4);
for (const way of ['ArrowLeft', 'ArrowDown', 'ArrowRight', 'ArrowUp']) await page.key(way);
check(`arrows go from ${first} to others`, stations.includes(first));
const chosen = (await texts('start-card')).slice(0, 4);
await viewer.settled(() => page.key('Enter'));
check('Enter opens the station that is chosen', (await viewer.told('domain')) === chosen);

// ---- By fingers
await page.evaluate("document.getElementById('to-map').click()");
await page.evaluate("document.getElementById('start-all').click()");
await new Promise((done) => setTimeout(done, 200));
const touched = (await places()).get(station);
await viewer.settled(async () => {
  await page.touch('touchStart', [touched]);
  await page.touch('touchEnd', []);
});
check('a touch opens a station', (await viewer.told('domain')) === station);

// ---- Tools, from straight above, where a pixel is a column
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=40`);
const { grids } = await (await fetch(`${address}/api/v1/grids?domain=${station}&moment=REF`)).json();
const exaggeration = 5;
const { tables, usual } = await (await fetch(`${address}/api/v1/tables`)).json();
const { extinction } = tables.find(({ name }) => name === usual.REF);
const perKm = (value) => {
  const high = extinction.findIndex((one) => value < one.value);
  if (high < 0) return extinction[extinction.length - 1].per_km;
  const [a, b] = [extinction[high - 1], extinction[high]];
  return a.per_km + ((value - a.value) / (b.value - a.value)) * (b.per_km - a.per_km);
};
let told = 0;
for (const [px, py] of [[300, 200], [270, 190], [330, 220], [350, 240], [400, 180], [250, 230]]) {
  await page.evaluate("document.getElementById('hover').hidden = true");
  await page.mouse('mouseMoved', px, py);
  const hovered = await page.until("!document.getElementById('hover').hidden && document.getElementById('hover').innerText");
  await page.drag([px, py], [0, 0]);
  const reading = await page.until("document.getElementById('reading').innerText");
  await page.key('Escape'); // the reading covers a part of the picture
  const [latitude, longitude] = placeOf(reading);
  const { levels } = await (await fetch(`${address}${grids[0].path}/probe?at=${latitude},${longitude}`)).json();
  // From above: the cell of the column that hides most of what is below it and is hidden least.
  let [seen, most, through] = [null, 0, 1];
  for (let z = levels.length - 1; z >= 0; --z) {
    const { state, value, height_m: at } = levels[z];
    if (state !== 'value' || value < 40) continue;
    const high = ((levels[z + 1]?.height_m ?? 2 * at - levels[z - 1].height_m) - (levels[z - 1]?.height_m ?? 2 * at - levels[z + 1].height_m)) / 2;
    const share = through * -Math.expm1(-perKm(value) * exaggeration * (high / 1000));
    through -= share;
    if (share > most) [seen, most] = [levels[z], share];
  }
  if (seen ? hovered.startsWith(`${seen.value} dBZ at`) : hovered.startsWith('Lowest level')) ++told;
  else console.log(`at ${px}, ${py} the page says ${JSON.stringify(hovered)}, the server ${JSON.stringify(seen)}`);
}
// The reading writes places to three decimals, which may lie in the next cell.
check(`${told} of 6 pixels tell the cell that is seen most`, told >= 4);
await page.key('Escape');
await page.key('d');
await page.drag([250, 200], [0, 0]);
await page.drag([350, 200], [0, 0]);
const distance = await texts('tool-says');
check(`a distance eastward is told: ${distance}`, /^\d+(\.\d+)? km, azimuth (89|90|91)°, height [+−]/.test(distance));
await keep('distance');
await page.key('r');
for (const corner of [[250, 200], [350, 200], [350, 300], [250, 300]]) await page.drag(corner, [0, 0]);
const area = await texts('tool-says');
const side = Number(distance.match(/^[\d.]+/)[0]);
check(`the square on it has its area: ${area}`, Math.abs(Number(area.match(/^[\d.]+/)[0]) / side ** 2 - 1) < 0.02);
await page.key('Escape');
check('Escape ends a tool', (await texts('tool-says')) === '');
await page.evaluate("document.getElementById('raw').click()");
const raw = await page.until("document.querySelector('#tool-says a')?.href", 5);
const { headers } = await fetch(raw, { method: 'HEAD' });
check(`the raw volume is a link: ${raw.split('/').pop()}`, raw.includes(`/volumes/${station}/`) && Number(headers.get('content-length')) > 1e5);

// ---- A flight
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=60&zoom=4&field-of-view=0&least=70`);
await viewer.settled(() => page.key('f'));
check('a flight has perspective', (await viewer.number('field-of-view')) === 60 && (await viewer.number('zoom')) === 1);
const from = await viewer.told('look-at-km');
await page.send('Input.dispatchKeyEvent', { type: 'keyDown', key: 'w', text: 'w' });
await page.until(`new URLSearchParams(location.hash.slice(1)).get('look-at-km') !== ${JSON.stringify(from)}`, 10);
// A fast machine has come a few meters by then.
await new Promise((done) => setTimeout(done, 300));
await viewer.settled(() => page.send('Input.dispatchKeyEvent', { type: 'keyUp', key: 'w' }));
const [fx, fy] = [from, await viewer.told('look-at-km')].map((text) => text.split(',').map(Number)).reduce((a, b) => [b[0] - a[0], b[1] - a[1]]);
check(`W flies northward (${fx}, ${fy} km)`, fy > 0.05 && Math.abs(fx) < 0.01);
await viewer.changes('a drag looks around', 'azimuth', () => page.drag([350, 200], [50, 0]), (was, is) => Math.abs(is - was - 10) < 0.5);
await page.key('Escape');
const landed = await viewer.told('look-at-km');
await page.key('q');
check('Escape lands', (await viewer.told('look-at-km')) === landed);

// ---- The whole earth has land (2026-11-28: beyond the first view there was none)
await page.goto('about:blank');
await page.goto(`${address}/view/`);
await places();
for (let times = 0; times < 10; ++times) await page.key('-');
const isWide = (url) => Number(new URL(url).searchParams.get('east')) - Number(new URL(url).searchParams.get('west')) > 359;
const ofEarth = () => page.requests.filter((url) => url.includes('/api/v1/map?') && isWide(url)).length;
for (let tries = 0; tries < 100 && ofEarth() === 0; ++tries) await new Promise((done) => setTimeout(done, 100));
await new Promise((done) => setTimeout(done, 1500));
check(`the map of the whole earth is asked for once: ${ofEarth()}`, ofEarth() === 1);
await keep('earth');

check('no request leaves the server of the page', page.requests.every((url) => url.startsWith(`${address}/`) || url.startsWith('data:') || url.startsWith('blob:')));
check('nothing failed on the way', page.trouble.length === 0, page.trouble.join('\n'));

await browser.end();
