// Checks overlays: files that the user adds, and the server's. Each overlay must be at its place, and in force at its
// times.
import { expect, test as base } from './fixtures.mjs';
import { decoded } from './pixels.mjs';

const [width, height] = [1000, 640];
const magenta = '#ff00ff';
const meridianM = 111_080; // length of a degree of latitude near 42 degrees north
const line = (places, properties) => ({ type: 'Feature', properties, geometry: { type: 'LineString', coordinates: places } });
const collection = (...features) => ({ type: 'FeatureCollection', features });

const test = base.extend({
  viewport: { width, height },
  // The first two times of the station, the center of its grid, and a view from above with its meters in a pixel.
  scene: async ({ server }, use) => {
    const list = async () => (await server.grids()).filter(({ moment }) => moment === 'REF');
    await expect.poll(async () => (await list()).length, 'volumes').toBe(server.volumes.length);
    const [first, second] = await list();
    const { nx, ny, spacing_m: cell, center } = await (await fetch(`${server.address}${first.path}`)).json();
    const perPixel = 1.04 * Math.max((nx * cell) / width, (ny * cell) / height);
    const view = `domain=${server.station}&moment=REF&azimuth=180&tilt=0&field-of-view=0`;
    await use({ times: [first.time, second.time], center, perPixel, view, at: (time) => `${view}&time=${time}` });
  },
  // A line from west to east half a degree north of the center, in force at the first time, and a point at the center.
  drawn: async ({ scene: { times: [begin, end], center: [latitude, longitude] } }, use) => {
    const ends = [-0.3, 0.3].map((east) => [longitude + east, latitude + 0.5]);
    const point = { type: 'Point', coordinates: [longitude + 0.1, latitude + 0.5] };
    await use(
      collection(
        line(ends, { stroke: magenta, 'stroke-width': 4, begin, end }),
        { type: 'Feature', properties: { name: 'Binghamton' }, geometry: point },
      ),
    );
  },
  looks: ({ page, viewer, scene }, use) => use(new Looks(page, viewer, scene)),
});

class Looks {
  constructor(page, viewer, scene) {
    Object.assign(this, { page, viewer, scene });
  }
  async picture() {
    await this.viewer.frames();
    return decoded(this.page, `data:image/png;base64,${(await this.page.screenshot()).toString('base64')}`);
  }
  // Returns the rows of a picture that are magenta above the center of the grid.
  rows(picture) {
    const isMagenta = ([red, green, blue]) => red > 200 && green < 60 && blue > 200;
    return Array.from({ length: height }, (_, y) => y).filter((y) => isMagenta(picture.at(width / 2, y)));
  }
  // Checks that the line is at its place in a picture from above.
  expectLine(picture) {
    const rows = this.rows(picture);
    const wanted = height / 2 - (0.5 * meridianM) / this.scene.perPixel;
    expect(rows.length, 'rows of the line').toBeGreaterThanOrEqual(3);
    expect(rows.length, 'rows of the line').toBeLessThanOrEqual(6);
    expect(Math.abs((rows[0] + rows.at(-1) + 1) / 2 - wanted), `rows ${rows} about ${wanted}`).toBeLessThan(1.5);
  }
  async drop(name, text) {
    const file = await this.page.evaluateHandle(([name, text]) => {
      const data = new DataTransfer();
      data.items.add(new File([text], name));
      return data;
    }, [name, text]);
    await this.page.dispatchEvent('#picture', 'dragover', { dataTransfer: file });
    await this.page.dispatchEvent('#picture', 'drop', { dataTransfer: file });
  }
  shapes(count) {
    return this.viewer.until((count) => document.documentElement.dataset.shapes === count, String(count));
  }
  row(name) {
    return this.page.locator('.overlays label', { hasText: name });
  }
}

