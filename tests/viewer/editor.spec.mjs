// Checks the editor of colors: what mouse, fingers and keys do, and that `stormcellar frame` draws the same picture
// with the saved files.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { expect, expectLikeSlicer, test as base } from './fixtures.mjs';
import { mostDifference, viewOf } from './slicer.mjs';

const [colorsPart, opacityPart] = [6, 7];
// A zoom at which pictures are drawn quickly.
const far = 0.2;
const handle = (kind) => `#editor .handle.${kind}`;

class Editor {
  constructor(viewer, { station, slicer, directory }) {
    const scene = { station, moment: 'REF', azimuth: 180, tilt: 60, zoom: 2, field: 40, exaggeration: 3, opacity: 1, at: [0, 0, 4] };
    Object.assign(this, { viewer, page: viewer.page, slicer, directory, scene, view: viewOf({ ...scene, zoom: far }) });
    this.says = viewer.byId('editor-says');
  }
  async open() {
    await this.viewer.byId('picture').focus();
    await this.viewer.key('e');
    await expect(this.viewer.byId('editor')).toBeVisible();
  }
  table() {
    return this.viewer.told('table');
  }
  async points(part) {
    return (await this.table()).split('!')[part].split('_').map((point) => point.split('~'));
  }
  async center(selector) {
    const { x, y, width, height } = await this.page.locator(selector).boundingBox();
    return [x + width / 2, y + height / 2];
  }
  focused() {
    return this.page.evaluate(() => document.activeElement.getAttribute('aria-label'));
  }
  focus(kind) {
    return this.page.locator(handle(kind)).focus();
  }
  press(id) {
    return this.viewer.settled(() => this.viewer.press(id));
  }
  // Carries out an act that saves a file, and returns the path of the file.
  async saved(act) {
    const [download] = await Promise.all([this.page.waitForEvent('download'), act()]);
    const path = join(this.directory, download.suggestedFilename());
    await download.saveAs(path);
    return path;
  }
  // Gives the page a file as if the user had chosen it.
  async choose(name, text) {
    await this.says.evaluate((one) => void (one.textContent = ''));
    await this.viewer.byId('editor-file').setInputFiles({ name, mimeType: 'text/plain', buffer: Buffer.from(text) });
    await expect(this.says).not.toBeEmpty();
  }
  async lookFrom(zoom) {
    await this.viewer.settled(() => this.viewer.turnTo(this.page.url().split('#')[1].replace(/zoom=[^&]*/, `zoom=${zoom}`)));
  }
  // Returns the picture of the page, and its difference from the slicer's picture with a file of colors.
  async compare(name, file) {
    await this.lookFrom(this.scene.zoom);
    await this.viewer.resize(400, 266);
    await this.viewer.until(() => document.getElementById('picture').clientWidth === 400);
    // Draw twice, because the first picture may have begun before the change.
    for (let times = 0; times < 2; ++times) {
      await this.viewer.settled(() => this.page.evaluate(() => void dispatchEvent(new Event('resize'))));
    }
    const pixels = await this.viewer.pixels();
    const difference = await this.slicer.compare(this.scene, pixels, { name, behind: ['--colors', file] });
    await this.viewer.resize(640, 480);
    await this.lookFrom(far);
    return { pixels, difference };
  }
  async expectSame(what, file) {
    const { pixels, difference } = await this.compare(`colors-${what.replace(/\W+/g, '-')}`, file);
    expectLikeSlicer(what, difference);
    return pixels;
  }
}

const test = base.extend({
  viewport: { width: 640, height: 480 },
  // The editor, already open.
  editor: async ({ viewer, server }, use) => {
    const editor = new Editor(viewer, server);
    await viewer.open(editor.view);
    await expect(viewer.byId('editor'), 'no editor is there before it is opened').toHaveCount(0);
    await editor.open();
    await use(editor);
  },
});

