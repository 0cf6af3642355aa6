// Checks how a user gets around: on the map of all stations by mouse, keys, fingers and search, with tools, and in a
// flight.
import { expect, report, test as base } from './fixtures.mjs';
import { placeOf } from './pixels.mjs';

// Returns the pixels of the stations on the map, once the map is drawn.
async function places(viewer) {
  await expect(viewer.byId('start')).toBeVisible();
  return viewer.stationsOnMap();
}

const test = base.extend({
  viewport: { width: 700, height: 440 },
  // Opens the map of all stations. Skips the check if there is only one station.
  map: async ({ viewer, server }, use, info) => {
    info.skip(server.stations.length < 2, 'there is one station');
    await viewer.goto();
    await places(viewer);
    await use();
  },
});

const card = (viewer) => viewer.byId('start-card');

test.describe('the map of stations', { tag: '@full' }, () => {
  test('opens by a button if a lone station was opened at once', async ({ viewer, server: { stations } }, info) => {
    info.skip(stations.length > 1, 'there are more stations');
    await viewer.open();
    await expect(viewer.byId('start')).toBeHidden();
    await viewer.press('to-map');
    expect(await places(viewer)).toHaveProperty('size', 1);
  });

  test('opens a station by mouse, and opens again by going back', async ({ page, viewer, server: { station, other, stations }, map }) => {
    const [x, y] = (await places(viewer)).get(station);
    const [ox, oy] = (await places(viewer)).get(other);
    expect(Math.hypot(x - ox, y - oy), 'pixels between stations').toBeGreaterThan(20);
    await expect(viewer.byId('found')).toContainText(station);
    await viewer.hover([x + 3, y + 2]);
    await expect(card(viewer), 'the card of the station under the pointer').toContainText(new RegExp(`^${station}[^]*REF`));
    await viewer.keep('map');
    await viewer.settled(() => viewer.click([x + 3, y + 2]));
    await expect(viewer.byId('start')).toBeHidden();
    expect(await viewer.told('domain')).toBe(station);
    await page.goBack({ waitUntil: 'commit' });
    expect((await places(viewer)).size, 'stations after going back').toBeGreaterThanOrEqual(stations.length);
  });

  test('explains the colors of its echo', async ({ viewer, map }) => {
    const legend = viewer.byId('start-legend');
    await expect(legend).toContainText(/Reflectivity -?\d+\d+ dBZ.*not seen.*Newest echo of each radar/s);
    await expect(legend.locator('.unseen')).toBeInViewport();
    const colors = await legend.locator('canvas').evaluate((bar) => {
      const { data } = bar.getContext('2d').getImageData(0, 0, bar.width, 1);
      return new Set(new Uint32Array(data.buffer)).size;
    });
    expect(colors, 'colors of the bar').toBeGreaterThan(8);
  });

  test('moves and zooms', async ({ viewer, server: { station }, map }) => {
    const [x, y] = (await places(viewer)).get(station);
    await viewer.drag([500, 300], [30, 20]);
    const moved = `${station} ${x + 30} ${y + 20}`;
    await viewer.until((place) => document.documentElement.dataset.map.includes(place), moved);
    await viewer.wheel([500, 300], -300);
    await viewer.until((place) => !document.documentElement.dataset.map.includes(place), moved);
    await expect(viewer.byId('start')).toBeVisible();
  });

  test('finds a station by words', async ({ page, viewer, server: { station, other }, map }) => {
    await viewer.byId('search').focus();
    await page.keyboard.type(other.toLowerCase());
    await expect(viewer.byId('found')).toContainText(new RegExp(`^${other}`));
    await expect(viewer.byId('found')).not.toContainText(station);
    await viewer.settled(() => viewer.key('Enter'));
    expect(await viewer.told('domain')).toBe(other);
  });

  test('chooses stations by arrows', async ({ viewer, server: { stations }, map }) => {
    await viewer.press('start-all');
    await viewer.byId('map').focus();
    const chosen = async () => (await card(viewer).innerText()).slice(0, 4);
    await viewer.key('ArrowRight');
    await expect(card(viewer)).not.toBeEmpty();
    expect(stations).toContain(await chosen());
    for (const way of ['ArrowLeft', 'ArrowDown', 'ArrowRight', 'ArrowUp']) await viewer.key(way);
    const last = await chosen();
    await viewer.settled(() => viewer.key('Enter'));
    expect(await viewer.told('domain')).toBe(last);
  });

  test('opens a station by a touch', async ({ viewer, server: { station }, map }) => {
    await viewer.press('start-all');
    await viewer.frames();
    const at = (await places(viewer)).get(station);
    await viewer.settled(() => viewer.tap(at));
    expect(await viewer.told('domain')).toBe(station);
  });

  // 2026-11-28: there was no land outside of the first view.
  test('asks for the land of the whole earth once', async ({ viewer, map }) => {
    const isWide = (url) => Number(new URL(url).searchParams.get('east')) - Number(new URL(url).searchParams.get('west')) > 359;
    const ofEarth = () => viewer.requests.filter((url) => url.includes('/api/v1/map?') && isWide(url)).length;
    const came = viewer.page.waitForEvent('requestfinished', (request) => request.url().includes('/api/v1/map?') && isWide(request.url()));
    for (let times = 0; times < 10; ++times) await viewer.key('-');
    await came;
    // Draw again. The page would then ask again if it did not keep the land.
    await viewer.frames();
    expect(ofEarth()).toBe(1);
    await viewer.keep('earth');
  });
});

