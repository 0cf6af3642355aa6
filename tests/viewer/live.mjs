// Measures the time from the end of a sweep to its picture in the viewer (scripts/bench-viewer). Appends a real volume
// record by record to a file in the drop directory, as LDM does. After each record, waits until the page has drawn a
// picture, but not longer than `longestMs`. Prints rows.
//   node live.mjs ADDRESS STATION VOLUME FILE_IN_DROP_DIRECTORY
import { appendFileSync, mkdirSync, readFileSync } from 'node:fs';
import { dirname } from 'node:path';

import { openPage, withBrowser } from './viewer_page.mjs';

const [address, station, volume, target] = process.argv.slice(2);
const [width, height] = [796, 532];
const headerBytes = 24;
// Longest time to wait for a picture. A record that closes no sweep of the moment brings no picture.
const longestMs = 2500;

// Splits an archive file into its records. The first piece also has the header of the volume.
function piecesOf(bytes) {
  const pieces = [];
  for (let begin = 0, at = headerBytes; at < bytes.length; begin = at) {
    at += 4 + Math.abs(bytes.readInt32BE(at));
    pieces.push(bytes.subarray(begin, at));
  }
  return pieces;
}

const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const row = (name, list) => console.log(`| ${name} | ${Math.round(median(list))} ms (${list.map(Math.round).join(', ')}) |`);

async function hasGrid() {
  const { grids } = await (await fetch(`${address}/api/v1/grids?domain=${station}&moment=REF`)).json();
  return grids.length > 0;
}

// Records when the page completes a picture, in ms since 1970, and how long the frame took. Runs in the page.
function watch() {
  window.drawn_ = [];
  const note = () => {
    const { drawn, frameMs } = document.documentElement.dataset;
    if (drawn) window.drawn_.push([performance.timeOrigin + performance.now(), Number(frameMs)]);
  };
  new MutationObserver(note).observe(document.documentElement, { attributes: true, attributeFilter: ['data-drawn'] });
}

const pieces = piecesOf(readFileSync(volume));
mkdirSync(dirname(target), { recursive: true });
let sent = 0;
// Appends the next record. Returns the time when the file was closed.
function send() {
  appendFileSync(target, pieces[sent++]);
  return performance.timeOrigin + performance.now();
}

while (sent < pieces.length && !(await hasGrid())) {
  send();
  await wait(500);
}
await withBrowser(async (browser) => {
  const viewer = await openPage(browser, address, width, height);
  await viewer.open(`domain=${station}&moment=REF`);
  await viewer.page.evaluate(watch);
  const found = [];
  while (sent < pieces.length) {
    await viewer.page.evaluate(() => void (window.drawn_.length = 0));
    const closed = send();
    const first = await viewer.until(() => window.drawn_[0], null, longestMs).catch(() => null);
    if (!first) continue;
    // Wait for another picture, which would belong to the same sweep.
    await wait(longestMs / 5);
    found.push({ all: first[0] - closed, frame: first[1] });
  }
  if (found.length === 0) throw new Error('the page has drawn no sweep');
  row('from the close of a sweep to its picture', found.map(({ all }) => all));
  row('without its frame; decompression is in it', found.map(({ all, frame }) => all - frame));
});