test.describe('the editor of colors', { tag: '@full' }, () => {
  test('takes the keyboard, and edits nothing until the user edits', async ({ editor }) => {
    expect(await editor.focused()).toBe('Table');
    expect(await editor.table()).toBeNull();
  });

  test('works by mouse', async ({ viewer, editor }) => {
    const color = await editor.center(`${handle('color')}:nth-child(9)`);
    await viewer.settled(() => viewer.drag(color, [40, 0]));
    expect(Number((await editor.points(colorsPart))[8][0]), 'a dragged point of color').toBeGreaterThan(28);
    const first = await editor.table();
    const opacity = await editor.center(`${handle('opacity')}:nth-child(5)`);
    const density = async () => Number((await editor.points(opacityPart))[4][1]);
    await viewer.settled(() => viewer.drag(opacity, [0, -60]));
    expect(await density(), 'a dragged point of opacity').toBeGreaterThan(0.1);
    await editor.press('editor-undo');
    expect(await editor.table(), 'undo takes a whole drag back').toBe(first);
    await editor.press('editor-undo');
    expect(await editor.table(), 'undo leads to the table of the server').toBeNull();
    await editor.press('editor-redo');
    await editor.press('editor-redo');
    expect(await density(), 'redo brings the drag back').toBeGreaterThan(0.1);
  });

  test('works by keys', async ({ viewer, editor }) => {
    const color = await editor.center(`${handle('color')}:nth-child(9)`);
    await viewer.settled(() => viewer.drag(color, [40, 0]));
    await editor.focus('color[tabindex="0"]');
    for (const key of ['Home', 'PageDown', 'PageUp']) await viewer.key(key);
    expect(await editor.focused(), 'page keys go from point to point').toBe('Color 2');
    const before = await editor.points(colorsPart);
    await viewer.settled(() => viewer.key('ArrowRight'));
    expect(Number((await editor.points(colorsPart))[1][0]), 'an arrow moves a point').toBeGreaterThan(Number(before[1][0]));
    await viewer.settled(() => viewer.key('Insert'));
    expect(await editor.points(colorsPart), 'Insert adds a point').toHaveLength(before.length + 1);
    await viewer.settled(() => viewer.key('Delete'));
    expect(await editor.points(colorsPart), 'Delete removes the point').toHaveLength(before.length);
    await editor.focus('opacity[tabindex="0"]');
    const low = await editor.points(opacityPart);
    await viewer.settled(() => viewer.key('Shift+ArrowUp'));
    const isDenser = ([, perKm], i) => Number(perKm) > 1.5 * Number(low[i][1]);
    expect((await editor.points(opacityPart)).some(isDenser), 'an arrow makes a point denser').toBe(true);
    await viewer.settled(() => viewer.give('point-opacity', '0.05'));
    expect((await editor.points(opacityPart)).map(([, perKm]) => perKm), 'a number can be typed').toContain('0.05');
    await editor.focus('least');
    for (let times = 0; times < 5; ++times) await viewer.key('Shift+ArrowRight');
    await expect.poll(() => viewer.number('least'), 'the threshold is moved by keys').toBeGreaterThan(20);
  });

  test('works by a finger', async ({ viewer, editor }) => {
    const color = await editor.center(`${handle('color')}:nth-child(9)`);
    await viewer.settled(() => viewer.drag(color, [40, 0]));
    const last = async () => Number((await editor.points(colorsPart)).at(-2)[0]);
    const [x, y] = await editor.center(`${handle('color')}:nth-last-child(2)`);
    const before = await last();
    await viewer.settled(async () => {
      await viewer.touch('touchStart', [[x, y]]);
      for (const on of [4, 8, 12]) await viewer.touch('touchMove', [[x + on, y]]);
      await viewer.touch('touchEnd', []);
    });
    expect(await last(), 'a finger drags a point').toBeGreaterThan(before);
  });

  test('saves a file with which stormcellar frame draws the same picture, and a link keeps the colors', async ({ page, viewer, editor }) => {
    const color = await editor.center(`${handle('color')}:nth-child(9)`);
    await viewer.settled(() => viewer.drag(color, [40, 0]));
    await editor.focus('least');
    for (let times = 0; times < 5; ++times) await viewer.key('Shift+ArrowRight');
    await expect.poll(() => viewer.number('least')).toBeGreaterThan(20);
    await editor.focus('color[tabindex="0"]');
    await viewer.settled(() => viewer.give('point-color', '#ff40ff', 'input'));
    const edited = await editor.table();
    const toml = await editor.saved(() => viewer.press('editor-toml'));
    await expect(editor.says, 'the page says what was saved').toContainText('my-smooth-reflectivity.toml');
    const [, least] = /value = (.*)/.exec(readFileSync(toml, 'utf8'));
    expect(Number(least), 'what is hidden is not in the file').toBeGreaterThan(20);
    const pixels = await editor.expectSame('the edited table, by its TOML', toml);
    // Check that the comparison finds a difference with other colors.
    const usual = await editor.slicer.compare(editor.scene, pixels, { name: 'colors-usual' });
    expect(usual.p99, 'the difference with the usual colors').toBeGreaterThan(mostDifference);
    const link = page.url();
    await page.goto('about:blank');
    await page.goto(link);
    await viewer.drawn();
    expect(await editor.table(), 'a link holds the edited table').toBe(edited);
  });

  test('reads and writes .pal files', async ({ viewer, editor }) => {
    const pal = `Product: BR\nUnits: DBZ\nStep: 5\nColor4: 10 0 60 90 128 120 200 255 200\nSolidColor: 30 250 250 80\n` +
      'Color: 40 255 150 0 255 40 0\nColor: 55 255 0 200\nColor: 70 255 255 255\n';
    const own = join(editor.directory, 'own.pal');
    writeFileSync(own, pal);
    await viewer.settled(() => editor.choose('storm.pal', pal));
    await editor.expectSame('a .pal', own);
    await editor.expectSame('a .pal that the page wrote', await editor.saved(() => viewer.press('editor-pal')));
    await editor.expectSame('the same as TOML', await editor.saved(() => viewer.press('editor-toml')));
  });

  test('is not changed by broken and hostile files', async ({ viewer, editor }) => {
    const color = await editor.center(`${handle('color')}:nth-child(9)`);
    await viewer.settled(() => viewer.drag(color, [40, 0]));
    const held = await editor.table();
    for (const [name, text, wanted] of [
      ['a.pal', 'Colr: 1 2 3 4\n', "a.pal:1: unknown key 'COLR'"],
      ['b.toml', 'moment = "REF"\n[[point]]\nvalue = 1\n', 'b.toml:2: point must be there 2 to 4096 times'],
      ['c.toml', `a = ${'['.repeat(100000)}`, 'too deep'],
      ['d.toml', '\0\x01\xff', 'd.toml:1: '],
      ['e.csv', 'Color: 1 2 3 4\n', 'must end in .pal or .toml'],
      ['f.pal', ';'.repeat(2 ** 20 + 1), 'at most 1 MiB'],
      ['g.pal', 'Product: VIL\nColor: 1 2 3 4\n', 'its values are in kg/m2'],
    ]) {
      await editor.choose(name, text);
      await expect(editor.says, name).toContainText(wanted);
    }
    expect(await editor.table()).toBe(held);
    await viewer.show(`${editor.view}&table=REF!x!blend!5!80!770000!5~zz&table=${'x'.repeat(20000)}`);
    expect(await editor.table(), 'a broken table of an address').toBeNull();
  });

  test('saves the file that its command names', async ({ viewer, editor }) => {
    await viewer.catchCopies();
    // Show the ground, because no command draws echo without it.
    const strong = `${editor.view}&least=30`;
    await viewer.show(strong.replace('&ground=0', ''));
    let command = '';
    const cut = await editor.saved(async () => (command = await viewer.copiedBy('command')));
    const [, named] = /--colors (my-smooth-reflectivity-[0-9a-f]{8}\.toml)/.exec(command);
    expect(cut.endsWith(`/${named}`), `${cut} is ${named}`).toBe(true);
    await viewer.show(strong);
    await editor.expectSame('a threshold, by the file of the command', cut);
  });
});
