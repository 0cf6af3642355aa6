// Measures how fast the viewer's page is in Chromium (scripts/bench-viewer). Prints a row for each figure.
//   node bench.mjs ADDRESS first|steps|nation [ROUNDS]
// The server must have one volume for `first`, grids at several times for `steps`, and a mosaic of the country for
// `nation`.
import { openPage, withBrowser } from './viewer_page.mjs';

const [address, what, roundsText] = process.argv.slice(2);
const rounds = Number(roundsText ?? 3);
const [width, height] = [796, 532];
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const row = (name, ...cells) => console.log(`| ${[name, ...cells].join(' | ')} |`);
const ms = (list) => `${Math.round(median(list))} ms (${list.map(Math.round).join(', ')})`;
const frameMs = async (viewer) => Number(await viewer.data('frameMs'));

// Measures the first picture in a new page.
async function firstPicture(browser, view) {
  const viewer = await openPage(browser, address, width, height);
  await viewer.countBytes();
  const began = performance.now();
  await viewer.goto(view);
  await viewer.drawn();
  return { viewer, all: performance.now() - began, frame: await frameMs(viewer) };
}

async function first(browser) {
  const pictures = [];
  for (let i = 0; i < rounds; ++i) {
    const { viewer, all, frame } = await firstPicture(browser, '');
    pictures.push({ beyond: all - frame, frame, bytes: await viewer.bytesOfFirstPicture() });
    await viewer.page.context().close();
  }
  row('first picture, beyond its own frame', ms(pictures.map(({ beyond }) => beyond)));
  row('that frame', ms(pictures.map(({ frame }) => frame)));
  row('bytes on the wire until then', median(pictures.map(({ bytes }) => bytes)));
  await longestTasks(browser);
}

// Turns the view, and measures the frames per second and the quality (rung) of the last frame.
async function turning({ page }) {
  await page.evaluate(() => {
    window.frames_ = [];
    const note = () => window.frames_.push([performance.now(), document.documentElement.dataset.rung]);
    new MutationObserver(note).observe(document.documentElement, { attributes: true, attributeFilter: ['data-frames'] });
  });
  await page.mouse.move(300, 300);
  await page.mouse.down();
  const end = performance.now() + 4000;
  for (let x = 300; performance.now() < end; x = x < 500 ? x + 1 : 300) await page.mouse.move(x, 300);
  const frames = await page.evaluate(() => window.frames_);
  await page.mouse.up();
  // Leave out the first second, in which the governor chooses a rung.
  const after = frames.filter(([at]) => at > frames[0][0] + 1000);
  const last = after[after.length - 1];
  row('frames a second while the view turns', `${((after.length - 1) / ((last[0] - after[0][0]) / 1000)).toFixed(1)} (${last[1]})`);
}

// Measures the longest tasks of the page when the volume fills a large window: while the page loads, while the view
// turns, and while a fine picture is drawn. During a task, the page does not act.
async function longestTasks(browser) {
  const viewer = await openPage(browser, address, 1440, 900);
  await viewer.page.addInitScript(() => {
    window.tasks_ = [0];
    new PerformanceObserver((list) => window.tasks_.push(...list.getEntries().map(({ duration }) => duration))).observe({ type: 'longtask' });
  });
  const longest = () => viewer.page.evaluate(() => Math.max(...window.tasks_.splice(0, Infinity, 0)));
  await viewer.goto('domain=KLBB&moment=REF&tilt=40&zoom=9');
  await viewer.drawn();
  const found = [await longest()];
  await viewer.page.mouse.move(700, 450);
  await viewer.page.mouse.down();
  for (let x = 700; x < 1000; x += 5) await viewer.page.mouse.move(x, 450);
  found.push(await longest());
  await viewer.page.mouse.up();
  await viewer.drawn();
  found.push(await longest());
  row('longest task: loading, turning, a fine picture of', found.map((one) => `${Math.round(one)} ms`).join(', '), `${await frameMs(viewer)} ms`);
  await viewer.page.context().close();
}

async function steps(browser) {
  const { grids } = await (await fetch(`${address}/api/v1/grids?domain=KLBB&moment=REF&limit=500`)).json();
  const { viewer } = await firstPicture(browser, `domain=KLBB&moment=REF&time=${grids[0].time}`);
  const began = performance.now();
  await viewer.key(' ');
  await viewer.until((count) => Number(document.documentElement.dataset.loaded) >= count, grids.length, 60_000);
  row(`${grids.length} steps loaded`, `${Math.round(performance.now() - began)} ms`);
  await viewer.key(' ');
  const switches = [];
  for (let i = 0; i < 5; ++i) {
    const at = performance.now();
    await viewer.settled(() => viewer.key(','));
    switches.push(performance.now() - at - (await frameMs(viewer)));
  }
  row('another loaded step, beyond its own frame', ms(switches));
  await turning(viewer);
}

async function nation(browser) {
  const began = performance.now();
  const { viewer, all, frame } = await firstPicture(browser, '');
  row('first picture, beyond its own frame', `${Math.round(all - frame)} ms (${viewer.bytes} bytes)`);
  await viewer.until(() => document.documentElement.dataset.missing === '0', null, 60_000);
  row('what that view needs is there', `${Math.round(performance.now() - began)} ms`, `${viewer.bytes} bytes`);
  row('memory that is held', await viewer.data('held'));
}

await withBrowser({ first, steps, nation }[what]);
