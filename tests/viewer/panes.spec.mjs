// Checks pictures of several panes: that each pane is the picture of a page of its own, that panes share camera,
// pointer and time, and that link and saved picture have all panes.
import { expect, report, test as base } from './fixtures.mjs';
import { decoded, image } from './pixels.mjs';

const [width, height] = [802, 704];
const solidView = 'azimuth=217&tilt=60&zoom=2&field-of-view=40&exaggeration=4&opacity=1';

const test = base.extend({
  viewport: { width, height },
  // The newest time of the first station, and the first part of an address there.
  begin: async ({ server }, use) => {
    const { domain, time } = await server.grid(server.station);
    await use(`domain=${domain}&time=${time}`);
  },
});

// Returns the places of the panes in pixels of the page.
const boxesOf = ({ page }) =>
  page.locator('.pane').evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON()));
const middleOf = ({ x, y, width, height }) => [Math.round(x + width / 2), Math.round(y + height / 2)];
const pane = ({ page }, number) => page.locator('.pane').nth(number - 1);
const count = ({ page }) => page.locator('.pane').count();
const hash = ({ page }) => page.evaluate(() => location.hash);
const momentsOf = ({ page }) => page.locator('.pane').evaluateAll((all) => all.map((one) => one.dataset.title.split(' ')[0]));
// Waits for the fine picture of the panes. The page draws them again when its head has got another line.
const settled = (viewer) =>
  viewer.until(() => {
    const picture = document.getElementById('picture');
    const { drawn, panels } = document.documentElement.dataset;
    return drawn && panels && picture.width === picture.clientWidth && picture.height === picture.clientHeight;
  });
// Returns the picture, and the places of the panes in it.
async function panesOf(viewer) {
  await settled(viewer);
  const boxes = await boxesOf(viewer);
  const { x, y } = await viewer.byId('picture').boundingBox();
  return { picture: image(await viewer.pixels()), places: boxes.map((box) => ({ ...box, x: box.x - x, y: box.y - y })) };
}
// Returns how many pixels of a pane differ from a picture of the size of the pane.
function differing({ picture, places }, index, single) {
  const { x, y, width, height } = places[index];
  expect([single.width, single.height], 'the size of the pane').toEqual([width, height]);
  let found = 0;
  for (let row = 0; row < height; ++row)
    for (let column = 0; column < width; ++column)
      if (picture.at(x + column, y + row).join() !== single.at(column, row).join()) ++found;
  return found;
}
// Returns the number of colors of a pane, which is small if the pane is empty.
function colorsOf({ picture, places }, index) {
  const { x, y, width, height } = places[index];
  const colors = new Set();
  for (let row = 0; row < height; row += 3) for (let column = 0; column < width; column += 3) colors.add(picture.at(x + column, y + row).join());
  return colors.size;
}

const singles = {
  '3D': {
    view: solidView,
    panes: ['moment=REF', 'moment=VEL', 'moment=REF&volume=0&height-km=3', 'moment=REF&surface=40&elevation=0.5&light=gradient'],
  },
  '2D': {
    view: 'view=2d&zoom=2',
    panes: ['moment=REF&elevation=0.5', 'moment=VEL&elevation=0.5', 'moment=REF&elevation=2.4', 'moment=REF&elevation=0.5&least=40'],
  },
};
for (const [mode, { view, panes }] of Object.entries(singles))
  test(`four panes equal four single pages in ${mode}`, async ({ viewer, begin }) => {
    const others = panes.slice(1).map((text) => `pane=${text.replace('moment=', '').replaceAll('&', ';')}`);
    await viewer.open(`${begin}&${view}&${panes[0]}&${others.join('&')}`);
    const drawn = await panesOf(viewer);
    expect(drawn.places).toHaveLength(4);
    const size = drawn.places[0];
    for (let i = 0; i < 4; ++i) expect(colorsOf(drawn, i), `pane ${i + 1} shows something`).toBeGreaterThan(20);
    await viewer.resize(size.width, size.height);
    for (const [i, text] of panes.entries()) {
      await viewer.open(`${begin}&${view}&${text}`);
      expect(differing(drawn, i, image(await viewer.pixels())), `pixels of pane ${i + 1} that differ`).toBe(0);
    }
  });