test.describe('around a station', { tag: '@full' }, () => {
  // Look straight down, so that a pixel shows one column.
  test.beforeEach(async ({ viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=40`);
  });

  test('the pointer reads the most visible cell', async ({ viewer, server }) => {
    const { path } = await server.grid(server.station);
    const exaggeration = 5;
    const { tables, usual } = await server.json('tables');
    const { extinction } = tables.find(({ name }) => name === usual.REF);
    const perKm = (value) => {
      const high = extinction.findIndex((one) => value < one.value);
      if (high < 0) return extinction[extinction.length - 1].per_km;
      const [a, b] = [extinction[high - 1], extinction[high]];
      return a.per_km + ((value - a.value) / (b.value - a.value)) * (b.per_km - a.per_km);
    };
    // Returns the cell of a column that is most visible from above.
    const seenMost = (levels) => {
      let [seen, most, through] = [null, 0, 1];
      for (let z = levels.length - 1; z >= 0; --z) {
        const { state, value, height_m: at } = levels[z];
        if (state !== 'value' || value < 40) continue;
        const above = levels[z + 1]?.height_m ?? 2 * at - levels[z - 1].height_m;
        const below = levels[z - 1]?.height_m ?? 2 * at - levels[z + 1].height_m;
        const share = through * -Math.expm1(-perKm(value) * exaggeration * ((above - below) / 2000));
        through -= share;
        if (share > most) [seen, most] = [levels[z], share];
      }
      return seen;
    };
    const [hover, reading] = [viewer.byId('hover'), viewer.byId('reading')];
    let told = 0;
    for (const at of [[300, 200], [270, 190], [330, 220], [350, 240], [400, 180], [250, 230]]) {
      await hover.evaluate((one) => void (one.hidden = true));
      await viewer.hover(at);
      await expect(hover).toBeVisible();
      const hovered = await hover.innerText();
      await viewer.click(at);
      await expect(reading).not.toBeEmpty();
      const text = await reading.innerText();
      await viewer.key('Escape'); // the reading covers a part of the picture
      const { levels } = await (await fetch(`${server.address}${path}/probe?at=${placeOf(text).join(',')}`)).json();
      const seen = seenMost(levels);
      if (seen ? hovered.startsWith(`${seen.value} dBZ at`) : /^(Lowest level|below the shown range|too faint)/.test(hovered)) ++told;
      else report(`at ${at} the page says ${JSON.stringify(hovered)}, the server ${JSON.stringify(seen)}`);
    }
    // Allow some differences, because the reading rounds places to three decimals, and a rounded place may be in the
    // next cell.
    expect(told, 'pixels of 6 that tell the cell').toBeGreaterThanOrEqual(4);
  });

  test('tools measure distance and area', async ({ viewer }) => {
    const says = viewer.byId('tool-says');
    await viewer.key('d');
    await viewer.click([250, 200]);
    await viewer.click([350, 200]);
    const distance = await says.innerText();
    expect(distance, 'eastward, along the ground').toMatch(/^\d+(\.\d+)? km toward (89|90|91)°$/);
    await viewer.keep('distance');
    await viewer.key('r');
    for (const corner of [[250, 200], [350, 200], [350, 300], [250, 300]]) await viewer.click(corner);
    const area = parseFloat(await says.innerText());
    expect(Math.abs(area / parseFloat(distance) ** 2 - 1), `a square of ${distance} has ${area}`).toBeLessThan(0.02);
    await viewer.key('Escape');
    await expect(says, 'Escape ends a tool').toHaveText('');
  });

  // 2026-11-28: in perspective, a distance was that between the tops of storms, 27.9 instead of 28.1 km.
  test('a distance is along the ground, also below echo', async ({ viewer, server: { station } }) => {
    const view = `domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=4&field-of-view=40&look-at-km=0,0,4`;
    const distances = [];
    for (const volume of ['', '&volume=0']) {
      await viewer.show(view + volume);
      await viewer.key('d');
      await viewer.click([200, 250]);
      await viewer.click([420, 200]);
      distances.push(await viewer.byId('tool-says').innerText());
      await viewer.key('Escape');
    }
    expect(distances[0]).toMatch(/^\d+(\.\d+)? km toward \d+°$/);
    expect(distances[0], 'echo changes no distance').toBe(distances[1]);
  });

  // 2026-11-28: names of places behind a surface were drawn over it.
  test('a surface hides the names of places behind it', async ({ page, viewer, server: { station } }) => {
    await page.evaluate(() => {
      const own = CanvasRenderingContext2D.prototype.fillText;
      window.written = {};
      CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
        const { a } = this.getTransform();
        if (this.canvas.id === 'labels' && /^[A-Z][a-z]/.test(text)) window.written[text] = [(x * a) / devicePixelRatio - 7, (y * a) / devicePixelRatio];
        own.call(this, text, x, y);
      };
    });
    const view = `domain=${station}&moment=REF&azimuth=200&tilt=70&zoom=1.5&field-of-view=40&look-at-km=0,0,4&volume=0`;
    const names = {};
    for (const surface of ['', '&surface=20']) {
      await page.evaluate(() => void (window.written = {}));
      await viewer.show(view + surface);
      names[surface] = await page.evaluate(() => window.written);
    }
    let [hidden, off] = [0, 0];
    for (const [name, at] of Object.entries(names[''])) {
      await viewer.byId('hover').evaluate((one) => void (one.hidden = true));
      await viewer.hover(at.map(Math.round));
      await expect(viewer.byId('hover')).toBeVisible();
      const isBehind = /surface/.test(await viewer.byId('hover').innerText());
      if (isBehind) ++hidden;
      if (isBehind === Object.hasOwn(names['&surface=20'], name)) ++off;
    }
    report(`of ${Object.keys(names['']).length} names ${hidden} are behind the surface; ${off} are not as they should be`);
    expect(hidden, 'names behind the surface').toBeGreaterThan(0);
    expect(Object.keys(names['&surface=20']).length, 'names that remain').toBeGreaterThan(1);
    expect(off, 'names that are drawn though hidden, or the other way round').toBeLessThanOrEqual(1);
  });

  test('the raw volume has a link', async ({ page, viewer, server: { station } }) => {
    await viewer.press('raw');
    const raw = await page.locator('#tool-says a').evaluate((link) => link.href);
    expect(raw).toContain(`/volumes/${station}/`);
    const { headers } = await fetch(raw, { method: 'HEAD' });
    expect(Number(headers.get('content-length')), 'bytes').toBeGreaterThan(1e5);
  });

  test('a flight moves, turns and ends', async ({ page, viewer, server: { station } }) => {
    await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=60&zoom=4&field-of-view=0&least=70`);
    await viewer.settled(() => viewer.key('f'));
    expect([await viewer.number('field-of-view'), await viewer.number('zoom')], 'perspective').toEqual([60, 1]);
    const place = async () => (await viewer.told('look-at-km')).split(',').map(Number);
    const from = await place();
    await page.keyboard.down('w');
    await expect.poll(async () => (await place())[1] - from[1], 'W flies northward').toBeGreaterThan(0.05);
    await page.keyboard.up('w');
    await viewer.drawn();
    const [east, north] = (await place()).map((km, i) => km - from[i]);
    expect(north, 'km northward').toBeGreaterThan(0.05);
    expect(Math.abs(east), 'km aside').toBeLessThan(0.01);
    await viewer.changes('a drag looks around', 'azimuth', () => viewer.drag([350, 200], [50, 0]), (was, is) => Math.abs(is - was - 10) < 0.5);
    // 2026-11-28: after a flight, a drag turned the view about a place far beyond the grid.
    await viewer.settled(() => viewer.key('Escape'));
    const landed = await viewer.told('look-at-km');
    const [x, y, z] = await place();
    expect(Math.max(Math.abs(x), Math.abs(y)), 'km from the radar').toBeLessThanOrEqual(230);
    expect(z, 'on the ground').toBeCloseTo(0, 1);
    await viewer.key('q');
    expect(await viewer.told('look-at-km'), 'Escape lands').toBe(landed);
  });
});
