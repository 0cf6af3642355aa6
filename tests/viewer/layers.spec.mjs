// Checks layers. Compares flat layers with pictures of `stormcellar frame`, which cuts the same grid, but with code in
// C++. Checks what mouse and keys do to layers.
import { expect, expectLikeSlicer, report, test as base } from './fixtures.mjs';
import { decoded, image } from './pixels.mjs';
import { mostDifference, pictureOf, viewOf } from './slicer.mjs';

const [width, height] = [400, 266];

// Quiet colors of the picture: seen, not seen, hatch and its soft edge, border, and black where nothing is drawn.
const quiet = [[40, 44, 50], [29, 32, 37], [23, 25, 29], [78, 82, 92], [120, 130, 146], [11, 14, 19], [0, 0, 0], [39, 42, 47]];
const isNear = (a, b, most) => a.every((one, c) => Math.abs(one - b[c]) <= most);
const isQuiet = (color) => quiet.some((one) => isNear(color, one, 1));
const isDrawn = (color) => color.some((c) => c > 0);

// Returns the number of pixels that show a value in either picture, and how many of these differ between the pictures.
// Leaves out the outermost pixels, where pictures have a border.
function compared(ours, theirs) {
  let [shown, off] = [0, 0];
  for (let y = 2; y < ours.height - 2; ++y) {
    for (let x = 2; x < ours.width - 2; ++x) {
      const [one, other] = [ours.at(x, y), theirs.at(x, y)];
      if (isQuiet(one) && isQuiet(other)) continue;
      ++shown;
      if (!isNear(one, other, 3)) ++off;
    }
  }
  return { shown, off };
}
function expectSame(what, { shown, off }, mostShare) {
  report(`${what}: ${off} of ${shown} pixels with values differ`);
  expect(shown, `pixels of ${what}`).toBeGreaterThan(300);
  expect(off, `other pixels of ${what}`).toBeLessThanOrEqual(mostShare * shown);
}

// The last station from above. A pixel is exactly a cell of the grid, so that no pixel is between cells.
const test = base.extend({
  viewport: { width, height },
  above: async ({ page, viewer, server }, use) => {
    const { other: station, address } = server;
    const { path } = await server.grid(station);
    const { ny, spacing_m: cell, center } = await (await fetch(`${address}${path}`)).json();
    const { at } = await (await fetch(`${address}${path}/probe?at=${center.join(',')}`)).json();
    const zoom = ((1.04 * ny * cell) / height / cell).toFixed(4);
    const from = 'azimuth=180&tilt=0&field-of-view=0';
    await use({
      station, cell, zoom,
      center: at, // center of a column
      view: `domain=${station}&ground=0&volume=0&${from}&zoom=${zoom}`,
      volume: `domain=${station}&moment=REF&ground=0&${from}&zoom=${zoom}&least=40`,
      pixels: async () => image(await viewer.pixels()),
      framed: (words, w = width, h = height) =>
        pictureOf(page, server.program, [server.volumes.at(-1), ...words, '--no-labels'], w, h, server.directory),
    });
  },
  // A picture of the column maximum from 45 dBZ on, and the middle of this echo in km.
  strong: async ({ viewer, above }, use) => {
    await viewer.open(`${above.view}&moment=REF&maximum=1&least=45`);
    const picture = await above.pixels();
    let [inside, sumX, sumY] = [0, 0, 0];
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        if (isDrawn(picture.at(x, y))) [inside, sumX, sumY] = [inside + 1, sumX + x + 0.5, sumY + y + 0.5];
      }
    }
    const [east, north] = [sumX / inside - width / 2, height / 2 - sumY / inside];
    await use({ picture, inside, eastKm: (east * above.cell) / 1000, northKm: (north * above.cell) / 1000 });
  },
});

