// How a user gets in and around (scripts/check-viewer): the map of all stations by mouse, keys, fingers and words.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, check, gridsOf } from './checked_page.mjs';
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
check('no request leaves the server of the page', page.requests.every((url) => url.startsWith(`${address}/`) || url.startsWith('data:') || url.startsWith('blob:')));
check('nothing failed on the way', page.trouble.length === 0, page.trouble.join('\n'));

await browser.end();
