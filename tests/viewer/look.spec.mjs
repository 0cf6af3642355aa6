// Compares pictures of the page with the slicer's pictures, and readings with the server's probe. Checks what mouse,
// keys and fingers do.
import { expect, expectLikeSlicer, report, test } from './fixtures.mjs';
import { placeOf, shadesOf } from './pixels.mjs';
import { mostDifference, viewOf } from './slicer.mjs';

test.use({ viewport: { width: 400, height: 266 } });

test('the first picture', async ({ page, viewer, server: { station } }) => {
  await viewer.countBytes();
  const began = performance.now();
  await viewer.goto(`domain=${station}`);
  await viewer.drawn();
  const ms = Math.round(performance.now() - began);
  const bytes = await viewer.bytesOfFirstPicture();
  report(`after ${ms} ms, ${bytes} bytes on the wire`);
  expect(bytes, 'the programs came').toBeGreaterThan(60_000);
  if (station === 'KLBB') expect(bytes, 'bytes on the wire').toBeLessThanOrEqual(350_000);
  expect(shadesOf(await viewer.pixels()).size, 'colors').toBeGreaterThan(200);
  await expect(page).toHaveTitle(new RegExp(station));
});

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
].map(([one, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at], number) => ({
  number, one, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at,
}));

async function compareScenes(some, viewer, { station: usual, stations, slicer }) {
  await viewer.open(`domain=${usual}`);
  let compared = 0;
  for (const { number, one, ...view } of some) {
    const scene = { ...view, station: stations[one] };
    if (!scene.station || !(await slicer.fileOf(scene.station, scene.moment))) continue;
    await viewer.show(viewOf(scene));
    const pixels = await viewer.pixels();
    const what = `scene ${number}, ${scene.station} ${scene.moment}`;
    expectLikeSlicer(what, await slicer.compare(scene, pixels, { name: `scene-${number}` }));
    if (compared++ > 0) continue;
    // Check that the comparison finds a difference with other heights.
    const other = await slicer.compare({ ...scene, exaggeration: scene.exaggeration * 1.5 }, pixels, { name: 'other' });
    report(`with other heights the difference is ${other.p99}`);
    expect(other.p99, 'the difference with other heights').toBeGreaterThan(mostDifference);
  }
  expect(compared, 'scenes that were compared').toBeGreaterThanOrEqual(4);
}

// Every third scene is enough for both projections, two moments and both volumes.
test('the volume agrees with the slicer', async ({ viewer, server }) => {
  await compareScenes(scenes.filter(({ number }) => number % 3 === 0), viewer, server);
});

test('the volume agrees with the slicer in other scenes', { tag: '@full' }, async ({ viewer, server }) => {
  await compareScenes(scenes.filter(({ number }) => number % 3 !== 0), viewer, server);
});

test('weak echo can be hidden', async ({ viewer, server: { station } }) => {
  // Echo of 20 to 35 dBZ is green, and stronger echo is yellow and red.
  const echoes = `domain=${station}&moment=REF&ground=0&azimuth=180&tilt=0&zoom=1.5&field-of-view=0`;
  const isGreen = (rgb) => ((rgb >> 8) & 255) > (rgb >> 16) + 25;
  const greens = (ppm) => [...shadesOf(ppm)].filter(isGreen).length;
  await viewer.open(echoes);
  expect(greens(await viewer.pixels()), 'green shades').toBeGreaterThan(20);
  await viewer.show(`${echoes}&least=36`);
  const strong = await viewer.pixels();
  expect(greens(strong), 'green shades above 36 dBZ').toBe(0);
  expect(shadesOf(strong).size).toBeGreaterThan(5);
});

