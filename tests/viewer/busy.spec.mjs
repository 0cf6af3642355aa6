// Checks that the page never freezes: a fine picture is drawn in parts, between which the page acts, and input gives
// the picture up.
import { test as base, expect } from './fixtures.mjs';

const test = base.extend({
  // A page whose graphics processor ends no part of a picture while `isHeld` is true.
  page: async ({ page }, use) => {
    await page.addInitScript(() => {
      const { clientWaitSync, TIMEOUT_EXPIRED } = WebGL2RenderingContext.prototype;
      WebGL2RenderingContext.prototype.clientWaitSync = function (...all) {
        return window.isHeld ? TIMEOUT_EXPIRED : clientWaitSync.apply(this, all);
      };
      const { scissor } = WebGL2RenderingContext.prototype;
      window.strips = 0;
      WebGL2RenderingContext.prototype.scissor = function (...all) {
        ++window.strips;
        return scissor.apply(this, all);
      };
      // The rungs of all pictures, in their order.
      window.rungs = [];
      new MutationObserver(() => window.rungs.push(document.documentElement.dataset.rung)).observe(document, {
        attributeFilter: ['data-frames'],
        subtree: true,
      });
    });
    await use(page);
  },
});

const hold = ({ page }, isHeld) => page.evaluate((isHeld) => void (window.isHeld = isHeld), isHeld);
const rungs = ({ page }) => page.evaluate(() => window.rungs);
// Begins a fine picture that does not end.
async function begin(viewer) {
  await hold(viewer, true);
  await viewer.page.evaluate(() => (window.rungs = []));
  await viewer.resize(1000, 700);
  await viewer.frames();
}

test.describe('while a fine picture is drawn', () => {
  test.beforeEach(async ({ viewer, server }) => {
    await viewer.open(`domain=${server.station}&tilt=40&zoom=6`);
    expect(await viewer.data('rung')).toBe('256 slices');
    await begin(viewer);
  });

  test('the page acts', async ({ viewer }) => {
    await viewer.byId('open').click();
    await expect(viewer.byId('settings')).toBeVisible();
    expect(await viewer.data('drawn'), 'the picture is not complete').toBeUndefined();
    expect(await rungs(viewer)).toEqual([]);
    await viewer.page.evaluate(() => (window.strips = 0));
    await hold(viewer, false);
    await viewer.drawn();
    expect(await viewer.page.evaluate(() => window.strips), 'strips').toBeGreaterThan(2);
    expect(new Set(await rungs(viewer))).toEqual(new Set(['256 slices']));
  });

  test('a drag gives it up, and a fast picture follows', async ({ viewer }) => {
    const { x, y, width, height } = await viewer.byId('picture').boundingBox();
    await viewer.page.mouse.move(x + width / 2, y + height / 2);
    await viewer.page.mouse.down();
    await viewer.page.mouse.move(x + width / 2 + 40, y + height / 2);
    await viewer.page.mouse.up();
    await hold(viewer, false);
    await viewer.drawn();
    const drawn = await rungs(viewer);
    expect(drawn[0], 'a picture of a moving view').not.toBe('256 slices');
    expect(drawn.at(-1)).toBe('256 slices');
    expect(drawn.filter((rung) => rung === '256 slices')).toHaveLength(1);
  });
});

test('a change of layers gives a fine picture up', async ({ viewer, server }) => {
  await viewer.open(`domain=${server.station}&tilt=40&zoom=6`);
  await begin(viewer);
  await viewer.key('v');
  await hold(viewer, false);
  await viewer.drawn();
  expect((await rungs(viewer)).filter((rung) => rung === '256 slices')).toHaveLength(1);
});

test('a picture in strips is the picture that is drawn at once', async ({ viewer, server, page }) => {
  const view = `domain=${server.station}&tilt=40&zoom=2`;
  await viewer.open(view);
  const strips = await viewer.pixels();
  // A page that does not know that the processor draws takes the first picture for fast, and draws it at once.
  await page.addInitScript(() => {
    const { getParameter } = WebGL2RenderingContext.prototype;
    WebGL2RenderingContext.prototype.getParameter = function (name) {
      const value = getParameter.call(this, name);
      return typeof value === 'string' ? value.replace(/swiftshader/gi, '') : value;
    };
  });
  await viewer.open(view);
  expect(await viewer.pixels()).toEqual(strips);
});
