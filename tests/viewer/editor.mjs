// The editor of colors: what mouse, fingers and keys do in it, and that `stormcellar frame` draws the same with the
// files that it saves (scripts/check-viewer).
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, Slicer, check, gridsOf, mostDifference, viewOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, difference, directory, pictures] = process.argv.slice(2);
const scene = { station, moment: 'REF', azimuth: 180, tilt: 60, zoom: 2, field: 40, exaggeration: 3, opacity: 1, at: [0, 0, 4] };
const saved = join(directory, 'saved');
mkdirSync(saved, { recursive: true });

const browser = await Browser.start();
const page = await browser.page(640, 480);
const viewer = new CheckedPage(page, address);
await browser.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: saved });
const slicer = new Slicer(address, await gridsOf(address, [station]), difference, directory);
const grid = await slicer.fileOf(station, 'REF');

const evaluate = (text) => page.evaluate(text);
const says = () => evaluate("document.getElementById('editor-says').textContent");
const press = (id) => viewer.settled(() => evaluate(`document.getElementById('${id}').click()`));
const table = () => viewer.told('table');
const points = async (part) => (await table()).split('!')[part].split('_').map((point) => point.split('~'));
const [colorsPart, opacityPart] = [6, 7];
async function center(selector) {
  return evaluate(`(() => { const box = document.querySelector('${selector}').getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()`);
}
const focused = () => evaluate('document.activeElement.getAttribute("aria-label")');
// Waits until a file is saved, and returns its path.
async function savedAs(name, act) {
  await act();
  const file = join(saved, name);
  for (let tries = 0; tries < 200 && !existsSync(file); ++tries) await new Promise((done) => setTimeout(done, 25));
  return file;
}
// Gives the page a file as if the user had chosen it.
async function choose(name, text) {
  const file = join(directory, name);
  writeFileSync(file, text);
  const { root } = await page.send('DOM.getDocument');
  const { nodeId } = await page.send('DOM.querySelector', { nodeId: root.nodeId, selector: '#editor-file' });
  await evaluate("document.getElementById('editor-says').textContent = ''");
  await page.send('DOM.setFileInputFiles', { files: [file], nodeId });
  await page.until("document.getElementById('editor-says').textContent");
}
let number = 0;
// From far away pictures take little time.
const far = 0.2;
const lookFrom = (zoom) => viewer.settled(() => evaluate(`location.hash = location.hash.replace(/zoom=[^&]*/, 'zoom=${zoom}'); undefined`));
// The picture of the page against the slicer's with a file of colors.
async function compare(what, file, most = mostDifference) {
  const picture = join(pictures || directory, `colors-${++number}.ppm`);
  await lookFrom(scene.zoom);
  await page.resize(400, 266);
  await page.until("document.getElementById('picture').clientWidth === 400");
  // A picture that was begun before may come first.
  await viewer.settled(() => evaluate("window.dispatchEvent(new Event('resize')); undefined"));
  await viewer.settled(() => evaluate("window.dispatchEvent(new Event('resize')); undefined"));
  writeFileSync(picture, await viewer.pixels());
  const more = pictures ? [join(pictures, `colors-${number}-slicer.png`)] : [];
  const { p99, mean, count } = slicer.compare(grid, picture, scene, ['--colors', file, ...more]);
  check(`${what}: dE ${p99} (mean ${mean}) over ${count} pixels`, p99 <= most && count > 300);
  // The comparison can fail: other colors are another picture.
  if (number === 1) {
    const usual = slicer.compare(grid, picture, scene).p99;
    check(`with the usual colors the difference is ${usual}`, usual > mostDifference);
  }
  await page.resize(640, 480);
  await lookFrom(far);
}

// ---- Opening
await viewer.open(viewOf({ ...scene, zoom: far }));
check('no editor is there before it is opened', await evaluate("document.getElementById('editor') === null"));
await evaluate("document.getElementById('picture').focus()");
await page.key('e');
await page.until("document.getElementById('editor')?.offsetParent");
check('the keyboard is in the editor', (await focused()) === 'Table');
check('opening it edits nothing', (await table()) === null);

// ---- Mouse
const color = await center('#editor .handle.color:nth-child(9)');
await viewer.settled(() => page.drag(color, [40, 0]));
const dragged = await points(colorsPart);
check(`a dragged point of color moves: ${dragged[8][0]}`, Number(dragged[8][0]) > 28);
const first = await table();
const opacity = await center('#editor .handle.opacity:nth-child(5)');
await viewer.settled(() => page.drag(opacity, [0, -60]));
check(`a dragged point of opacity becomes denser: ${(await points(opacityPart))[4].join(' at ')}`, Number((await points(opacityPart))[4][1]) > 0.1);
await press('editor-undo');
check('undo takes a whole drag back', (await table()) === first);
await press('editor-undo');
check('undo leads to the table of the server', (await table()) === null);
await press('editor-redo');
await press('editor-redo');
check('redo leads back', Number((await points(opacityPart))[4][1]) > 0.1);

