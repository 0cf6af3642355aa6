// Checks the layers of the viewer in Chromium (scripts/check-viewer): flat ones against the pictures of `stormcellar
// frame`, which cut the same grid by themselves, and what mouse and keys do to them.
//   node layers.mjs ADDRESS STATION VOLUME PROGRAM DIFFERENCE DIRECTORY
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, Slicer, check, gridsOf, image, mostDifference, pictureOf, shadesOf, viewOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, volume, program, difference, directory] = process.argv.slice(2);
const browser = await Browser.start();
const [width, height] = [400, 266];
const page = await browser.page(width, height);
const viewer = new CheckedPage(page, address);
const grids = await gridsOf(address, [station]);
const gridOf = (moment) => grids.find((one) => one.domain === station && one.moment === moment);
const facts = await (await fetch(`${address}${gridOf('REF').path}`)).json();

// The quiet colors of the picture: seen, not seen, hatch with its soft edge, border, and black where nothing is drawn.
const quiet = [[40, 44, 50], [29, 32, 37], [23, 25, 29], [78, 82, 92], [120, 130, 146], [11, 14, 19], [0, 0, 0], [39, 42, 47]];
const isNear = (a, b, most) => a.every((one, c) => Math.abs(one - b[c]) <= most);
const isQuiet = (color) => quiet.some((one) => isNear(color, one, 1));

const framed = (words, w, h) => pictureOf(page, program, [volume, ...words, '--no-labels'], w, h, directory);

// Counts the pixels that show a value in either picture, and those of them that have another color in the other one. It
// leaves out the outermost pixels, where the pictures have a border.
function compared(ours, theirs, most = 3) {
  let [shown, off] = [0, 0];
  for (let y = 2; y < ours.height - 2; ++y) {
    for (let x = 2; x < ours.width - 2; ++x) {
      const [one, other] = [ours.at(x, y), theirs.at(x, y)];
      if (isQuiet(one) && isQuiet(other)) continue;
      ++shown;
      if (!isNear(one, other, most)) ++off;
    }
  }
  return { shown, off };
}
function checkSame(what, { shown, off }, mostShare) {
  check(`${what}: ${off} of ${shown} pixels with values differ`, shown > 300 && off <= mostShare * shown);
}

// The picture has another size before it is drawn.
const resize = (w, h) => viewer.settled(() => page.resize(w, h));

// ---- What is off costs nothing
await viewer.open(`domain=${station}&moment=REF`);
await page.until("document.documentElement.dataset.variants.includes('lines')");
const variants = async () => (await page.evaluate('document.documentElement.dataset.variants')).split('; ');
const usual = await variants();
check(`without layers there are the programs of volume, ground and lines: ${usual.join('; ')}`, usual.length === 3 && usual.every((name) => /^(volume, perspective|ground, perspective|lines)$/.test(name)));

// ---- Flat layers from above: a pixel is a cell of the grid, so that nothing lies between cells
const cell = facts.spacing_m;
const zoom = ((1.04 * facts.ny * cell) / height / cell).toFixed(4);
const above = `domain=${station}&ground=0&volume=0&azimuth=180&tilt=0&field-of-view=0&zoom=${zoom}`;
const top = ['--zoom', zoom, '--smooth', 'none'];
for (const [what, moment, layer, words] of [
  ['plane', 'REF', 'height-km=3', ['--product', 'cappi', '--height-km', '3', ...top]],
  ['plane', 'VEL', 'height-km=2.25', ['--product', 'cappi', '--height-km', '2.25', '--moment', 'VEL', ...top]],
  ['column maximum', 'REF', 'maximum=1', ['--product', 'composite', ...top]],
]) {
  await viewer.show(`${above}&moment=${moment}&${layer}`);
  checkSame(`${what} of ${moment}`, compared(image(await viewer.pixels()), await framed(words, width, height)), 0.005);
}
// A border between two gates may lie in either of two pixels.
const { at: [latitude, longitude] } = await (await fetch(`${address}${gridOf('REF').path}/probe?at=${facts.center.join(',')}`)).json();
const { volumes } = await (await fetch(`${address}/api/v1/stations/${station}/volumes`)).json();
const { sweeps } = await (await fetch(`${address}/api/v1/stations/${station}/volumes/${volumes[0].time}/sweeps`)).json();
const elevations = [...new Set(sweeps.filter(({ moments }) => moments.some(({ moment }) => moment === 'REF')).map((one) => one.elevation_deg.toFixed(1)))];
const extent = ['--center', `${latitude},${longitude}`, '--zoom', '1.04', '--extent-km', `${(width * cell) / 1000},${(height * cell) / 1000}`];
const ofSweep = (elevation) => framed(['--product', 'ppi', '--elevation', elevation, ...extent], width, height);
await viewer.show(`${above}&moment=REF&elevation=${elevations[1]}`);
const sweep = image(await viewer.pixels());
checkSame(`sweep at ${elevations[1]} degrees`, compared(sweep, await ofSweep(elevations[1])), 0.05);
const lower = compared(sweep, await ofSweep(elevations[0]));
check(`of that at ${elevations[0]} degrees ${lower.off} of ${lower.shown} pixels differ, so this can fail`, lower.off > 0.2 * lower.shown);

