// Acts as a newcomer who opens the page and shares a section through the hook echo of KTLX on 3 May 1999. Counts
// presses, drags and turns of the wheel.
import { expect, report, test } from './fixtures.mjs';
import { image } from './pixels.mjs';
import { ViewerPage } from './viewer_page.mjs';

const mostActions = 12;
const [width, height] = [796, 532];
// Place of the tornado from Bridge Creek to Moore at 23:56 UTC, within some kilometers.
const hook = [35.27, -97.62];

test.use({ viewport: { width, height }, permissions: ['clipboard-read', 'clipboard-write'] });

// Presses the visible control with this text. Does not wait for a picture.
async function press(viewer, text) {
  const named = viewer.page.locator('button, label, summary').filter({ hasText: new RegExp(`^\\s*${text}\\s*$`), visible: true });
  const at = await named.first().evaluate((one) => {
    one.scrollIntoView({ block: 'nearest' });
    const { left, right, top, bottom } = (one.querySelector('input[type=checkbox]') ?? one).getBoundingClientRect();
    return [(left + right) / 2, (top + bottom) / 2];
  });
  await viewer.click(at);
}
// Returns the middle of the red echo near a place of the picture, which a user would take for the strongest.
async function redNear(viewer, [nearX, nearY], within) {
  const picture = image(await viewer.pixels());
  let [count, sumX, sumY] = [0, 0, 0];
  for (let y = Math.max(0, nearY - within); y < Math.min(height, nearY + within); ++y) {
    for (let x = Math.max(0, nearX - within); x < Math.min(width, nearX + within); ++x) {
      const [red, green, blue] = picture.at(x, y);
      if (red >= 200 && green <= 120 && blue <= 100) [count, sumX, sumY] = [count + 1, sumX + x, sumY + y];
    }
  }
  expect(count, 'red pixels').toBeGreaterThan(0);
  return [Math.round(sumX / count), Math.round(sumY / count)];
}

test('a newcomer shares a section through the hook', async ({ page, context, viewer, server }) => {
  const actions = [];
  const act = async (what, how) => {
    actions.push(what);
    await viewer.settled(how);
  };
  // Presses a control. If this changes the picture, waits for the new picture.
  const open = async (text) => {
    actions.push(text);
    await press(viewer, text);
    await viewer.drawn();
  };
  actions.push('open the address');
  await viewer.goto();
  await viewer.drawn();
  await open('Settings');
  await act('Top', () => press(viewer, 'Top'));
  actions.push('Settings');
  await press(viewer, 'Settings');
  // The page has fitted its view to all storms, so the storm with the hook is south-east of the middle.
  const seen = await redNear(viewer, [510, 400], 70);
  const storm = [330, 270];
  await act('drag the storm to the middle', () => viewer.drag([330, 330], [storm[0] - seen[0], storm[1] - seen[1]]));
  await act('wheel over the storm', () => viewer.wheel(storm, -600));
  await open('Layers');
  await act('Vertical section', () => press(viewer, 'Vertical section'));
  await open('Draw on the ground');
  const [x, y] = await redNear(viewer, storm, 150);
  await act('drag across the hook', () => viewer.drag([x - 100, y], [200, 0]));
  const said = await viewer.text('section-reading');
  await open('Settings');
  actions.push('Copy link');
  await press(viewer, 'Copy link');
  await expect(viewer.byId('state')).toContainText('clipboard');
  report(`${actions.length} actions: ${actions.join(', ')}`);
  expect(actions.length, actions.join(', ')).toBeLessThanOrEqual(mostActions);

  const ends = (await viewer.told('section')).split(',').map(Number);
  expect(ends[1], 'the section begins west of the hook').toBeLessThan(hook[1]);
  expect(ends[3], 'the section ends east of the hook').toBeGreaterThan(hook[1]);
  expect(Math.abs(ends[0] - hook[0]), 'degrees of latitude between the section and the hook').toBeLessThan(0.1);
  // The greatest value of the plot is near the greatest value of the server's profile; the two differ between cells.
  const { points } = await server.json(`grids/KTLX/REF/latest/profile?from=${ends.slice(0, 2)}&to=${ends.slice(2)}&count=400`);
  const greatest = Math.max(...points.flatMap(({ values }) => values ?? []).filter((value) => value !== null));
  const read = Number(said.match(/-?\d+\.\d+/)[0]);
  report(`${said}; among cells ${greatest}`);
  expect(read).toBeLessThanOrEqual(greatest + 0.5);
  expect(read).toBeGreaterThan(greatest - 3);

  // Open the link in another page, which must show the same picture.
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const other = new ViewerPage(await context.newPage(), server.address);
  await other.page.goto(link);
  await other.drawn();
  expect(await other.text('section-reading'), 'the reading of the section in the other page').toBe(said);
  // Allow small differences at edges, because the address rounds the camera.
  const [mine, theirs] = [await viewer.pixels(), await other.pixels()];
  expect(theirs.length).toBe(mine.length);
  const apart = mine.reduce((count, byte, i) => count + (Math.abs(byte - theirs[i]) > 24 ? 1 : 0), 0);
  report(`${apart} of ${mine.length} bytes of the pictures are apart`);
  expect(apart, 'bytes that differ between the two pictures').toBeLessThan(mine.length / 200);
  expect(other.trouble, 'errors of the other page').toEqual([]);
});
