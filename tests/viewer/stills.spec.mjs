// Checks what the page shows while its picture is loading, and in a browser without WebGL 2, for which the server draws
// still pictures.
import { expect, test } from './fixtures.mjs';

test.use({ viewport: { width: 1000, height: 700 } });

async function open(viewer, view = '') {
  await viewer.page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...more);
    };
  });
  await viewer.goto(view);
  await viewer.drawn();
}
// Waits until the picture has loaded, and returns its size and number of colors.
const pictureOf = async (viewer) => {
  await viewer.until(() => document.getElementById('still')?.complete && document.documentElement.dataset.state === '');
  return viewer.page.evaluate(() => {
    const picture = document.getElementById('still');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [picture.naturalWidth, picture.naturalHeight];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    const colors = new Set();
    for (let i = 0; i < data.length; i += 4) colors.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    return { width: copy.width, height: copy.height, colors: colors.size };
  });
};

test('without WebGL, the page shows the picture of the server and says why', async ({ viewer, server: { station, other } }) => {
  await open(viewer, `domain=${station}`);
  await expect(viewer.byId('notice')).toContainText('no WebGL 2, so the server draws still pictures');
  const first = await pictureOf(viewer);
  expect(first.width).toBe(1000);
  expect(first.colors, 'colors').toBeGreaterThan(200);
  await expect(viewer.byId('title')).toContainText(station);
  await expect(viewer.byId('still')).toHaveAttribute('alt', /Reflectivity.*3D/);
  await viewer.keep('stills');
  // Another moment, another kind, another radar.
  await viewer.byId('moment-VEL').click();
  await viewer.until(() => document.documentElement.dataset.drawn?.includes('/VEL/'));
  expect(await viewer.told('moment')).toBe('VEL');
  await expect(viewer.byId('moment-VEL')).toHaveAttribute('aria-pressed', 'true');
  await viewer.byId('still-kind').selectOption('tilt');
  await expect(viewer.byId('still')).toHaveAttribute('alt', /velocity.*Lowest tilt/i);
  const tilt = await pictureOf(viewer);
  expect(tilt.colors).toBeGreaterThan(20);
  await viewer.byId('domain').selectOption(other);
  await viewer.until((other) => document.documentElement.dataset.drawn?.startsWith(other), other);
  // On a phone everything is within the page.
  await viewer.resize(390, 800);
  await pictureOf(viewer);
  const right = await viewer.page.locator('main button, main select, #still').evaluateAll((all) =>
    Math.max(...all.filter((one) => one.checkVisibility()).map((one) => one.getBoundingClientRect().right)),
  );
  expect(right).toBeLessThanOrEqual(390);
  await viewer.keep('stills-390');
});

test('@sequence buttons and keys go to the volume before and after', async ({ viewer, server }) => {
  const { station } = server;
  const times = async () => (await server.grids()).filter(({ moment }) => moment === 'REF').map(({ time }) => time);
  await expect.poll(async () => (await times()).length).toBe(server.volumes.length);
  const all = await times();
  await open(viewer, `domain=${station}&moment=REF`);
  const isShown = (index) => viewer.until((time) => document.documentElement.dataset.drawn?.endsWith(time), all.at(index));
  await isShown(-1);
  await expect(viewer.byId('follow')).toHaveAttribute('aria-pressed', 'true');
  await expect(viewer.byId('later')).toBeDisabled();
  await viewer.byId('earlier').click();
  await isShown(-2);
  expect(await viewer.told('time')).toBe(all.at(-2));
  await viewer.key(',');
  await isShown(-3);
  await viewer.byId('follow').click();
  await isShown(-1);
  await open(viewer, `domain=${station}&moment=REF&time=${all[0]}`);
  await isShown(0);
  await expect(viewer.byId('earlier')).toBeDisabled();
});

test('while the grid is loading, the page shows the map', async ({ page, viewer, server: { station } }) => {
  let release;
  const isReleased = new Promise((done) => (release = done));
  await page.route(/\/packed/, async (route) => {
    await isReleased;
    await route.continue();
  });
  await viewer.goto(`domain=${station}&moment=REF`);
  await viewer.until(() => document.documentElement.dataset.skeleton);
  await expect(viewer.byId('title')).toHaveText(`${station}  Reflectivity  loading …`);
  const lit = await page.evaluate(() => {
    const canvas = document.getElementById('labels');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((alpha, i) => i % 4 === 3 && alpha > 0).length;
  });
  expect(lit, 'pixels of lines').toBeGreaterThan(2000);
  await viewer.keep('skeleton');
  release();
  await viewer.drawn();
  await expect(viewer.byId('title')).not.toContainText('loading');
});