// ---- Keys
await evaluate("document.querySelector('#editor .handle.color[tabindex=\"0\"]').focus()");
await page.key('Home');
await page.key('PageDown');
await page.key('PageUp');
check(`page keys go from point to point: ${await focused()}`, (await focused()) === 'Color 2');
const before = await points(colorsPart);
await viewer.settled(() => page.key('ArrowRight'));
check('an arrow moves a point', Number((await points(colorsPart))[1][0]) > Number(before[1][0]));
await viewer.settled(() => page.key('Insert'));
check('Insert adds a point', (await points(colorsPart)).length === before.length + 1);
await viewer.settled(() => page.key('Delete'));
check('Delete removes it', (await points(colorsPart)).length === before.length);
await evaluate("document.querySelector('#editor .handle.opacity[tabindex=\"0\"]').focus()");
const low = await points(opacityPart);
await viewer.settled(() => page.key('ArrowUp', { modifiers: 8 }));
check('an arrow makes denser', (await points(opacityPart)).some(([, perKm], i) => Number(perKm) > 1.5 * Number(low[i][1])));
await viewer.settled(() => evaluate(`(() => { const input = document.getElementById('point-opacity'); input.value = '0.05'; input.dispatchEvent(new Event('change')); })()`));
check('a number can be typed', (await points(opacityPart)).some(([, perKm]) => perKm === '0.05'));
await evaluate("document.querySelector('#editor .handle.least').focus()");
for (let i = 0; i < 5; ++i) await page.key('ArrowRight', { modifiers: 8 });
await page.until('new URLSearchParams(location.hash.slice(1)).get("least") > 20');
check(`the threshold is moved by keys: ${await viewer.told('least')}`, true);

// ---- Fingers
const [x, y] = await center('#editor .handle.color:nth-last-child(2)');
const touched = (await points(colorsPart)).slice(-2)[0];
await viewer.settled(async () => {
  await page.touch('touchStart', [[x, y]]);
  for (const on of [4, 8, 12]) await page.touch('touchMove', [[x + on, y]]);
  await page.touch('touchEnd', []);
});
check('a finger drags a point', Number((await points(colorsPart)).slice(-2)[0][0]) > Number(touched[0]));

// ---- The same in stormcellar frame
await viewer.settled(() => evaluate(`(() => { const input = document.getElementById('point-color'); input.value = '#ff40ff'; input.dispatchEvent(new Event('input')); })()`));
const edited = await table();
const toml = await savedAs('my-smooth-reflectivity.toml', () => evaluate("document.getElementById('editor-toml').click()"));
check(`the page says what was saved: ${await says()}`, (await says()).includes('my-smooth-reflectivity.toml'));
check('what is hidden is not in the file', Number(/value = (.*)/.exec(readFileSync(toml, 'utf8'))[1]) > 20);
await compare('the edited table, by its TOML', toml);
const link = await evaluate('location.href');
await page.goto('about:blank');
await page.goto(link);
await page.until('document.documentElement.dataset.drawn');
check('a link holds the edited table', (await table()) === edited);

// ---- Import
await evaluate("document.getElementById('picture').focus()");
await page.key('e');
await page.until("document.getElementById('editor')?.offsetParent");
const pal = `Product: BR\nUnits: DBZ\nStep: 5\nColor4: 10 0 60 90 128 120 200 255 200\nSolidColor: 30 250 250 80\n` +
  'Color: 40 255 150 0 255 40 0\nColor: 55 255 0 200\nColor: 70 255 255 255\n';
await viewer.settled(() => choose('storm.pal', pal));
await viewer.settled(() => evaluate("document.querySelector('#editor .handle.least').focus()").then(() => page.key('ArrowLeft', { modifiers: 8 })));
for (let i = 0; i < 9; ++i) await page.key('ArrowLeft', { modifiers: 8 });
await page.until('!new URLSearchParams(location.hash.slice(1)).has("least")');
await compare('a .pal', join(directory, 'storm.pal'));
const palAgain = await savedAs('storm.pal', () => evaluate("document.getElementById('editor-pal').click()"));
await compare('a .pal that the page wrote', palAgain);
await compare('the same as TOML', await savedAs('storm.toml', () => evaluate("document.getElementById('editor-toml').click()")));

// ---- Broken and hostile files
const held = await table();
for (const [name, text, wanted] of [
  ['a.pal', 'Colr: 1 2 3 4\n', "a.pal:1: unknown key 'COLR'"],
  ['b.toml', 'moment = "REF"\n[[point]]\nvalue = 1\n', 'b.toml:2: point must be there 2 to 4096 times'],
  ['c.toml', `a = ${'['.repeat(100000)}`, 'too deep'],
  ['d.toml', '\0\x01\xff', 'd.toml:1: '],
  ['e.csv', 'Color: 1 2 3 4\n', 'must end in .pal or .toml'],
  ['f.pal', ';'.repeat(2 ** 20 + 1), 'at most 1 MiB'],
  ['g.pal', 'Product: VIL\nColor: 1 2 3 4\n', 'its values are in kg/m2'],
]) {
  await choose(name, text);
  check(`${name}: ${(await says()).slice(0, 100)}`, (await says()).includes(wanted));
}
check('they change nothing', (await table()) === held);
await viewer.show(`${viewOf({ ...scene, zoom: far })}&table=REF!x!blend!5!80!770000!5~zz&table=${'x'.repeat(20000)}`);
check('a broken table of an address is none', (await table()) === null);

// ---- The command
await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } })`);
// No command draws echo without the ground.
const strong = `${viewOf({ ...scene, zoom: far })}&least=30`;
await viewer.show(strong.replace('&ground=0', ''));
await evaluate("document.getElementById('command').click()");
const command = await page.until('window.copied');
const cut = /--colors (my-smooth-reflectivity-[0-9a-f]{8}\.toml)/.exec(command)?.[1] ?? 'none';
check(`the command names the file that was saved: ${cut}`, existsSync(await savedAs(cut, () => undefined)));
await viewer.show(strong);
await compare('a threshold, by the file of the command', join(saved, cut));
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
await browser.end();
