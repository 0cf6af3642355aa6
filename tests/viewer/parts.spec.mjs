// Checks a grid in parts, which is too large for the page's memory. Checks what the page says until all bricks have
// come, and compares its picture with the slicer's. Makes the page lose its WebGL context, and the server evict the
// grid.
import { expect, expectLikeSlicer, report, test } from './fixtures.mjs';
import { viewOf } from './slicer.mjs';

test.use({ viewport: { width: 400, height: 266 } });

const small = [400, 266];
const large = [560, 420]; // a window with room beside the controls
const resting = [[280, 200], [200, 220], [330, 260], [380, 190], [120, 280]];

// Two scenes of a station, and an amount of memory with which its grid is just too large to be loaded as a whole.
const partly = test.extend({
  parts: async ({ server: { address, station } }, use, info) => {
    const packed = await (await fetch(`${address}/api/v1/grids/${station}/REF/latest/packed`)).arrayBuffer();
    const memory = Math.floor((0.98 * packed.byteLength * 10) / 2 ** 20);
    info.skip(memory < 4, `the grid of ${station} has ${packed.byteLength} bytes, too few to be fetched in parts`);
    const scene = { station, moment: 'REF', azimuth: 217, tilt: 60, zoom: 8, field: 40, exaggeration: 3, opacity: 1, at: [-20, 20, 4] };
    const other = { ...scene, at: [30, 30, 4], zoom: 12 };
    await use({ memory, scene, other, view: (one) => `memory=${memory}&quality=512%20slices&${viewOf(one)}` });
  },
});

const complete = (viewer) => viewer.until(() => document.documentElement.dataset.missing === '0');

// Returns a section of 80 km through a place on the plane of the grid.
async function sectionAbout([eastKm, northKm], server) {
  const { path } = await server.grid(server.station);
  const [latitude, longitude] = (await (await fetch(`${server.address}${path}`)).json()).center;
  const at = (x, y) => [latitude + y / 111.1, longitude + x / (111.3 * Math.cos((latitude * Math.PI) / 180))];
  return [...at(eastKm - 35, northKm - 20), ...at(eastKm + 35, northKm + 20)].map((degrees) => degrees.toFixed(4)).join(',');
}

// Returns the number of pixels that are not black, and the number of pixels that differ between two pictures. Some
// pixels differ, because edges of colors may be a pixel aside.
function differing(one, other) {
  let [shown, off] = [0, 0];
  for (let i = one.length % 3; i < one.length; i += 3) {
    if ([0, 1, 2].some((c) => one[i + c] > 0)) ++shown;
    if ([0, 1, 2].some((c) => Math.abs(one[i + c] - other[i + c]) > 12)) ++off;
  }
  return { shown, off };
}

// Returns what the page tells at each place when the pointer rests there.
async function readAt(viewer, places) {
  await viewer.settled(() => viewer.resize(...large));
  const hover = viewer.byId('hover');
  const found = [];
  for (const place of places) {
    await hover.evaluate((one) => void (one.hidden = true));
    await viewer.hover(place);
    await expect(hover).toBeVisible();
    // Wait for beam and error, which come with the facts of the grid. Not every place has them.
    await viewer.until(() => document.getElementById('hover').textContent.includes('RMS'), null, 2000).catch(() => '');
    found.push((await hover.locator('p').allTextContents()).join('\n'));
  }
  await viewer.settled(() => viewer.resize(...small));
  return found;
}

// Returns the reading of a tap at a place, once it has these words.
async function readByTap(viewer, place, words) {
  await viewer.settled(() => viewer.resize(...large));
  await viewer.tap(place);
  const reading = viewer.byId('reading');
  for (const word of ['The column', ...words]) await expect(reading).toContainText(word);
  const text = await reading.innerText();
  await viewer.press('reading-close');
  await viewer.settled(() => viewer.resize(...small));
  return text;
}

