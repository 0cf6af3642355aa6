// Checks that a stranger sees what a forecaster needs, without a panel: in a large window and on a phone.
import { expect, test } from './fixtures.mjs';

// Returns why a control cannot be used: nothing is in its middle, or something else is. Runs in the page.
function covered(id) {
  const one = document.getElementById(id);
  if (!one?.checkVisibility()) return 'it is not visible';
  const { left, top, width, height } = one.getBoundingClientRect();
  const [x, y] = [left + width / 2, top + height / 2];
  if (x < 0 || y < 0 || x > innerWidth || y > innerHeight) return 'it is beyond the window';
  const there = document.elementFromPoint(x, y);
  return one.contains(there) ? '' : `${there?.id || there?.tagName} covers it`;
}
const expectSeen = async (viewer, id) => expect(await viewer.page.evaluate(covered, id), id).toBe('');

for (const [width, height] of [[390, 844], [1440, 900]])
  test.describe(`at ${width} x ${height}`, () => {
    test.use({ viewport: { width, height }, timezoneId: 'America/Chicago' });

    test('a stranger sees what there is', async ({ page, viewer, server: { other: station } }) => {
      await viewer.goto(`domain=${station}&moment=REF`);
      await viewer.drawn();
      await viewer.until(() => document.documentElement.dataset.panels);
      // The station's name, what is shown, when, also in local time, and its age or date.
      const title = viewer.byId('title');
      await expect(title).toContainText(new RegExp(`^${station}  [A-Z][a-z]+.*  \\d{4}-\\d\\d-\\d\\d \\d\\d:\\d\\d:\\d\\d UTC \\(.*C[DS]T\\)  Reflectivity`));
      await expectSeen(viewer, 'title');
      for (const id of ['mode-2d', 'play', 'speed', 'times', 'clock', 'follow', 'compass', 'scan-open', 'layers-open']) await expectSeen(viewer, id);
      await expect(viewer.byId('follow')).toHaveText(/Newest|Live|silent/);
      if (width < 640)
        for (const id of ['play', 'earlier', 'later', 'follow', 'open', 'layers-open', 'mode-2d'])
          expect((await viewer.byId(id).boundingBox()).height, `height of ${id}`).toBeGreaterThanOrEqual(44);
      const [play, speed] = await Promise.all(['play', 'speed'].map((id) => viewer.byId(id).boundingBox()));
      expect(speed.x - play.x - play.width, 'pixels between Play and its speed').toBeLessThan(12);
      // Moments have their names as tooltips, and the title names the shown one.
      for (const moment of await page.locator('#moments button').all()) await expect(moment).toHaveAttribute('title', /^[A-Z][a-z]{3,}/);
      // The table of moments and keys, which a phone needs, because it shows no tooltips.
      await expectSeen(viewer, 'keys-open');
      await viewer.byId('keys-open').click();
      await expect(viewer.byId('reading').locator('.keys')).toContainText('higher, lower tilt');
      for (const [moment, name] of [['ZDR', 'Differential reflectivity'], ['CFP', 'Clutter filter power removed']])
        if ((await viewer.byId(`moment-${moment}`).count()) > 0)
          await expect(viewer.byId('reading').getByRole('row', { name: `${moment} ${name}` })).toBeInViewport();
      await viewer.keep(`glance-keys-${width}`);
      await viewer.key('Escape');
      await expect(viewer.byId('reading')).toBeHidden();
      // A click marks its place, and tells it in words.
      const at = [Math.round(width / 2), Math.round(height / 2)];
      const marked = () => page.evaluate(([x, y]) => {
        const canvas = document.getElementById('labels');
        const { data } = canvas.getContext('2d').getImageData(x - 12, y - 12, 24, 24);
        return data.filter((alpha, i) => i % 4 === 3 && alpha > 200).length;
      }, at);
      const before = await marked();
      await viewer.click(at);
      await expect(viewer.byId('reading')).toContainText(/[NS], .*[EW]/);
      await viewer.frames();
      expect(await marked(), 'pixels of the mark').toBeGreaterThan(before);
      await viewer.keep(`glance-read-${width}`);
      await viewer.key('Escape');
      // North and the way back.
      await viewer.settled(() => viewer.drag([width / 2, height / 2], [60, 10]));
      await expectSeen(viewer, 'reset-view');
      await expect(viewer.byId('reset-view')).toHaveText('Reset view');
      const turned = await viewer.told('azimuth');
      await viewer.settled(() => viewer.press('reset-view'));
      expect(await viewer.told('azimuth')).not.toBe(turned);
      await viewer.keep(`glance-${width}`);
      // One press leads to a plain tilt with its angle, and buttons for the next one.
      const tap = async (id) => {
        const { x, y, width, height } = await viewer.byId(id).boundingBox();
        await page.touchscreen.tap(x + width / 2, y + height / 2);
      };
      await viewer.settled(() => tap('mode-2d'));
      for (const id of ['tilt', 'tilt-lower', 'tilt-higher']) await expectSeen(viewer, id);
      const lowest = await viewer.text('layers-told');
      await viewer.settled(() => tap('tilt-higher'));
      expect(await viewer.text('layers-told'), 'a tap leads to the next tilt').not.toBe(lowest);
      await viewer.settled(() => tap('tilt-lower'));
      await expect(viewer.byId('layers-told')).toContainText(/\d\.\d°/);
      await viewer.keep(`glance-flat-${width}`);
    });

    test('velocity says which way is toward the radar', async ({ page, viewer, server: { other: station } }) => {
      // Count the texts on the canvas of the bar.
      await page.addInitScript(() => {
        window.written = [];
        const { fillText } = CanvasRenderingContext2D.prototype;
        CanvasRenderingContext2D.prototype.fillText = function (text, ...more) {
          if (this.canvas.id === 'bar') window.written.push(text);
          return fillText.call(this, text, ...more);
        };
      });
      await viewer.open(`domain=${station}&moment=VEL&zoom=0.3`);
      const written = await page.evaluate(() => window.written);
      expect(written).toEqual(expect.arrayContaining(['m/s', 'away ▲', 'toward ▼']));
      expect(await viewer.text('title')).toContain('Radial velocity');
      await viewer.keep(`glance-velocity-${width}`);
      await viewer.show(`domain=${station}&moment=REF&zoom=0.3`);
      expect((await page.evaluate(() => window.written)).slice(written.length)).not.toContain('toward ▼');
    });

    test('B begins to draw its box, as X does its section', async ({ viewer, server: { other: station } }) => {
      await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=0.8&field-of-view=0&least=60`);
      for (const [key, parameter] of [['x', 'section'], ['b', 'crop-km']]) {
        await viewer.settled(() => viewer.key(key));
        await expect(viewer.byId('tool-says')).toContainText(/^Drag on the ground/);
        await expectSeen(viewer, 'tool-says');
        const before = await viewer.told(parameter);
        await viewer.settled(() => viewer.drag([width / 2 - 60, height / 2 - 40], [110, 70]));
        expect(await viewer.told(parameter), `${key} and a drag`).not.toBe(before);
        await viewer.settled(() => viewer.key(key));
      }
    });
  });
