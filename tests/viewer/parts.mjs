// A grid that is fetched in parts, as one that is too large for the page's memory is (scripts/check-viewer): what it says
// until all is there, its picture against the slicer's, and what it does when the graphics processor or the server forgets.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, Slicer, check, gridsOf, mostDifference, viewOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, difference, directory] = process.argv.slice(2);
// A tenth of the memory is a little less than the grid.
const packedBytes = (await (await fetch(`${address}/api/v1/grids/${station}/REF/latest/packed`)).arrayBuffer()).byteLength;
const memoryMib = Math.floor((0.98 * packedBytes * 10) / 2 ** 20);
if (memoryMib < 4) {
  console.log(`the grid of ${station} has ${packedBytes} bytes, too few to be fetched in parts`);
  process.exit(0);
}
const scene = { station, moment: 'REF', azimuth: 217, tilt: 60, zoom: 8, field: 40, exaggeration: 3, opacity: 1, at: [-20, 20, 4] };
const otherScene = { ...scene, at: [30, 30, 4], zoom: 12 };
const inParts = (one) => `memory=${memoryMib}&quality=512%20slices&${viewOf(one)}`;

const browser = await Browser.start();
const page = await browser.page(400, 266);
const viewer = new CheckedPage(page, address);
const told = (name) => page.evaluate(`document.documentElement.dataset[${JSON.stringify(name)}]`);
const complete = () => page.until('document.documentElement.dataset.missing === "0"');

await viewer.open(inParts(scene));
const [missing, state] = [Number(await told('missing')), await told('state')];
check(`the first picture is coarse and says so: ${state}`, missing > 0 && state.includes('coarse'));
await complete();
const asked = page.requests.filter((url) => url.includes('/packed?'));
check(`${asked.length} requests: a table, a halved grid, ranges of bricks`, asked.some((url) => url.includes('half=')) && asked.some((url) => url.includes('bricks=')));
check(`no picture is called coarse any more: ${await told('state')}`, !(await told('state')).includes('greatest of'));
const picture = join(directory, 'parts.ppm');
const fine = await viewer.pixels();
writeFileSync(picture, fine);
const slicer = new Slicer(address, await gridsOf(address, [station]), difference, directory);
const { p99, count } = slicer.compare(await slicer.fileOf(station, 'REF'), picture, scene, ['--slices', '2048']);
check(`bricks that came in parts: dE ${p99} over ${count} pixels`, p99 <= mostDifference && count > 300);
const held = (await told('held')).match(/\d+/g).map(Number);
check(`${held[0]} of ${held[1]} MiB are held`, held[0] <= held[1] && held[1] === memoryMib);

// ---- The graphics processor forgets all
await page.evaluate(`(() => {
  const lost = document.getElementById('picture').getContext('webgl2').getExtension('WEBGL_lose_context');
  lost.loseContext();
  delete document.documentElement.dataset.missing;
  setTimeout(() => lost.restoreContext(), 100);
})()`);
await complete();
check('after the context was lost the picture is the same', (await viewer.pixels()).equals(fine));

// ---- The view moves on, and the grid is evicted meanwhile
await page.send('Fetch.enable', { patterns: [{ urlPattern: '*bricks=*' }] });
browser.listeners.push(({ method, params }) => {
  if (method !== 'Fetch.requestPaused') return;
  const body = Buffer.from(JSON.stringify({ error: 'the grid was evicted from the cache' })).toString('base64');
  page.send('Fetch.fulfillRequest', { requestId: params.requestId, responseCode: 410, body });
});
await page.evaluate(`location.hash = ${JSON.stringify(inParts(otherScene))}; undefined`);
const said = await page.until("document.documentElement.dataset.state.includes('any more') && document.documentElement.dataset.state", 20).catch(() => '');
check(`a grid that was evicted is told: ${said}`, said !== '');
await browser.end();