test('a dropped file is drawn at its place while it is in force', async ({ page, viewer, scene, drawn, looks }) => {
  await viewer.open(scene.at(scene.times[0]));
  expect(looks.rows(await looks.picture())).toEqual([]);
  await looks.drop('storm.geojson', JSON.stringify(drawn));
  await looks.shapes(2);
  looks.expectLine(await looks.picture());
  await viewer.keep('overlays-above');
  await viewer.catchLinks();
  const { href } = await viewer.takenBy('save');
  looks.expectLine(await decoded(page, href));
  await expect(viewer.byId('overlays-told')).toHaveText('storm.geojson: 2 of 2 in force');

  await viewer.settled(() => viewer.key('.'));
  await expect(viewer.byId('overlays-told')).toHaveText('storm.geojson: 1 of 2 in force');
  expect(looks.rows(await looks.picture()), 'the line is gone at the second time').toEqual([]);
  await viewer.settled(() => viewer.key(','));
  await viewer.settled(() => viewer.key('2'));
  expect(looks.rows(await looks.picture()).length, 'the line in 2D').toBeGreaterThanOrEqual(3);
  await viewer.settled(() => viewer.key('3'));
  await viewer.settled(() => viewer.key('s'));
  expect(looks.rows(await looks.picture()).length, 'the line in 3D').toBeGreaterThanOrEqual(2);

  // The panel hides the layer and removes it.
  await viewer.press('layers-open');
  await looks.row('storm.geojson').click();
  await looks.shapes(0);
  await looks.row('storm.geojson').click();
  await looks.shapes(2);
  await page.getByRole('button', { name: 'Remove storm.geojson' }).click();
  await looks.shapes(0);
  expect(looks.rows(await looks.picture())).toEqual([]);
  await expect(looks.row('storm.geojson')).toHaveCount(0);
  await expect(viewer.byId('overlays-told')).toBeHidden();
});

test('a damaged file is refused with the place of its damage', async ({ viewer, scene, drawn, looks }) => {
  const says = viewer.byId('overlay-says');
  await viewer.open(scene.at(scene.times[0]));
  await looks.drop('good.geojson', JSON.stringify(drawn));
  await looks.shapes(2);
  await looks.drop('bad.geojson', JSON.stringify(collection(drawn.features[0], line([[0, 0], [0, 95]], {}))));
  await expect(says).toHaveText('bad.geojson is not shown: feature 1: 95, 0 is no place.');
  await expect(says, 'the panel opens').toBeVisible();
  await viewer.keep('overlays-damaged');
  await looks.drop('bad.txt', 'Title: a\nColor: red\n');
  await expect(says).toHaveText("bad.txt is not shown: line 2: 'red' is no color such as 255 0 0.");
  looks.expectLine(await looks.picture());
  // A good file clears the message, and a file of the same name replaces the layer.
  const [latitude, longitude] = scene.center;
  await viewer.page.locator('#overlays input[type="file"]').setInputFiles({
    name: 'good.geojson',
    mimeType: 'text/plain',
    buffer: Buffer.from(`Title: Spotters\nText: ${latitude}, ${longitude}, 1, "A, B"\n`),
  });
  await looks.shapes(1);
  await expect(says).toBeEmpty();
  await expect(looks.row('good.geojson')).toHaveText('good.geojson: 1 of 1 in force');
});