// Prints figures, because other programs on the machine change them: the least time of some pictures.
test('the time of four panes', { tag: '@full' }, async ({ viewer, begin }) => {
  const ms = async (panes) => {
    await viewer.open(`${begin}&${solidView}&moment=REF${panes}`);
    const { width, height } = await viewer.byId('picture').boundingBox();
    const times = [];
    for (let i = 0; i < 6; ++i) {
      await viewer.settled(() => viewer.key(i % 2 ? 'ArrowLeft' : 'ArrowRight'));
      times.push(Number(await viewer.data('frameMs')));
    }
    return { ms: Math.min(...times), megapixels: (width * height) / 1e6 };
  };
  const one = await ms('');
  const perMegapixel = ({ ms, megapixels }) => ms / megapixels;
  for (const [what, panes] of [['of one moment', '&pane=REF&pane=REF&pane=REF'], ['of four moments', '&pane=VEL;folded=0&pane=ZDR&pane=RHO']]) {
    const four = await ms(panes);
    const ratio = (of) => (of(four) / of(one)).toFixed(2);
    report(`four panes ${what}: ${four.ms} ms, ${ratio(({ ms }) => ms)} times one picture (for each pixel ${ratio(perMegapixel)} times)`);
  }
});

test('a link opens the same panes, and what it names wrongly is told', async ({ viewer, begin }) => {
  await viewer.open(`${begin}&${solidView}&moment=REF&pane=VEL;folded=0&pane=ZDR;maximum=1&pane=XYZ;elevation=0.5&active=3`);
  await expect(pane(viewer, 3)).toHaveClass(/active/);
  await expect(pane(viewer, 4)).toContainText('no XYZ at this time');
  await viewer.catchCopies();
  const link = await viewer.copiedBy('share');
  expect(link).toContain('pane=VEL;folded=0&pane=ZDR;maximum=1&pane=XYZ;elevation=0.5&active=3');
  const drawn = await panesOf(viewer);
  await viewer.page.goto('about:blank');
  await viewer.page.goto(link);
  const again = await panesOf(viewer);
  expect(again.picture.width).toBe(drawn.picture.width);
  for (let i = 0; i < 3; ++i) expect(colorsOf(again, i), `pane ${i + 1}`).toBe(colorsOf(drawn, i));
});

test('panes share camera, pointer and marks', async ({ viewer, begin }) => {
  await viewer.open(`${begin}&view=2d&zoom=2&moment=REF&pane=VEL&pane=ZDR&pane=RHO`);
  const boxes = await boxesOf(viewer);
  const before = await panesOf(viewer);
  await viewer.changes('a drag in pane 4', 'look-at-km', () => viewer.drag(middleOf(boxes[3]), [60, 40]), () => true);
  await expect(pane(viewer, 4), 'a press makes a pane active').toHaveClass(/active/);
  expect(await viewer.told('look-at-km')).not.toBeNull();
  const after = await panesOf(viewer);
  for (let i = 0; i < 4; ++i) {
    const { x, y } = before.places[i];
    const moved = [0, 1, 2, 3, 4, 5, 6, 7].filter((k) => {
      const [left, top] = [x + 110 + 20 * k, y + 120 + 10 * k];
      return before.picture.at(left, top).join() === after.picture.at(left + 60, top + 40).join();
    });
    expect(moved.length, `pane ${i + 1} moved as far`).toBeGreaterThanOrEqual(6);
  }
  // The pointer has a mark at the same place of each other pane.
  const [x, y] = middleOf(boxes[1]);
  await viewer.hover([x - 30, y + 20]);
  await expect(viewer.byId('hover')).toContainText('VEL');
  for (const moment of ['REF', 'ZDR', 'RHO']) await expect(viewer.byId('hover'), 'the box tells all panes').toContainText(moment);
  for (const i of [0, 2, 3]) {
    const mark = await viewer.page.locator('.pane-mark').nth(i).boundingBox();
    expect([Math.round(mark.x - boxes[i].x), Math.round(mark.y - boxes[i].y)], `mark of pane ${i + 1}`).toEqual([x - 30 - boxes[1].x, y + 20 - boxes[1].y].map(Math.round));
  }
  await expect(viewer.page.locator('.pane-mark').nth(1)).toBeHidden();
  await viewer.click([x - 30, y + 20]);
  await expect(viewer.byId('reading')).toContainText('VEL');
  await expect(viewer.byId('reading')).toContainText('RHO');
});