test.describe('a grid in parts', { tag: '@full' }, () => {
  partly('is coarse at first, says so, and then agrees with the slicer', async ({ page, viewer, server, parts }) => {
    const { memory, scene, view } = parts;
    let release;
    const released = new Promise((done) => (release = done));
    await page.route(/bricks=/, (route) => released.then(() => route.continue()));
    await viewer.goto(view(scene));
    await viewer.until(() => Number(document.documentElement.dataset.missing) > 0);
    expect(await viewer.data('state')).toContain('coarse');
    release();
    await complete(viewer);
    expect(viewer.asked('half='), 'requests for a halved grid').toBeGreaterThan(0);
    expect(viewer.asked('bricks='), 'requests for bricks').toBeGreaterThan(0);
    expect(await viewer.data('state')).not.toContain('greatest of');
    const many = { behind: ['--slices', '2048'] };
    expectLikeSlicer('bricks that came in parts', await server.slicer.compare(scene, await viewer.pixels(), { name: 'parts', ...many }));
    const [held, most] = (await viewer.data('held')).match(/\d+/g).map(Number);
    expect(held, 'MiB that are held').toBeLessThanOrEqual(most);
    expect(most).toBe(memory);

    await viewer.show(`${view(scene)}&light=gradient`);
    await complete(viewer);
    const sun = ['--sun', `${scene.azimuth + 65},40`];
    expectLikeSlicer('light', await server.slicer.compare(scene, await viewer.pixels(), { name: 'lit-parts', before: sun, ...many }));
  });

  partly('has the layers and readings of the same grid as a whole', async ({ viewer, server, parts }) => {
    const { memory, scene, view } = parts;
    // Look at the surface from straight above. In other views, rays take other steps in a grid in parts, which changes
    // the surface a little.
    const layers = {
      plane: 'height-km=3',
      'column maximum': 'maximum=1',
      section: `section=${await sectionAbout(scene.at, server)}`,
      surface: 'surface=35&tilt=0&field-of-view=0',
      haze: 'haze=1',
    };
    const alone = (layer) => `${layer}&${viewOf(scene)}&volume=0`;
    const plot = () => viewer.byId('section-canvas').evaluate((canvas) => canvas.toDataURL());
    await viewer.open(view(scene));
    await complete(viewer);
    const ofParts = {};
    for (const [name, layer] of Object.entries(layers)) {
      await viewer.show(`memory=${memory}&${alone(layer)}`);
      await complete(viewer);
      ofParts[name] = await viewer.pixels();
    }
    await viewer.show(`memory=${memory}&${alone(layers.section)}`);
    const plotOfParts = await plot();
    const windows = viewer.requests.filter((url) => url.includes('window='));
    expect(windows, 'windows').not.toEqual([]);
    expect(windows.filter((url) => url.includes('half=')), 'windows of a halved grid').toEqual([]);
    await viewer.show(view(scene));
    const readOfParts = await readAt(viewer, resting);
    const ofEcho = readOfParts.filter((text) => /^-?[\d.]+ dBZ at [\d.]+ km\n/.test(text));
    expect(ofEcho.length, `echo under the pointer: ${readOfParts[0]}`).toBeGreaterThan(1);

    await viewer.open(viewOf(parts.other));
    for (const [name, layer] of Object.entries(layers)) {
      await viewer.show(alone(layer));
      const { shown, off } = differing(ofParts[name], await viewer.pixels());
      report(`${name}: ${off} of ${shown} pixels are other than those of the whole grid`);
      expect(shown, `pixels of ${name}`).toBeGreaterThan(3000);
      expect(off, `other pixels of ${name}`).toBeLessThanOrEqual(0.005 * shown);
    }
    await viewer.show(alone(layers.section));
    expect(plotOfParts.length).toBeGreaterThan(3000);
    expect(await plot(), 'the plot of the section').toBe(plotOfParts);
    await viewer.show(viewOf(scene));
    expect(await readAt(viewer, resting), 'readings').toEqual(readOfParts);
  });

  // 2026-11-29: the page did not say that cells were halved, and told the height of another value.
  partly('says that layers of halved cells are read as they are drawn', async ({ viewer, server: { station }, parts }) => {
    await viewer.open(parts.view(parts.scene));
    for (const [layer, pattern] of [
      ['maximum=1', /^-?[\d.]+ dBZ\nmaximum of the column\ngreatest of [248] x [248] cells\n/],
      ['height-km=3', /^-?[\d.]+ dBZ at 3\.0 km\non the plane\ngreatest of [248] x [248] cells\n/],
    ]) {
      await viewer.show(`memory=4&volume=0&tilt=0&field-of-view=0&azimuth=180&domain=${station}&moment=REF&${layer}`);
      const read = await readAt(viewer, [[280, 200], [200, 220], [330, 260], [300, 230], [250, 240], [260, 180]]);
      const values = read.filter((text) => text.includes('dBZ'));
      expect(values, `${layer}, halved`).not.toEqual([]);
      for (const value of values) expect(value, `${layer}, halved`).toMatch(pattern);
    }
  });

  // A finger never rests over the picture, so a tap must read at once. 2026-11-28: a tap read the column of the ground
  // behind the echo. 2026-11-29: a tap told the height of the ground for a maximum, and read a plane behind the volume.
  partly('reads the same for a finger as for a pointer', async ({ viewer, parts: { scene, view } }) => {
    await viewer.open(view(scene));
    await complete(viewer);
    const read = await readAt(viewer, resting);
    const tapped = read.findIndex((text) => /^-?[\d.]+ dBZ at/.test(text));
    expect(await readByTap(viewer, resting[tapped], ['tilt'])).toContain(read[tapped].split('\n')[0]);
    for (const layer of ['maximum=1&volume=0', 'height-km=1']) {
      await viewer.show(`${view(scene)}&${layer}`);
      await complete(viewer);
      const lines = (await readByTap(viewer, resting[tapped], ['dBZ at'])).split('\n');
      const [hover] = (await readAt(viewer, [resting[tapped]]))[0].split('\n');
      expect(lines.find((line) => /dBZ at/.test(line)), `a tap with ${layer}`).toBe(hover);
    }
  });

  // 2026-11-29: with the volume on, a reading beyond the grid never came.
  partly('is read beyond its border, with and without the volume', async ({ viewer, server: { station }, parts }) => {
    const beyond = [];
    await viewer.open(parts.view(parts.scene));
    for (const volume of [0, 1]) {
      await viewer.show(`memory=${parts.memory}&domain=${station}&moment=REF&elevation=0.5&volume=${volume}&tilt=0&field-of-view=0&azimuth=180&zoom=0.5`);
      await complete(viewer);
      const read = await readAt(viewer, [[100, 160], [460, 220], [160, 220], [400, 190]]);
      beyond.push(read.map((text) => text.split('\n').slice(0, 2).join(', ')));
    }
    for (const text of beyond[0]) expect(text).toContain('tilt');
    expect(beyond[1]).toEqual(beyond[0]);
  });

  partly('is drawn again when the graphics processor forgets all', async ({ page, viewer, parts: { scene, view } }) => {
    await viewer.open(view(scene));
    await complete(viewer);
    const fine = await viewer.pixels();
    await page.evaluate(() => {
      const lost = document.getElementById('picture').getContext('webgl2').getExtension('WEBGL_lose_context');
      lost.loseContext();
      delete document.documentElement.dataset.missing;
      setTimeout(() => lost.restoreContext(), 100);
    });
    await complete(viewer);
    expect((await viewer.pixels()).equals(fine), 'the picture is the same').toBe(true);
  });

  test.describe('when answers fail', () => {
    test.use({ provoked: /410|500/ });

    // 2026-11-28: the page said that it was loading, and never asked again.
    partly('asks again for bricks that failed, and tells if the grid was evicted', async ({ page, viewer, parts: { scene, other, view } }) => {
      await viewer.open(view(scene));
      await complete(viewer);
      const fails = (status, error) => (route) =>
        route.fulfill({ status, headers: { 'Stormcellar-Status': String(status) }, body: JSON.stringify({ error }) });
      await page.route(/bricks=/, fails(500, 'there is trouble'), { times: 1 });
      await page.evaluate(() => void delete document.documentElement.dataset.missing);
      await viewer.turnTo(view({ ...scene, at: [20, -30, 4] }));
      await viewer.until(() => Number(document.documentElement.dataset.missing) > 0);
      await complete(viewer);
      // Move the view after the grid was evicted.
      await page.route(/bricks=/, fails(410, 'the grid was evicted from the cache'));
      await viewer.turnTo(view(other));
      await viewer.until(() => document.documentElement.dataset.state.includes('Choose another time'));
    });
  });
});
