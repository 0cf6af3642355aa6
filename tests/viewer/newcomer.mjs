// From the address alone to a shared section through the hook of KTLX, 3 May 1999, as somebody would who has
// never seen the page: what is pressed, dragged and turned is counted (scripts/check-viewer).
import { CheckedPage, check } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address] = process.argv.slice(2);
const mostActions = 12;
const [width, height] = [796, 532];
// The tornado that went from Bridge Creek to Moore was here at 23:56 UTC, within some kilometers.
const hook = [35.27, -97.62];

const browser = await Browser.start();
try {
  const page = await browser.page(width, height);
  await browser.send('Browser.grantPermissions', { permissions: ['clipboardReadWrite', 'clipboardSanitizedWrite'] });
  const viewer = new CheckedPage(page, address);
  const actions = [];
  const act = async (what, how) => {
    actions.push(what);
    await viewer.settled(how);
  };
  // A press of what is written on it, where it lies on the screen.
  const press = async (text) => {
    const at = await page.evaluate(`(() => {
      const shown = [...document.querySelectorAll('button, label, summary')].filter((one) => one.getClientRects().length > 0);
      const found = shown.find((one) => one.textContent.trim() === ${JSON.stringify(text)});
      if (!found) return null;
      found.scrollIntoView({ block: 'nearest' });
      const { left, right, top, bottom } = (found.querySelector('input[type=checkbox]') ?? found).getBoundingClientRect();
      return [(left + right) / 2, (top + bottom) / 2];
    })()`);
    if (!at) throw new Error(`nothing that is shown says '${text}'`);
    await page.drag(at, [0, 0]);
  };
  // Opens something, of which the picture need not change; where it does, that is waited for.
  const open = async (text) => {
    actions.push(text);
    await press(text);
    await page.until('document.documentElement.dataset.drawn', 120);
  };
  // The strongest echo near a place of the picture, as the eye finds it: the middle of what is red.
  const redNear = async ([nearX, nearY], within) => {
    const ppm = await viewer.pixels();
    const at = ppm.length - 3 * width * height;
    let [count, sumX, sumY] = [0, 0, 0];
    for (let y = Math.max(0, nearY - within); y < Math.min(height, nearY + within); ++y) {
      for (let x = Math.max(0, nearX - within); x < Math.min(width, nearX + within); ++x) {
        const [red, green, blue] = ppm.subarray(at + 3 * (y * width + x));
        if (red < 200 || green > 120 || blue > 100) continue;
        ++count;
        sumX += x;
        sumY += y;
      }
    }
    if (count === 0) throw new Error('nothing is red there');
    return [Math.round(sumX / count), Math.round(sumY / count)];
  };

  await act('open the address', () => page.goto(`${address}/view/`));
  await open('Settings');
  await act('Top', () => press('Top'));
  const storm = await redNear([width / 2, height / 2], 60);
  await act('wheel over the storm', () => page.wheel(...storm, -1200));
  await open('Layers');
  await act('Vertical section', () => press('Vertical section'));
  await open('Draw on the ground');
  const [x, y] = await redNear(storm, 150);
  await act('drag across the hook', () => page.drag([x - 100, y], [200, 0]));
  const said = await page.evaluate("document.getElementById('section-reading').textContent");
  await open('Settings');
  actions.push('Copy link');
  await press('Copy link');
  await page.until("document.getElementById('state').textContent.includes('clipboard')");
  check(`${actions.length} actions: ${actions.join(', ')}`, actions.length <= mostActions);

  const ends = (await viewer.told('section')).split(',').map(Number);
  check(`the section lies across the hook: ${ends}`, ends[1] < hook[1] && hook[1] < ends[3] && Math.abs(ends[0] - hook[0]) < 0.1);
  // The greatest value that was read is, but for what lies between cells, the server's own along that way.
  const { points } = await (await fetch(`${address}/api/v1/grids/KTLX/REF/latest/profile?from=${ends.slice(0, 2)}&to=${ends.slice(2)}&count=400`)).json();
  const greatest = Math.max(...points.flatMap(({ values }) => values ?? []).filter((value) => value !== null));
  const read = Number(said.match(/-?\d+\.\d+/)[0]);
  check(`${said}; among cells ${greatest}`, read <= greatest + 0.5 && read > greatest - 3);

  // Another page that opens the link shows the same.
  const link = await page.evaluate('navigator.clipboard.readText()');
  const other = await browser.page(width, height);
  const shared = new CheckedPage(other, address);
  await other.goto(link);
  await other.until('document.documentElement.dataset.drawn', 120);
  check('the link shows the same section', (await other.evaluate("document.getElementById('section-reading').textContent")) === said);
  // The address rounds the camera, so edges may lie a little aside.
  const [mine, theirs] = [await viewer.pixels(), await shared.pixels()];
  let apart = 0;
  for (let i = 0; i < mine.length; ++i) apart += Math.abs(mine[i] - theirs[i]) > 24 ? 1 : 0;
  check(`and the same picture: ${apart} of ${mine.length} bytes are apart`, mine.length === theirs.length && apart < mine.length / 200);
  check('nothing failed', page.trouble.length + other.trouble.length === 0, [...page.trouble, ...other.trouble].join('\n'));
} finally {
  await browser.end();
}
