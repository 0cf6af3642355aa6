// Measures how fast the viewer's page is in Chromium (scripts/bench-viewer). Prints a row for each figure.
//   node bench.mjs ADDRESS first|steps|nation [ROUNDS]
// The server has one volume for `first`, a grid at several times for `steps`, a mosaic of the country for `nation`.
import { CheckedPage } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, what, roundsText] = process.argv.slice(2);
const rounds = Number(roundsText ?? 3);
const [width, height] = [796, 532];
const browser = await Browser.start();
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const told = (page, name) => page.evaluate(`document.documentElement.dataset[${JSON.stringify(name)}]`);
const row = (name, ...cells) => console.log(`| ${[name, ...cells].join(' | ')} |`);
const ms = (list) => `${Math.round(median(list))} ms (${list.map(Math.round).join(', ')})`;

// A page that has nothing yet, and its first picture.
async function firstPicture(view) {
  const page = await browser.page(width, height);
  await page.send('Network.setCacheDisabled', { cacheDisabled: true });
  const began = performance.now();
  const viewer = new CheckedPage(page, address);
  await viewer.open(view);
  const all = performance.now() - began;
  const frame = Number(await told(page, 'frameMs'));
  return { page, viewer, all, frame };
}

async function firstPictures(view) {
  const pictures = [];
  for (let i = 0; i < rounds; ++i) {
    const { page, all, frame } = await firstPicture(view);
    pictures.push({ beyond: all - frame, frame, bytes: page.bytes });
    await page.close();
  }
  row('first picture, beyond its own frame', ms(pictures.map(({ beyond }) => beyond)));
  row('that frame', ms(pictures.map(({ frame }) => frame)));
  row('bytes on the wire until then', median(pictures.map(({ bytes }) => bytes)));
}

// Counts the frames that are drawn a second while a hand turns the view, and names the rung of the last one.
async function turning(page) {
  const frames = [];
  await page.evaluate(`window.frames_ = []; new MutationObserver(() => frames_.push([performance.now(), document.documentElement.dataset.rung]))
    .observe(document.documentElement, { attributes: true, attributeFilter: ['data-frames'] }); undefined`);
  await page.mouse('mousePressed', 300, 300, { buttons: 1 });
  const end = performance.now() + 4000;
  for (let x = 300; performance.now() < end; x = x < 500 ? x + 1 : 300) await page.mouse('mouseMoved', x, 300, { buttons: 1 });
  frames.push(...(await page.evaluate('frames_')));
  await page.mouse('mouseReleased', 400, 300);
  // The first second is the governor's.
  const after = frames.filter(([at]) => at > frames[0][0] + 1000);
  const last = after[after.length - 1];
  row('frames a second while the view turns', `${((after.length - 1) / ((last[0] - after[0][0]) / 1000)).toFixed(1)} (${last[1]})`);
}

async function steps() {
  const times = (await (await fetch(`${address}/api/v1/grids?domain=KLBB&moment=REF&limit=500`)).json()).grids.map(({ time }) => time);
  const { page, viewer } = await firstPicture(`domain=KLBB&moment=REF&time=${times[0]}`);
  const began = performance.now();
  await page.key(' ');
  await page.until(`Number(document.documentElement.dataset.loaded) >= ${times.length}`, 60);
  row(`${times.length} steps loaded`, `${Math.round(performance.now() - began)} ms`);
  await page.key(' ');
  const switches = [];
  for (let i = 0; i < 5; ++i) {
    const at = performance.now();
    await viewer.settled(() => page.key(','));
    switches.push(performance.now() - at - Number(await told(page, 'frameMs')));
  }
  row('another loaded step, beyond its own frame', ms(switches));
  await turning(page);
}

async function nation() {
  const { page, all, frame } = await firstPicture('');
  row('first picture, beyond its own frame', `${Math.round(all - frame)} ms (${page.bytes} bytes)`);
  await page.until('document.documentElement.dataset.missing === "0"', 60);
  row('what that view needs is there', `${Math.round(performance.now())} ms`, `${page.bytes} bytes`);
  row('memory that is held', await told(page, 'held'));
}

await { first: () => firstPictures(''), steps, nation }[what]();
await browser.end();
