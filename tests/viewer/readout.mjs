// The pointer reads what is under it: the color of the pixel is that of the value that is told (scripts/check-viewer).
//   node readout.mjs ADDRESS STATION [PICTURE_DIRECTORY]
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, check, gridsOf, image } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, pictures] = process.argv.slice(2);
await gridsOf(address, [station]);
const { tables, usual } = await (await fetch(`${address}/api/v1/tables`)).json();
const { stops, range_folded: folded } = tables.find(({ name }) => name === usual.REF);
const seen = [40, 44, 50]; // clear air, below what is not opaque (renderer/shades.ts)
// The color of a value, and how opaque it is on a map.
function colorOf(value) {
  let i = stops.length - 1;
  while (i > 0 && value < stops[i].from) --i;
  if (i === stops.length - 1 || value < stops[0].from) return stops[i].color;
  const share = (value - stops[i].from) / (stops[i + 1].from - stops[i].from);
  return stops[i].color.map((c, k) => c + share * (stops[i].until[k] - c));
}

const browser = await Browser.start();
try {
  const [width, height] = [700, 440];
  const page = await browser.page(width, height);
  const viewer = new CheckedPage(page, address);
  const shown = "!document.getElementById('hover').hidden && [...document.querySelectorAll('#hover p')].map((one) => one.textContent).join('; ')";
  const under = async (x, y) => {
    await page.mouse('mouseMoved', 2, height - 2);
    await page.evaluate("document.getElementById('hover').hidden = true; undefined");
    await page.mouse('mouseMoved', x, y);
    return page.until(shown, 20).catch(() => '');
  };
  const keep = async (name) => {
    if (!pictures) return;
    mkdirSync(pictures, { recursive: true });
    writeFileSync(join(pictures, `${name}.png`), await page.screenshot());
  };

  // ---- Sweep, plane and column maximum (2026-11-28: "echo that is not shown" over 58 dBZ)
  const flat = `domain=${station}&moment=REF&volume=0&ground=0&azimuth=180&tilt=0&field-of-view=0&exaggeration=1&zoom=3`;
  await viewer.open(`${flat}&maximum=1`);
  for (const [layer, words, pattern] of [
    ['elevation=0.5', 'a sweep', /^(-?[\d.]+) dBZ at [\d.]+ km; tilt 0\.\d°, beam [\d.]+ km wide, [\d.]+ km at \d+° from [A-Z]{4}; seen at \d\d:\d\d:\d\d UTC$/],
    ['height-km=3', 'a plane', /^(-?[\d.]+) dBZ at 3\.0 km; on the plane/],
    ['maximum=1', 'the column maximum', /^(-?[\d.]+) dBZ at [\d.]+ km; maximum of the column/],
  ]) {
    await viewer.show(`${flat}&${layer}`);
    const picture = image(await viewer.pixels());
    let [read, right] = [0, 0];
    for (let x = 130; x < width - 110 && read < 12; x += 37) {
      for (let y = 170; y < height - 110 && read < 12; y += 31) {
        const pixel = picture.at(x, y);
        if (Math.max(...pixel) < 100) continue; // clear, or not seen
        ++read;
        const told = await under(x, y);
        const [, value] = told.match(pattern) ?? [];
        const color = told.startsWith('range folded') ? folded : colorOf(Number(value));
        const apart = Math.max(...pixel.map((c, k) => Math.abs(seen[k] + (color[3] / 255) * (color[k] - seen[k]) - c)));
        // A place at the edge of a gate or cell may be read from the next one.
        if (apart <= 12) ++right;
        else console.log(`at ${x}, ${y} is ${pixel}, and it says ${told}`);
      }
    }
    check(`${right} of ${read} readings of ${words} have the color of the pixel`, read >= 6 && right >= 0.8 * read);
    await keep(`readout-${layer.split('=')[0]}`);
  }

  // ---- Where the pointer rests, what is read is what is drawn (2026-11-28: another layer left the old reading)
  await viewer.show(`${flat}&height-km=3`);
  const ppm2 = image(await viewer.pixels());
  const places = [];
  for (let x = 130; x < width - 110; x += 37) for (let y = 170; y < height - 110; y += 31) if (Math.max(...ppm2.at(x, y)) >= 100) places.push([x, y]);
  const before = await under(...places[0]);
  await page.key('c');
  await page.key('m');
  const after = await page.until(`(${shown})?.includes('maximum of the column') && (${shown})`, 20).catch(() => '');
  check(`with another layer the pointer reads it: ${before} became ${after}`, before.includes('on the plane') && after !== '');

  // ---- The volume (2026-11-28: over the core of a storm it read 6.5 dBZ of the anvil that nobody sees)
  await viewer.show(`domain=${station}&moment=REF&ground=0&tilt=60&zoom=3`);
  const ppm = image(await viewer.pixels());
  let core = null;
  for (let x = 120; x < width - 110; x += 2) {
    for (let y = 110; y < height - 110; y += 2) {
      const [red, green, blue] = ppm.at(x, y);
      const score = red - green - blue;
      if (!core || score > core.score) core = { x, y, score };
    }
  }
  const told = await under(core.x, core.y);
  check(`over the reddest pixel (${ppm.at(core.x, core.y)}) it reads ${told}`, parseFloat(told) >= 40);
  await page.drag([core.x, core.y], [0, 0]);
  const reading = await page.until("document.getElementById('reading').innerText.includes('Maximum') && document.getElementById('reading').innerText", 20).catch(() => '');
  const [first, most] = [Number(reading.match(/(-?[\d.]+) dBZ at/)?.[1]), Number(reading.match(/Maximum (-?[\d.]+) dBZ/)?.[1])];
  check(`a click reads the same, and its column: ${first}, at most ${most} dBZ`, first === parseFloat(told) && most >= first);
  const marked = await page.evaluate(`(() => {
    const labels = document.getElementById('labels');
    const { data } = labels.getContext('2d').getImageData(${core.x} - 4, ${core.y} - 4, 9, 9);
    let white = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 230 && data[i + 1] > 230 && data[i + 2] > 230) ++white;
    return white;
  })()`);
  check('it marks the place', marked > 10);
  await keep('readout-volume');
  await page.key('Escape');

  // ---- Beyond the grid
  await viewer.show(`domain=${station}&moment=REF&tilt=0&field-of-view=0&zoom=0.4`);
  const outside = await under(150, 220);
  check(`beyond the grid: ${outside}`, /^Outside the grid; \d+(\.\d+)? km at \d+° from [A-Z]{4}$/.test(outside));
  check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
} finally {
  await browser.end();
}