// ---- A surface from above: it is where the greatest value of the column reaches the chosen one
await viewer.show(`${above}&moment=REF&maximum=1&least=45`);
const strong = image(await viewer.pixels());
await viewer.show(`${above}&moment=REF&surface=45`);
const surface = image(await viewer.pixels());
let [inside, missing, more, sumX, sumY] = [0, 0, 0, 0, 0];
for (let y = 0; y < height; ++y) {
  for (let x = 0; x < width; ++x) {
    const [has, wants] = [surface, strong].map((one) => one.at(x, y).some((c) => c > 0));
    if (wants) [inside, sumX, sumY] = [inside + 1, sumX + x + 0.5, sumY + y + 0.5];
    if (wants && !has) ++missing;
    if (has && !wants) ++more;
  }
}
// A ray may step over a cell that just reaches the value.
check(`surface: of ${inside} pixels where the column maximum reaches 45 dBZ ${missing} are missing, and there are ${more} others`,
  inside > 30 && missing <= 0.06 * inside && more <= 0.005 * inside);
// If two moments are chosen, one gives the shape, and the other one the colors.
await viewer.show(`${above}&moment=VEL&surface=45&surface-moment=REF`);
const colored = image(await viewer.pixels());
let [shape, others] = [0, 0];
const velocities = new Set();
for (let y = 0; y < height; ++y) {
  for (let x = 0; x < width; ++x) {
    const [one, two] = [surface, colored].map((of) => of.at(x, y));
    if (one.some((c) => c > 0) !== two.some((c) => c > 0)) ++others;
    if (two.some((c) => c > 0)) {
      ++shape;
      velocities.add(String(two));
    }
  }
}
check(`a surface of REF in the colors of VEL has its ${shape} pixels, ${others} others, and ${velocities.size} shades`, shape > 30 && others === 0 && velocities.size > 10 && !colored.at(0, 0).some((c) => c > 0));
// The middle of the strong echo, in km.
const [eastKm, northKm] = [((sumX / inside - width / 2) * cell) / 1000, ((height / 2 - sumY / inside) * cell) / 1000];

// ---- The plot of a section
await resize(796, 532);
const [a, b] = [[eastKm - 40, northKm - 20], [eastKm + 40, northKm + 20]].map(([x, y]) => [latitude + y / 111, longitude + x / (111 * Math.cos((latitude * Math.PI) / 180))]);
const line = [...a, ...b].map((degrees) => degrees.toFixed(4)).join(',');
await viewer.show(`domain=${station}&moment=REF&section=${line}&volume=0&tilt=70`);
const plot = await page.evaluate(`(() => {
  const canvas = document.getElementById('section-canvas');
  const [w, h] = [canvas.width - 46, canvas.height - 30];
  const { data } = canvas.getContext('2d').getImageData(34, 8, w, h);
  let text = '';
  for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
  return w + ' ' + h + ' ' + btoa(text);
})()`);
const [w, h, bytes] = plot.split(' ');
const drawn = image(Buffer.concat([Buffer.from(`P6\n${w} ${h}\n255\n`), Buffer.from(bytes, 'base64')]));
checkSame('section', compared(drawn, await framed(['--product', 'section', '--section', line], Number(w), Number(h))), 0.01);
const said = () => page.evaluate("document.getElementById('section-reading').textContent");
check(`the plot says its greatest value: ${await said()}`, /^Greatest [\d.]+ dBZ, [\d.]+ km from A, [\d.]+ km above sea level$/.test(await said()));
await page.evaluate("document.getElementById('section-canvas').focus()");
await page.key('ArrowLeft');
check(`an arrow reads the plot: ${await said()}`, !(await said()).startsWith('Greatest'));

// ---- Light against the slicer's, with the sun beside the camera
await resize(width, height);
const slicer = new Slicer(address, grids, difference, directory);
const scene = { station, moment: 'REF', azimuth: 180, tilt: 65, zoom: 5, field: 40, exaggeration: 3, opacity: 1, at: [Math.round(eastKm), Math.round(northKm), 4] };
const file = await slicer.fileOf(station, 'REF');
await viewer.show(`${viewOf(scene)}&light=gradient`);
const lit = join(directory, 'lit.ppm');
writeFileSync(lit, await viewer.pixels());
slicer.before = ['--sun', '245,40'];
const light = slicer.compare(file, lit, scene);
check(`light: dE ${light.p99} (mean ${light.mean}, most ${light.most}) over ${light.count} pixels`, light.p99 <= mostDifference && light.count > 300);
slicer.before = ['--sun', '90,40'];
const otherLight = slicer.compare(file, lit, scene);
check(`with the sun elsewhere the difference is ${otherLight.p99}`, otherLight.p99 > mostDifference);