test.describe('an overlay of the server', () => {
  test.use({ provoked: /Failed to load resource/ });

  test('is switched on, kept in the address, and fetched again while live', async ({ page, viewer, scene, drawn, looks }) => {
    let [answer, asked] = [{ ...drawn, left_out: ['old.json: it is no valid JSON'] }, 0];
    await page.route('**/overlays', (route) => route.fulfill({ json: { overlays: [{ name: 'warnings' }, { name: 'gone' }] } }));
    const headers = { 'Stormcellar-Status': '404' };
    await page.route('**/overlays/gone.geojson', (route) => route.fulfill({ status: 404, headers, json: { error: 'none' } }));
    await page.route('**/overlays/warnings.geojson', (route) => {
      ++asked;
      return route.fulfill({ json: answer });
    });
    // Let each minute pass at once when the check says so.
    await page.addInitScript(() => {
      const own = window.setInterval;
      window.minutes = [];
      window.setInterval = (act, ms, ...more) => (ms === 60_000 ? window.minutes.push(act) : own(act, ms, ...more));
    });
    const pass = () => page.evaluate(() => window.minutes.forEach((act) => act()));

    await viewer.open(scene.at(scene.times[0]));
    await viewer.press('layers-open');
    await expect(looks.row('warnings')).toHaveText('warnings');
    await looks.row('warnings').click();
    await looks.shapes(2);
    looks.expectLine(await looks.picture());
    await expect(looks.row('warnings')).toHaveText('warnings: 2 of 2 in force; left out: old.json: it is no valid JSON');
    expect(await viewer.told('overlay')).toBe('warnings');
    await looks.row('gone').click();
    await expect(looks.row('gone')).toHaveText('gone: the server does not have it');
    await looks.row('gone').click();
    await pass();
    await viewer.frames();
    expect(asked, 'a page that is not live does not ask again').toBe(1);

    // The address alone shows the overlay, which follows the server while the page is live.
    await viewer.open(`${scene.view}&overlay=warnings`);
    await expect(viewer.byId('overlays-told')).toHaveText(/^warnings: 1 of 2 in force/);
    answer = collection(...drawn.features, drawn.features[1]);
    await pass();
    await looks.shapes(2);
    await expect(viewer.byId('overlays-told')).toHaveText('warnings: 2 of 3 in force');
    await viewer.press('layers-open');
    await looks.row('warnings').click();
    await looks.shapes(0);
    expect(await viewer.told('overlay')).toBeNull();
  });

  // 2026-11-30: the page judged warnings by the time of the newest volume, so that they came minutes late.
  test('shows what is in force now while the page is live', async ({ page, viewer, server, scene, drawn, looks }) => {
    const newestMs = Date.parse((await server.grid(server.station)).time);
    let nowMs = newestMs + 5 * 60_000;
    const dated = () => ({ Date: new Date(nowMs).toUTCString() });
    await page.route('**/api/v1/events*', (route) => route.fulfill({ headers: { ...dated(), 'Content-Type': 'text/event-stream' }, body: ':\n\n' }));
    await page.route('**/api/v1/stations', async (route) => {
      const response = await route.fetch();
      await route.fulfill({ response, headers: { ...response.headers(), ...dated() } });
    });
    const [one] = drawn.features;
    const from = (ms) => ({ ...one.properties, begin: new Date(newestMs + ms).toISOString(), end: new Date(newestMs + 3_600_000).toISOString() });
    const answer = collection({ ...one, properties: from(4 * 60_000) }, { ...one, properties: from(8 * 60_000) });
    await page.route('**/overlays/warnings.geojson', (route) => route.fulfill({ json: answer }));
    await page.addInitScript(() => {
      const own = window.setInterval;
      window.looks = [];
      window.setInterval = (act, ms, ...more) => (ms === 15_000 ? window.looks.push(act) : own(act, ms, ...more));
    });
    await viewer.open(`${scene.view}&overlay=warnings`);
    await expect(viewer.byId('overlays-told')).toHaveText('warnings: 1 of 2 in force now');
    looks.expectLine(await looks.picture());
    nowMs = newestMs + 9 * 60_000;
    await expect
      .poll(async () => {
        await page.evaluate(() => window.looks.forEach((act) => act()));
        return viewer.text('overlays-told');
      }, { timeout: 60_000 })
      .toBe('warnings: 2 of 2 in force now');
    await viewer.settled(() => viewer.press('earlier'));
    await expect(viewer.byId('overlays-told')).toHaveText('warnings: 0 of 2 in force');
  });
});
