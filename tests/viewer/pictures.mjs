// Pictures that the page saves, against what it shows (scripts/check-viewer).
//   node pictures.mjs ADDRESS STATION [SEQUENCE]
// SEQUENCE: the station has several volumes, which are played.
import { CheckedPage, check, gridsOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, sequence] = process.argv.slice(2);
await gridsOf(address, [station]);
const browser = await Browser.start();
try {
  const page = await browser.page(796, 532);
  const viewer = new CheckedPage(page, address);
  const evaluate = (text) => page.evaluate(text);
  const press = (id) => evaluate(`document.getElementById('${id}').click()`);
  await viewer.open(`domain=${station}&moment=REF&zoom=2&exaggeration=3&quality=${encodeURIComponent('64 slices, half resolution')}`);
  // A click on a link notes what is saved, and the title that the page shows at this moment.
  await evaluate(`HTMLAnchorElement.prototype.click = function () {
    window.taken = { href: this.href, name: this.download, title: document.getElementById('title').textContent };
  }; undefined`);
  const save = async () => {
    await evaluate('window.taken = undefined');
    await press('save');
    return page.until('window.taken', 60);
  };
  // The share of the letters over the picture that are in the saved picture where the page has them.
  const lettersInPlace = () => evaluate(`(async () => {
    const image = new Image();
    image.src = window.taken.href;
    await image.decode();
    const labels = document.getElementById('labels');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [image.width, image.height];
    const pen = copy.getContext('2d');
    pen.drawImage(image, 0, 0);
    const saved = pen.getImageData(0, 0, copy.width, copy.height).data;
    const shown = labels.getContext('2d').getImageData(0, 0, labels.width, labels.height).data;
    let [letters, same] = [0, 0];
    for (let y = 80; y < labels.height; ++y) for (let x = 0; x < labels.width - 100; ++x) {
      const at = 4 * (y * labels.width + x);
      if (shown[at + 3] < 255 || shown[at] < 180) continue;
      ++letters;
      const there = 4 * (y * copy.width + x);
      if (x < copy.width && y < copy.height && Math.abs(saved[there] - shown[at]) < 3) ++same;
    }
    return [letters, same];
  })()`);

  // ---- Names are where the page has them (2026-11-28: with half resolution they stood at twice their distances)
  const { name } = await save();
  const [letters, same] = await lettersInPlace();
  check(`${same} of ${letters} pixels of letters are in ${name} where the page shows them`, letters > 200 && same > 0.99 * letters);

  if (sequence) {
    // ---- While it plays, picture, title and name are of one volume (2026-11-28: 7 of 8 had the next one's time)
    await viewer.show(`domain=${station}&moment=REF&zoom=2&exaggeration=3&quality=${encodeURIComponent('64 slices')}`);
    await page.until("Number(document.getElementById('times').max) >= 4");
    await press('play');
    const played = [];
    for (let i = 0; i < 5; ++i) played.push(await save());
    await press('play');
    const times = await page.evaluate("fetch('../api/v1/grids?domain=" + station + "&moment=REF').then((answer) => answer.json()).then(({ grids }) => grids.map(({ time }) => time))");
    let right = 0;
    for (const one of played) {
      const at = times.findIndex((time) => one.name.includes(time.replace(/:/g, '')));
      await viewer.settled(() => evaluate(`(() => { const slider = document.getElementById('times'); slider.value = ${at}; slider.dispatchEvent(new Event('input')); })()`));
      const still = await save();
      const isOfTime = one.title.includes(times[at].slice(0, 19).replace('T', ' '));
      const off = await evaluate(`(async () => {
        const pixels = async (href) => {
          const image = new Image();
          image.src = href;
          await image.decode();
          const copy = document.createElement('canvas');
          [copy.width, copy.height] = [image.width, image.height];
          const pen = copy.getContext('2d');
          pen.drawImage(image, 0, 0);
          return pen.getImageData(0, 0, copy.width, copy.height).data;
        };
        const [one, other] = [await pixels(${JSON.stringify(one.href)}), await pixels(window.taken.href)];
        let off = 0;
        for (let i = 0; i < one.length; i += 4) if (Math.abs(one[i] - other[i]) + Math.abs(one[i + 1] - other[i + 1]) > 12) ++off;
        return one.length === other.length ? off : one.length;
      })()`);
      if (isOfTime && still.name === one.name && off < 50) ++right;
      else console.log(`${one.name}, titled ${one.title}: ${off} pixels differ from the picture of that time`);
    }
    check(`${right} of ${played.length} pictures saved while it plays are of the time that they name`, right === played.length);
  }

  // ---- While another moment comes, the picture is of the drawn one (2026-11-28: velocities were named SW)
  await viewer.show(`domain=${station}&moment=REF&zoom=2&exaggeration=3&quality=${encodeURIComponent('64 slices')}`);
  await evaluate('window.taken = undefined; undefined');
  await evaluate("document.getElementById('moment-VEL').click(); document.getElementById('save').click()");
  const later = await page.until('window.taken', 60);
  const drawn = await evaluate('document.documentElement.dataset.drawn');
  check(`a picture that is asked for while VEL comes is of what is drawn: ${later.name}, ${drawn}`, later.name.includes('_VEL_') && drawn.includes('/VEL/'));

  // ---- The lit button is that of the drawn moment (2026-11-28: it was that of the next one, over the picture before)
  await page.send('Fetch.enable', { patterns: [{ urlPattern: '*/packed*' }] });
  const held = new Promise((done) => browser.listeners.push(({ method, params }) => method === 'Fetch.requestPaused' && done(params.requestId)));
  await evaluate("document.getElementById('moment-SW').click()");
  const requestId = await held;
  const lit = () => evaluate("['aria-pressed', 'aria-busy'].map((name) => document.querySelector(`#moments [${name}=true]`)?.textContent).join()");
  const whileItComes = await lit();
  await page.send('Fetch.disable');
  await page.until("document.documentElement.dataset.drawn?.includes('/SW/')", 60);
  check(`while SW comes, what is lit and what is waited for: ${whileItComes}; then ${await lit()}`, requestId && whileItComes === 'VEL,SW' && (await lit()) === 'SW,');
  check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
} finally {
  await browser.end();
}