// ---- A box cuts the volume, what is solid ends it, haze lies behind it
const side = Math.round(width / 2 + (1000 * eastKm) / cell); // where the box ends in the east
const shownIn = async () => {
  const one = image(await viewer.pixels());
  let [west, east] = [0, 0];
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) if (one.at(x, y).some((c) => c > 0)) x < side ? ++west : ++east;
  return { west, east, all: west + east };
};
const volumeAbove = `domain=${station}&moment=REF&ground=0&azimuth=180&tilt=0&field-of-view=0&zoom=${zoom}&least=40`;
await viewer.show(volumeAbove);
const whole = await shownIn();
await viewer.show(`${volumeAbove}&crop-km=-300,${((side - width / 2) * cell) / 1000},-300,300,0,30`);
const half = await shownIn();
check(`a box leaves ${half.west} of ${whole.west} pixels inside and ${half.east} of ${whole.east} outside`, half.west === whole.west && whole.west > 20 && half.east === 0 && whole.east > 20);
await viewer.show(`${volumeAbove}&height-km=1`);
const low = await shownIn();
await viewer.show(`${volumeAbove}&height-km=1&volume=0`);
const plane = await shownIn();
check(`before a plane below is the volume: ${low.all} pixels, ${plane.all} of the plane alone`, low.all >= Math.max(whole.all, plane.all) && plane.all < low.all);
await viewer.show(`${volumeAbove}&haze=1`);
const hazy = await shownIn();
check(`haze veils ${hazy.all - whole.all} pixels`, hazy.all - whole.all > 1000);

// ---- Keys and mouse
await resize(560, 420);
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
const key = async (name) => viewer.settled(() => page.key(name));
await page.evaluate("document.getElementById('picture').focus()");
for (const [name, parameter] of [['c', 'height-km'], ['i', 'surface'], ['m', 'maximum'], ['w', 'elevation'], ['b', 'crop-km'], ['g', 'light'], ['n', 'haze'], ['u', 'folded'], ['v', 'volume']]) {
  await key(name);
  const on = await viewer.told(parameter);
  if (name === 'c') await viewer.changes('] raises the plane', 'height-km', () => page.key(']'), (before, after) => after > before);
  await key(name);
  check(`${name.toUpperCase()} switches ${parameter}: ${on}`, on !== null && (await viewer.told(parameter)) === null);
}
await key('x');
const first = await viewer.told('section');
const hint = await page.evaluate("document.getElementById('tool-says').textContent");
await viewer.settled(() => page.drag([425, 110], [45, 100]));
const second = await viewer.told('section');
const [latitudeA, longitudeA, latitudeB, longitudeB] = second.split(',').map(Number);
check('what the drag draws was said, and is said no longer', hint.startsWith('Drag on the ground') && (await page.evaluate("document.getElementById('tool-says').textContent")) === '');
check(`X cuts, and a drag cuts elsewhere: ${first} to ${second}`, first !== null && second !== first && latitudeA > latitudeB && longitudeA < longitudeB);
await viewer.settled(() => page.drag([430, 250], [40, 0]));
check('then a drag moves the map again', (await viewer.told('section')) === second && (await viewer.told('look-at-km')) !== null);
await viewer.changes('A looks at the section', 'tilt', () => page.key('a'), (_, after) => after === 80);
await viewer.settled(() => page.evaluate("document.getElementById('layers-open').click()"));
await viewer.settled(() => page.evaluate("document.getElementById('layer-plane').click()"));
await viewer.settled(() => page.evaluate("const slider = document.getElementById('plane-height'); slider.value = 7000; slider.dispatchEvent(new Event('input')); undefined"));
check('the slider of the panel sets the height', (await viewer.number('height-km')) === 7);
check('every control has a name', await page.evaluate(`[...document.querySelectorAll('#layers input, #layers select')].every((one) => one.labels.length > 0 || one.getAttribute('aria-label'))`));
await resize(360, 640);
await viewer.settled(() => page.evaluate("document.getElementById('layer-crop').click()"));
check('the panel fits a page 360 pixels wide', await page.evaluate(`(() => {
  const box = document.getElementById('layers').getBoundingClientRect();
  return box.left >= 0 && box.right <= 360 && document.getElementById('layers').scrollWidth <= document.getElementById('layers').clientWidth;
})()`));
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));

await browser.end();