test('panes are chosen by list, keys and touch', async ({ viewer, begin }) => {
  await viewer.open(`${begin}&${solidView}&moment=REF`);
  expect(await count(viewer)).toBe(0);
  const single = image(await viewer.pixels());
  await viewer.settled(() => viewer.key('4'));
  expect(await count(viewer)).toBe(2);
  await viewer.settled(() => viewer.key('5'));
  await expect(pane(viewer, 2)).toHaveClass(/active/);
  await viewer.settled(() => pane(viewer, 2).locator('select').selectOption('VEL'));
  expect(await viewer.told('pane')).toMatch(/^VEL/);
  await viewer.settled(() => viewer.key('m'));
  expect(await viewer.told('pane'), 'layers belong to the active pane').toContain('maximum=1');
  expect(await viewer.told('maximum')).toBeNull();
  await viewer.settled(() => viewer.byId('pane-choice').selectOption('moments'));
  const { moments } = (await (await fetch(`${viewer.address}/api/v1/domains`)).json()).domains.find(({ domain }) => begin.includes(domain));
  if (moments.some(({ moment }) => moment === 'ZDR')) expect(await momentsOf(viewer)).toEqual(['Reflectivity', 'Radial', 'Differential', 'Correlation']);
  await viewer.settled(async () => viewer.tap(middleOf((await boxesOf(viewer))[0])));
  await expect(pane(viewer, 1)).toHaveClass(/active/);
  await viewer.settled(() => viewer.byId('pane-choice').selectOption('tilts'));
  await expect(viewer.byId('mode-2d')).toHaveAttribute('aria-pressed', 'true');
  const tilts = await viewer.page.locator('.pane-told').allTextContents();
  const angles = tilts.map((text) => Number(/^(\d+\.\d)°/.exec(text)[1]));
  expect(angles, 'four rising tilts').toEqual([...new Set(angles)].sort((a, b) => a - b));
  await viewer.settled(() => viewer.key('3'));
  await viewer.settled(() => viewer.key('4'));
  expect(await count(viewer), 'one pane again').toBe(0);
  expect(image(await viewer.pixels()).width).toBe(single.width);
  await viewer.key('?');
  await expect(viewer.byId('reading')).toContainText('1, 2 or 4 panes');
});

test('a saved picture has all panes', async ({ page, viewer, begin }) => {
  await viewer.open(`${begin}&${solidView}&moment=REF&pane=VEL;folded=0&pane=ZDR&pane=RHO`);
  const { picture, places } = await panesOf(viewer);
  await viewer.catchLinks();
  const { href, name } = await viewer.takenBy('save');
  expect(name).toMatch(/_REF-VEL-ZDR-RHO_.*\.png$/);
  const saved = await decoded(page, href);
  expect(saved.width).toBe(picture.width);
  const head = saved.height - picture.height; // title above the panes
  expect(head).toBeGreaterThan(20);
  for (const [i, { x, y, width, height }] of places.entries()) {
    let [same, all] = [0, 0];
    for (let row = 0.3 * height; row < height; row += 7)
      for (let column = 0; column < 0.8 * width; column += 7, ++all) {
        const [left, top] = [x + column, y + row].map(Math.floor);
        if (picture.at(left, top).join() === saved.at(left, head + top).join()) ++same;
      }
    expect(same / all, `share of pane ${i + 1} in the saved picture`).toBeGreaterThan(0.8);
  }
});

for (const [wide, high] of [[390, 844], [1000, 700], [1440, 900]])
  test(`panes have room at ${wide} pixels`, async ({ viewer, begin }) => {
    await viewer.resize(wide, high);
    await viewer.open(`${begin}&view=2d&zoom=2&moment=REF&pane=VEL&pane=ZDR&pane=RHO`);
    await settled(viewer);
    const boxes = await boxesOf(viewer);
    for (const { width, height } of boxes) expect(Math.min(width, height)).toBeGreaterThan(150);
    const foot = await viewer.byId('foot').boundingBox();
    const head = await viewer.byId('head').boundingBox();
    expect(boxes[0].y, 'below the head').toBeGreaterThanOrEqual(head.y + head.height);
    expect(boxes[3].y + boxes[3].height, 'above the foot').toBeLessThanOrEqual(foot.y);
    await viewer.keep(`panes-${wide}`);
  });