test.describe('layers', { tag: '@full' }, () => {
  test('cost nothing when they are off', async ({ viewer, above: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF`);
    await viewer.until(() => document.documentElement.dataset.variants.includes('lines'));
    const variants = (await viewer.data('variants')).split('; ');
    expect(variants).toHaveLength(3);
    for (const name of variants) expect(name).toMatch(/^(volume, perspective|ground, perspective|lines)$/);
  });

  test('from above look as in stormcellar frame', async ({ viewer, above }) => {
    const top = ['--zoom', above.zoom, '--smooth', 'none'];
    await viewer.open(`${above.view}&moment=REF`);
    for (const [what, moment, layer, words] of [
      ['plane', 'REF', 'height-km=3', ['--product', 'cappi', '--height-km', '3', ...top]],
      ['plane', 'VEL', 'height-km=2.25', ['--product', 'cappi', '--height-km', '2.25', '--moment', 'VEL', ...top]],
      ['column maximum', 'REF', 'maximum=1', ['--product', 'composite', ...top]],
    ]) {
      await viewer.show(`${above.view}&moment=${moment}&${layer}`);
      expectSame(`${what} of ${moment}`, compared(await above.pixels(), await above.framed(words)), 0.005);
    }
  });

  // A border between two gates may fall into either of two pixels.
  test('a sweep looks as in stormcellar frame', async ({ viewer, server, above }) => {
    const { station, cell, center } = above;
    const { volumes } = await server.json(`stations/${station}/volumes`);
    const { sweeps } = await server.json(`stations/${station}/volumes/${volumes[0].time}/sweeps`);
    const having = sweeps.filter(({ moments }) => moments.some(({ moment }) => moment === 'REF'));
    const elevations = [...new Set(having.map((one) => one.elevation_deg.toFixed(1)))];
    const extent = ['--center', center.join(','), '--zoom', '1.04', '--extent-km', `${(width * cell) / 1000},${(height * cell) / 1000}`];
    const ofSweep = (elevation) => above.framed(['--product', 'ppi', '--elevation', elevation, ...extent]);
    await viewer.open(`${above.view}&moment=REF&elevation=${elevations[1]}`);
    const sweep = await above.pixels();
    expectSame(`sweep at ${elevations[1]} degrees`, compared(sweep, await ofSweep(elevations[1])), 0.05);
    const lower = compared(sweep, await ofSweep(elevations[0]));
    expect(lower.off, 'pixels that differ from another sweep, which the comparison must find').toBeGreaterThan(0.2 * lower.shown);
  });

  test('a surface is where the greatest value of the column reaches the chosen value', async ({ viewer, above, strong }) => {
    const { inside, picture } = strong;
    await viewer.show(`${above.view}&moment=REF&surface=45`);
    const surface = await above.pixels();
    // A surface of REF over VEL has the shape of REF and the colors of VEL.
    await viewer.show(`${above.view}&moment=VEL&surface=45&surface-moment=REF`);
    const colored = await above.pixels();
    let [missing, more, shape, others] = [0, 0, 0, 0];
    const velocities = new Set();
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const [wants, has, isColored] = [picture, surface, colored].map((one) => isDrawn(one.at(x, y)));
        if (wants && !has) ++missing;
        if (has && !wants) ++more;
        if (has !== isColored) ++others;
        if (isColored) ++shape;
        if (isColored) velocities.add(String(colored.at(x, y)));
      }
    }
    expect(inside, 'pixels where the column maximum reaches 45 dBZ').toBeGreaterThan(30);
    // Allow some missing pixels, because a ray may step over a cell that just reaches the value.
    // 2026-11-29: without perspective, the part of a surface at depths below 0 was missing.
    expect(missing, 'missing pixels').toBeLessThanOrEqual(0.04 * inside);
    expect(more, 'pixels of the surface beyond the echo from 45 dBZ on').toBeLessThanOrEqual(0.005 * inside);
    expect(shape, 'pixels in the colors of VEL').toBeGreaterThan(30);
    expect(others, 'pixels in the colors of VEL beside the surface').toBe(0);
    expect(velocities.size, 'shades of VEL').toBeGreaterThan(10);
    expect(isDrawn(colored.at(0, 0)), 'a corner is drawn').toBe(false);
  });

  test('the plot of a section looks as in stormcellar frame', async ({ page, viewer, above, strong }) => {
    await viewer.settled(() => viewer.resize(796, 532));
    const [latitude, longitude] = above.center;
    const at = (x, y) => [latitude + y / 111, longitude + x / (111 * Math.cos((latitude * Math.PI) / 180))];
    const ends = [...at(strong.eastKm - 40, strong.northKm - 20), ...at(strong.eastKm + 40, strong.northKm + 20)];
    const line = ends.map((degrees) => degrees.toFixed(4)).join(',');
    await viewer.show(`domain=${above.station}&moment=REF&section=${line}&volume=0&tilt=70`);
    const plot = await decoded(page, await viewer.byId('section-canvas').evaluate((canvas) => canvas.toDataURL()));
    const [w, h] = [plot.width - 46, plot.height - 30]; // without the axes
    const drawn = { width: w, height: h, at: (x, y) => plot.at(x + 34, y + 8) };
    expectSame('section', compared(drawn, await above.framed(['--product', 'section', '--section', line], w, h)), 0.01);
    const reading = viewer.byId('section-reading');
    await expect(reading).toHaveText(/^Maximum [\d.]+ dBZ, [\d.]+ km from A, [\d.]+ km above sea level$/);
    await viewer.byId('section-canvas').focus();
    await viewer.key('ArrowLeft');
    await expect(reading, 'an arrow reads the plot').not.toHaveText(/^Maximum/);
  });

  test('light agrees with the slicer if the sun is beside the camera', async ({ viewer, server, above, strong }) => {
    const at = [Math.round(strong.eastKm), Math.round(strong.northKm), 4];
    const scene = { station: above.station, moment: 'REF', azimuth: 180, tilt: 65, zoom: 5, field: 40, exaggeration: 3, opacity: 1, at };
    await viewer.show(`${viewOf(scene)}&light=gradient`);
    const lit = await viewer.pixels();
    expectLikeSlicer('light', await server.slicer.compare(scene, lit, { name: 'lit', before: ['--sun', '245,40'] }));
    const other = await server.slicer.compare(scene, lit, { name: 'lit-elsewhere', before: ['--sun', '90,40'] });
    report(`with the sun elsewhere the difference is ${other.p99}`);
    expect(other.p99, 'the difference with the sun elsewhere').toBeGreaterThan(mostDifference);
  });

  test('a box cuts the volume, solid layers hide what is behind them, and haze is behind the volume', async ({ viewer, above, strong }) => {
    const side = Math.round(width / 2 + (1000 * strong.eastKm) / above.cell); // eastern side of the box
    const shown = async () => {
      const one = await above.pixels();
      let [west, east] = [0, 0];
      for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) if (isDrawn(one.at(x, y))) x < side ? ++west : ++east;
      return { west, east, all: west + east };
    };
    await viewer.show(above.volume);
    const whole = await shown();
    expect(whole.west).toBeGreaterThan(20);
    expect(whole.east).toBeGreaterThan(20);
    await viewer.show(`${above.volume}&crop-km=-300,${((side - width / 2) * above.cell) / 1000},-300,300,0,30`);
    const half = await shown();
    expect([half.west, half.east], 'pixels in a box and beside it').toEqual([whole.west, 0]);
    await viewer.show(`${above.volume}&height-km=1`);
    const both = await shown();
    await viewer.show(`${above.volume}&height-km=1&volume=0`);
    const plane = await shown();
    expect(both.all, 'pixels of a volume before a plane').toBeGreaterThanOrEqual(Math.max(whole.all, plane.all));
    expect(plane.all, 'pixels of the plane alone').toBeLessThan(both.all);
    await viewer.show(`${above.volume}&haze=1`);
    const hazy = await shown();
    expect(hazy.all - whole.all, 'pixels that haze veils').toBeGreaterThan(1000);
  });

  test('keys turn layers on and off', async ({ viewer, above: { station } }) => {
    await viewer.resize(560, 420);
    await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
    await viewer.byId('picture').focus();
    for (const [key, parameter] of [['c', 'height-km'], ['i', 'surface'], ['m', 'maximum'], ['w', 'elevation'], ['b', 'crop-km'], ['g', 'light'], ['n', 'haze'], ['u', 'folded'], ['v', 'volume']]) {
      await viewer.settled(() => viewer.key(key));
      expect(await viewer.told(parameter), `${key.toUpperCase()} switches ${parameter}`).not.toBeNull();
      if (key === 'c') await viewer.changes('] raises the plane', 'height-km', () => viewer.key(']'), (before, after) => after > before);
      await viewer.settled(() => viewer.key(key));
      expect(await viewer.told(parameter), `${key.toUpperCase()} switches ${parameter} back`).toBeNull();
    }
  });

  test('X cuts a section, and drags move the section and its ends', async ({ viewer, server, above: { station } }) => {
    await viewer.resize(560, 420);
    await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
    await viewer.settled(() => viewer.key('x'));
    const first = await viewer.told('section');
    expect(first).not.toBeNull();
    const hint = viewer.byId('tool-says');
    await expect(hint).toHaveText(/^Drag on the ground/);
    await viewer.settled(() => viewer.drag([430, 185], [45, 100]));
    await expect(hint).toHaveText('');
    const second = await viewer.told('section');
    expect(second).not.toBe(first);
    const [latitudeA, longitudeA, latitudeB, longitudeB] = second.split(',').map(Number);
    expect(latitudeA, 'southward').toBeGreaterThan(latitudeB);
    expect(longitudeA, 'eastward').toBeLessThan(longitudeB);
    await viewer.settled(() => viewer.drag([430, 250], [-40, 0]));
    expect(await viewer.told('section'), 'a drag without the tool leaves the section').toBe(second);
    expect(await viewer.told('look-at-km'), 'a drag without the tool moves the map').not.toBeNull();
    await viewer.settled(() => viewer.drag([435, 285], [-20, 20]));
    const third = (await viewer.told('section')).split(',').map(Number);
    expect(third.slice(0, 2), 'A stays').toEqual([latitudeA, longitudeA]);
    expect([third[2] < latitudeB, third[3] < longitudeB], 'without the tool, a drag moves B south and west').toEqual([true, true]);
    await viewer.settled(() => viewer.press('section-radar'));
    const radial = (await viewer.told('section')).split(',').map(Number);
    const { stations } = await server.json(`stations?station=${station}`);
    expect(radial[0], 'A is at the radar').toBeCloseTo(stations[0].latitude_deg, 2);
    expect(radial[1]).toBeCloseTo(stations[0].longitude_deg, 2);
    expect([third.slice(0, 2), third.slice(2)], 'B is an end of the old section').toContainEqual(radial.slice(2));
    await expect(viewer.byId('section-told')).toHaveText(/^From A to B: [\d.]+ km toward \d+°$/);
    await viewer.keep('section-radial');
    const sizeOf = () => viewer.byId('section-canvas').boundingBox();
    const small = await sizeOf();
    await viewer.press('section-larger');
    await viewer.resize(1000, 700);
    await expect.poll(async () => (await sizeOf()).height, 'the enlarged plot').toBeGreaterThan(2 * small.height);
    const { y } = await viewer.byId('section-plot').boundingBox();
    expect(y, 'the plot is below the head').toBeGreaterThan(await viewer.byId('head').evaluate((head) => head.getBoundingClientRect().bottom));
    await viewer.keep('section-large');
    await viewer.press('section-larger');
    await expect.poll(async () => (await sizeOf()).height).toBeLessThan(1.5 * small.height);
    await viewer.resize(560, 420);
    await viewer.changes('A looks at the section', 'tilt', () => viewer.key('a'), (_, after) => after === 80);
  });

  test('the panel sets layers, and fits into a page 360 pixels wide', async ({ page, viewer, above: { station } }) => {
    await viewer.resize(560, 420);
    await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
    await viewer.press('layers-open');
    await viewer.settled(() => viewer.press('layer-plane'));
    await viewer.settled(() => viewer.give('plane-height', 7000, 'input'));
    expect(await viewer.number('height-km')).toBe(7);
    const nameless = await page.locator('#layers input, #layers select').evaluateAll((all) =>
      all.filter((one) => one.labels.length === 0 && !one.getAttribute('aria-label')).map((one) => one.id),
    );
    expect(nameless, 'controls without a name').toEqual([]);
    await viewer.settled(() => viewer.resize(360, 640));
    await viewer.settled(() => viewer.press('layer-crop'));
    for (const side of ['west', 'top']) await expect(viewer.byId(`crop-${side}-value`)).toHaveText(/\d (km|ft|mi)$/);
    const [left, right, beyond] = await viewer.byId('layers').evaluate((panel) => {
      const { left, right } = panel.getBoundingClientRect();
      return [left, right, panel.scrollWidth - panel.clientWidth];
    });
    expect(left).toBeGreaterThanOrEqual(0);
    expect(right).toBeLessThanOrEqual(360);
    expect(beyond, 'pixels to scroll sideways').toBeLessThanOrEqual(0);
  });
});
