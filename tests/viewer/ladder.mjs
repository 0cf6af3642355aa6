// Measures the viewer's ladder of qualities (rungs) in Chromium (scripts/viewer-ladder). For each rung and scene,
// measures the time of a frame, the texels that a pixel reads, and the difference from the slicer with many slices.
// Prints a table, and with --write puts the figures into viewer/src/renderer/ladder.ts.
import { readFileSync, writeFileSync } from 'node:fs';

import { Slicer, viewOf } from './slicer.mjs';
import { gridsOf, openPage, withBrowser } from './viewer_page.mjs';

const [address, stationsText, difference, directory, framesText, size, tablePath, write] = process.argv.slice(2);
// Matches the line of a rung in the table.
const lineOfRung = /^( *\{ name: '([^']+)', .*)cost: [\d.]+, dE: [\d.]+( \},)$/gm;
const rungs = [...readFileSync(tablePath, 'utf8').matchAll(lineOfRung)].map(([, , name]) => name);
const frames = Number(framesText);
const [width, height] = size.split('x').map(Number);
const referenceSlices = '2048';
const scenes = [
  { name: 'squall line', station: 'KLBB', moment: 'REF', azimuth: 180, tilt: 60, zoom: 1, field: 40, exaggeration: 5, opacity: 1, at: [0, 0, 5] },
  { name: 'its cells', station: 'KLBB', moment: 'REF', azimuth: 217, tilt: 71, zoom: 3, field: 40, exaggeration: 3, opacity: 1.5, at: [-40, 30, 4] },
  { name: 'its wind', station: 'KLBB', moment: 'VEL', azimuth: 180, tilt: 55, zoom: 1.5, field: 40, exaggeration: 3, opacity: 1, at: [0, 0, 4] },
  { name: 'its drops', station: 'KLBB', moment: 'ZDR', azimuth: 180, tilt: 50, zoom: 2, field: 40, exaggeration: 3, opacity: 1, at: [0, 0, 4] },
  { name: 'supercell', station: 'KTLX', moment: 'REF', azimuth: 120, tilt: 78, zoom: 4, field: 40, exaggeration: 2, opacity: 1, at: [-30, 10, 5] },
];

// Returns the memory of the page in MiB. Halved bricks exist only in a grid in parts, which the page uses only with
// little memory.
const memoryOf = (rung) => (rung === 'halved bricks' ? 24 : 256);

const stations = stationsText.split(',');
const slicer = new Slicer({ address, difference, directory, pictures: '' });

// Opens a page for each memory.
async function openPages(browser) {
  const viewers = new Map();
  for (const memory of new Set(rungs.map(memoryOf))) {
    const viewer = await openPage(browser, address, width, height);
    // Name a domain in the address, because otherwise the page may open the map of the stations.
    await viewer.open(`domain=${stations[0]}&memory=${memory}`);
    viewers.set(memory, viewer);
  }
  return viewers;
}

const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];

// Returns the median time of frames of nearly the same view. Leaves out the first frame, which makes the tables.
async function frameMs(viewer, scene, quality) {
  const times = [];
  for (let i = 0; i <= frames; ++i) {
    await viewer.show(`${viewOf({ ...scene, azimuth: scene.azimuth + 0.01 * (i + 1) })}&${quality}`);
    if (i > 0) times.push(Number(await viewer.data('frameMs')));
  }
  return median(times);
}

async function measure(viewer, rung, scene) {
  // Bring the page to the front, because browsers do not draw pages in the background.
  await viewer.page.bringToFront();
  const quality = `memory=${memoryOf(rung)}&quality=${encodeURIComponent(rung)}`;
  const ms = await frameMs(viewer, scene, quality);
  await viewer.show(`${viewOf(scene)}&${quality}`);
  await viewer.until(() => document.documentElement.dataset.missing === '0');
  const pixels = await viewer.pixels(width, height);
  const { p99, mean } = await slicer.compare(scene, pixels, { name: 'ladder', behind: ['--slices', referenceSlices] });
  await viewer.show(`${viewOf(scene)}&${quality}&count-fetches=1`);
  return { scene: scene.name, ms, dE: p99, mean, fetches: Number(await viewer.data('fetches')) };
}

const rows = rungs.map((rung) => ({ rung, results: [] }));
await gridsOf(address, stations);
await withBrowser(async (browser) => {
  const viewers = await openPages(browser);
  for (const scene of scenes) {
    if (!stations.includes(scene.station) || !(await slicer.fileOf(scene.station, scene.moment))) continue;
    for (const { rung, results } of rows) {
      const result = await measure(viewers.get(memoryOf(rung)), rung, scene);
      results.push(result);
      console.error(`${scene.name}, ${rung}: ${result.ms} ms, dE ${result.dE} (mean ${result.mean}), ${result.fetches.toFixed(1)} texels a pixel`);
    }
  }
});

// Figures of a rung: its cost over all scenes, and the largest difference of any scene.
const total = (results) => results.reduce((sum, { ms }) => sum + ms, 0);
const costOf = ({ results }) => total(results) / total(rows[0].results);
const dEOf = ({ results }) => Math.max(...results.map(({ dE }) => dE));
const row = (cells) => console.log(`| ${cells.join(' | ')} |`);
const names = rows[0].results.map(({ scene }) => scene);
row(['rung', ...names.map((name) => `${name}: ms, texels, dE`), 'cost', 'largest dE']);
row(Array(names.length + 3).fill('---'));
for (const one of rows) {
  row([one.rung, ...one.results.map(({ ms, fetches, dE }) => `${ms}, ${fetches.toFixed(1)}, ${dE.toFixed(2)}`), costOf(one).toFixed(2), dEOf(one).toFixed(1)]);
}
if (write) {
  const text = readFileSync(tablePath, 'utf8');
  const measured = new Map(rows.map((one) => [one.rung, `cost: ${costOf(one).toFixed(2)}, dE: ${dEOf(one).toFixed(1)}`]));
  writeFileSync(tablePath, text.replace(lineOfRung, (_, before, name, behind) => before + measured.get(name) + behind));
}