test('mouse, keys and fingers move the view', async ({ viewer, server: { station } }) => {
  const at = [250, 300];
  // Use a window with room beside the controls.
  await viewer.resize(796, 532);
  // Draw little echo, so that no touch waits until the browser cancels it.
  await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=50&zoom=1.5&field-of-view=0&least=70`);
  const differs = (before, after) => after !== before;
  await viewer.changes('dragging turns', 'azimuth', () => viewer.drag(at, [40, 0]), differs);
  await viewer.changes('dragging tilts', 'tilt', () => viewer.drag(at, [0, 30]), (before, after) => after < before);
  await viewer.changes('the wheel zooms', 'zoom', () => viewer.wheel(at, -300), (before, after) => after > before);
  await viewer.settled(() => viewer.shiftDrag(at, [30, 10]));
  expect(await viewer.told('look-at-km'), 'dragging with Shift moves').not.toBeNull();
  await viewer.changes('an arrow turns', 'azimuth', () => viewer.key('ArrowRight'), differs);
  await viewer.changes('+ zooms', 'zoom', () => viewer.key('+'), (before, after) => after > before);
  await viewer.changes('P makes a perspective', 'field-of-view', () => viewer.key('p'), (before, after) => before === 0 && after > 0);
  await viewer.changes('T makes a map without perspective', 'field-of-view', () => viewer.key('t'), (before, after) => before > 0 && after === 0);
  const above = await viewer.told('look-at-km');
  await viewer.settled(() => viewer.drag(at, [40, 20]));
  expect(await viewer.told('look-at-km'), 'a drag moves the map').not.toBe(above);
  expect([await viewer.number('tilt'), await viewer.number('azimuth')], 'north stays up').toEqual([0, 180]);
  await viewer.changes('S looks from the south', 'tilt', () => viewer.key('s'), (_, after) => after > 80);
  await viewer.changes('O looks obliquely', 'tilt', () => viewer.key('o'), (_, after) => after > 30 && after < 80);
  const spread = async () => {
    await viewer.touch('touchStart', [[280, 300], [320, 300]]);
    for (const apart of [10, 20, 30]) await viewer.touch('touchMove', [[280 - apart, 300], [320 + apart, 300]]);
    await viewer.touch('touchEnd', []);
  };
  await viewer.changes('two fingers zoom', 'zoom', spread, (before, after) => after > before * 1.5);
  const swipe = async () => {
    await viewer.touch('touchStart', [[300, 300]]);
    for (const on of [10, 20, 30]) await viewer.touch('touchMove', [[300 + on, 300]]);
    await viewer.touch('touchEnd', []);
  };
  await viewer.changes('one finger turns', 'azimuth', swipe, differs);
  await viewer.changes('the compass turns north up', 'azimuth', () => viewer.press('compass'), (before, after) => before !== 180 && after === 180);
});

// The server fits the view. From the first view, a storm covers few pixels of the picture.
test('the button Storms looks at the echo as stormcellar frame does', async ({ viewer, server: { station } }) => {
  await viewer.resize(796, 532);
  await viewer.open(`domain=${station}&moment=REF&least=30`);
  const before = await viewer.number('zoom');
  await viewer.settled(() => viewer.press('open'));
  await viewer.changes('the button zooms to the storms', 'zoom', () => viewer.press('view-fitted'), (_, after) => after > 1.2 * before);
  const fitted = await viewer.told('look-at-km');
  await viewer.settled(() => viewer.key('0'));
  await viewer.settled(() => viewer.key('z'));
  await expect.poll(() => viewer.told('look-at-km'), 'Z fits the view to the storms, too').toBe(fitted);
  await viewer.settled(() => viewer.key('2'));
  await viewer.settled(() => viewer.key('z'));
  expect(await viewer.number('tilt'), 'Z leads from 2D to 3D').toBeGreaterThan(30);
});

// 2026-11-30: the first view showed the whole grid from far away, so that storms were small.
test('the first view suits the storms, and an address with a view stays', async ({ page, viewer, server: { station } }) => {
  await viewer.resize(796, 532);
  await viewer.goto(`domain=${station}&moment=REF`);
  await viewer.drawn();
  const view = async () => Promise.all(['azimuth', 'tilt', 'zoom', 'field-of-view', 'look-at-km', 'exaggeration'].map((name) => viewer.told(name)));
  const first = await view();
  expect(await viewer.number('zoom'), 'nearer than the whole grid').toBeGreaterThan(1.2);
  const fitted = await page.evaluate(async (of) => (await fetch(`/api/v1/grids/${of}/REF/latest/view?width=796&height=532`)).json(), station);
  expect(await viewer.number('tilt')).toBeCloseTo(fitted.camera.tilt_deg, 1);
  expect(await viewer.number('exaggeration')).toBeCloseTo(fitted.exaggeration, 1);
  await expect(viewer.byId('reset-view'), 'Reset view is hidden in the first view').toBeHidden();
  await viewer.settled(() => viewer.drag([250, 300], [40, 0]));
  expect(await view()).not.toEqual(first);
  await viewer.settled(() => viewer.key('0'));
  expect(await view(), 'Reset view leads back to the first view').toEqual(first);
  await viewer.open(`domain=${station}&moment=REF&zoom=3`);
  expect(await viewer.number('zoom'), 'an address with a view').toBe(3);
});

test('a line tells range and azimuth from the radar', async ({ viewer, server: { station } }) => {
  await viewer.resize(796, 532);
  await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
  const says = viewer.byId('tool-says');
  await viewer.key('q');
  await expect(says).toContainText('Point at a place');
  // The radar is in the middle of the picture, and north is up.
  const told = async () => (await says.textContent()).match(new RegExp(`^([\\d.]+) km at (\\d+)° from ${station}$`))?.slice(1).map(Number) ?? [0, 0];
  await viewer.hover([498, 266]);
  await expect(says).toContainText(`from ${station}`);
  const [range, azimuth] = await told();
  expect([89, 90, 91], 'degrees of a place in the east').toContain(azimuth);
  await viewer.click([398, 366]);
  await expect(says).toContainText(/at (179|180|181)° from/);
  const [south] = await told();
  expect(south / range, 'both places are 100 pixels away').toBeCloseTo(1, 1);
  await viewer.keep('bearing');
  await viewer.hover([300, 266]);
  await viewer.frames();
  expect(await told(), 'a click keeps the line').toEqual([south, expect.any(Number)]);
  await viewer.key('Escape');
  await expect(says).toHaveText('');
});

// 2026-11-28: nothing led back from a view without echo, not even choosing the radar again.
test('Reset view leads back to the first view', async ({ page, viewer, server: { station } }) => {
  await viewer.resize(796, 532);
  await viewer.open(`domain=${station}&moment=REF&least=30`);
  const view = async () => Promise.all(['azimuth', 'tilt', 'zoom', 'field-of-view', 'look-at-km', 'exaggeration'].map((name) => viewer.told(name)));
  const first = await view();
  const button = viewer.byId('reset-view');
  await expect(button, 'nothing to reset').toBeHidden();
  const lose = () => viewer.show(`domain=${station}&moment=REF&least=30&azimuth=20&tilt=85&zoom=30&look-at-km=-40,455,-110&exaggeration=1`);
  await lose();
  await viewer.settled(() => button.click());
  expect(await view(), 'after the button').toEqual(first);
  await expect(button).toBeHidden();
  await expect(viewer.byId('picture'), 'keys work').toBeFocused();
  await lose();
  await viewer.settled(() => viewer.key('0'));
  expect(await view(), 'after the key').toEqual(first);
  // The address is right after a reload, too.
  await viewer.settled(() => viewer.drag([250, 300], [40, 0]));
  await viewer.settled(() => viewer.key('0'));
  await page.reload();
  await viewer.drawn();
  expect(await view(), 'after a reload').toEqual(first);
});

test("a click reads the column as the server's own probe does", async ({ page, viewer, server }) => {
  const { station, address } = server;
  await viewer.resize(796, 532);
  await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=1.5&field-of-view=0&least=70`);
  const { path } = await server.grid(station);
  const reading = viewer.byId('reading');
  let read = 0;
  for (const at of [[150, 300], [200, 250], [250, 220], [300, 200], [330, 270], [360, 300], [420, 330]]) {
    await page.evaluate(() => void (document.getElementById('reading').textContent = ''));
    await viewer.click(at);
    await expect(reading).not.toBeEmpty({ timeout: 5000 });
    const text = await reading.innerText();
    const [latitude, longitude] = placeOf(text);
    const { levels } = await (await fetch(`${address}${path}/probe?at=${latitude},${longitude}`)).json();
    const values = levels.filter(({ state }) => state === 'value').map(({ value }) => value);
    const greatest = Math.max(...values);
    const isRight = values.length > 0 ? text.includes(String(greatest)) : /not seen|no echo|range folded/i.test(text);
    if (isRight) ++read;
    else report(`at ${at} the page says ${JSON.stringify(text)}, the server ${greatest}`);
  }
  // Allow some differences, because the page rounds places to three decimals, and a rounded place may be in the next
  // cell.
  expect(read, 'readings of 7 that agree with the server').toBeGreaterThanOrEqual(5);
});
