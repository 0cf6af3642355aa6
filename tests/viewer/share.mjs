// Checks what a user takes along: link, command that draws the same, picture, grid (scripts/check-viewer).
//   node share.mjs ADDRESS STATION VOLUME PROGRAM DIRECTORY [PICTURE_DIRECTORY]
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join, resolve } from 'node:path';

import { CheckedPage, check, gridsOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, volume, program, directory, pictures] = process.argv.slice(2);
await gridsOf(address, [station]);
const browser = await Browser.start();
try {
  const [width, height] = [560, 420];
  const page = await browser.page(width, height);
  const viewer = new CheckedPage(page, address);
  const evaluate = (text) => page.evaluate(text);
  await viewer.open(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2&least=30&height-km=3`);
  await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } })`);
  await evaluate(`HTMLAnchorElement.prototype.click = function () { window.taken = { href: this.href, name: this.download }; }; undefined`);
  const press = (id) => evaluate(`document.getElementById('${id}').click()`);

  // ---- The link shows the same
  await viewer.settled(() => page.key('ArrowRight'));
  await press('share');
  const link = await page.until('window.copied');
  const picture = await viewer.pixels();
  const newest = (await evaluate('document.documentElement.dataset.drawn')).split('/').pop();
  const pinned = (await evaluate('location.href')).replace('time=latest', `time=${encodeURIComponent(newest)}`);
  check(`the link is the address with the time that is shown: ${link.length} characters`, link === pinned && link.includes('height-km=3'));

  // ---- The command runs where the raw volume is
  await viewer.show(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2`);
  await press('open');
  for (let tries = 0; tries < 50 && !page.requests.some((url) => url.includes('/volumes?to=')); ++tries) await new Promise((done) => setTimeout(done, 100));
  await new Promise((done) => setTimeout(done, 300));
  await evaluate('window.copied = undefined');
  await press('command');
  const command = await page.until('window.copied');
  // A shell splits the command.
  const words = execFileSync('sh', ['-c', `printf '%s\\n' ${command}`], { encoding: 'utf8' }).trimEnd().split('\n').slice(1);
  check(`the command reads the raw volume: ${command}`, words[0] === 'frame' && words[1] === basename(volume));
  const drawn = join(resolve(directory), 'command.png');
  execFileSync(resolve(program), [...words.slice(0, -1), drawn], { cwd: dirname(resolve(volume)), stdio: 'ignore' });
  check('and draws a picture', readFileSync(drawn).length > 10000);
  // 2026-11-28: Raw volume gave that file another name.
  await evaluate('window.taken = undefined');
  await press('raw');
  const taken = await page.until('window.taken');
  const file = await fetch(taken.href, { method: 'HEAD' });
  // A browser takes the name of the answer before that of the link.
  const saved = file.headers.get('content-disposition')?.match(/filename="(.*)"/)?.[1] ?? taken.name;
  check(`Raw volume gives it: ${file.status}, ${saved}`, file.status === 200 && saved === words[1]);
  check('it names the colors and the size of the page', command.includes('--colors ') && command.includes(`--width ${width} --height ${height}`));
  // 2026-11-28: it had the colors of the moment that was chosen, and not of the one that was shown.
  await evaluate(`window.copied = undefined; document.getElementById('moment-VEL').click(); document.getElementById('command').click()`);
  check(`while another moment comes there is none: ${await evaluate("document.getElementById('state').textContent")}`, !(await evaluate('window.copied')) && (await evaluate("document.getElementById('state').textContent")).includes('not complete'));
  await page.until("document.documentElement.dataset.drawn?.includes('/VEL/')", 60);
  // 2026-11-28: the command drew range-folded air as clear.
  await evaluate('window.copied = undefined');
  await press('command');
  check(`a veil has none: ${await evaluate("document.getElementById('state').textContent")}`, !(await evaluate('window.copied')) && (await evaluate("document.getElementById('state').textContent")).includes('veil'));
  // 2026-11-29: the button was marked by the picture before.
  const isOffered = async () => (await evaluate("document.getElementById('command').getAttribute('aria-disabled')")) === 'false';
  check('it is not offered', !(await isOffered()));
  await viewer.show(`domain=${station}&moment=VEL&azimuth=200&tilt=60&zoom=2&folded=0`);
  await press('command');
  check('without it there is one, and it is offered', (await isOffered()) && (await page.until('window.copied')).includes('--moment VEL'));
  // If no command draws the same, none is offered (2026-11-28: of several layers it drew one without a word).
  await viewer.show(link.split('#')[1]);
  await evaluate('window.copied = undefined');
  await press('command');
  const why = await evaluate("document.getElementById('state').textContent");
  check(`two layers have no command: ${why}`, why.includes('one layer') && !(await evaluate('window.copied')));
  await press('open');

  // ---- The picture, with what it needs to be understood
  await evaluate('window.taken = undefined');
  await press('save');
  const { name } = await page.until('window.taken?.href.startsWith("data:image/png") && window.taken');
  const [w, h, heads, bars] = await evaluate(`(async () => {
    const image = new Image();
    image.src = window.taken.href;
    await image.decode();
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [image.width, image.height];
    const pen = copy.getContext('2d');
    pen.drawImage(image, 0, 0);
    // Pixels of letters in the head, and colors of the bar.
    const head = pen.getImageData(0, 8, 300, 22).data;
    let letters = 0;
    for (let i = 0; i < head.length; i += 4) if (head[i] > 200 && head[i + 1] > 200 && head[i + 2] > 200) ++letters;
    const { left, top, height: long } = document.getElementById('bar').getBoundingClientRect();
    const bar = pen.getImageData(left + 6, top + 22, 1, long - 34).data;
    const colors = new Set();
    for (let i = 0; i < bar.length; i += 4) colors.add(bar.slice(i, i + 3).join());
    return [image.width, image.height, letters, colors.size];
  })()`);
  check(`${name} has ${w} x ${h} pixels, a title (${heads} light pixels) and the colors (${bars})`, name.startsWith(`${station}_REF_`) && w === width && h === height && heads > 300 && bars > 40);
  if (pictures) {
    mkdirSync(pictures, { recursive: true });
    writeFileSync(join(pictures, 'saved.png'), Buffer.from((await evaluate('window.taken.href')).split(',')[1], 'base64'));
  }

  // ---- The grid: the page goes to its file, which the browser saves
  const path = await evaluate("document.documentElement.dataset.drawn");
  const { headers, status } = await fetch(`${address}/api/v1/grids/${path}/netcdf`);
  check(`the grid is a file: ${status}, ${headers.get('content-disposition')}`, status === 200 && headers.get('content-type').includes('netcdf'));
  await page.send('Network.setBlockedURLs', { urls: ['*/netcdf'] });
  await press('netcdf');
  await new Promise((done) => setTimeout(done, 300));
  check('the button asks for it', page.requests.some((url) => url.endsWith('/netcdf')));
  await page.send('Network.setBlockedURLs', { urls: [] });

  // ---- Its raw file is gone, an older one is there (2026-11-28: the command drew that one)
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&folded=0`);
  await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } });
    window.own = window.fetch;
    window.fetch = (url, ...more) => String(url).includes('/volumes?to=') ? Promise.resolve(new Response(JSON.stringify({ volumes: [{ raw: 'OLDER', time: '2016-06-01T14:50:00Z' }] }))).finally(() => (window.told = true)) : own(url, ...more); undefined`);
  await press('open');
  await page.until('window.told');
  await new Promise((done) => setTimeout(done, 300));
  await press('command');
  const ofCache = await page.until('window.copied');
  check(`the command reads the cache then, and the page says so: ${ofCache}`, ofCache.startsWith(`stormcellar frame ${station} `) && (await evaluate("document.getElementById('state').textContent")).includes('cache'));

  // ---- Its raw file was deleted, as the catalog says (2026-11-28: the command read it, and it was offered)
  const ofGrid = (await evaluate('document.documentElement.dataset.drawn')).split('/').pop();
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&folded=0`);
  await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } });
    window.own = window.fetch;
    window.fetch = (url, options, ...more) => {
      if (String(url).includes('/volumes?to=')) return Promise.resolve(new Response(JSON.stringify({ volumes: [{ raw: null, time: '${ofGrid}' }] }))).finally(() => (window.told = true));
      return options?.method === 'HEAD' ? Promise.resolve(new Response(null, { status: 410 })) : own(url, options, ...more);
    }; undefined`);
  await press('open');
  await page.until('window.told');
  await new Promise((done) => setTimeout(done, 300));
  await press('command');
  check(`the command reads the cache: ${await page.until('window.copied')}`, (await page.until('window.copied')).startsWith(`stormcellar frame ${station} `));
  await press('raw');
  check(`Raw volume says that it is not here`, await page.until("document.getElementById('tool-says').textContent.includes('not here')").catch(() => false));

  // ---- The grid is gone, of which nobody asked before (2026-11-29: its raw file was said not to be here)
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&folded=0`);
  await evaluate(`window.own = window.fetch;
    window.fetch = (url, ...more) => decodeURIComponent(url).endsWith('${ofGrid}') ? Promise.resolve(new Response(JSON.stringify({ error: 'no such grid' }), { status: 404, headers: { 'Stormcellar-Status': '404' } })).finally(() => (window.asked = true)) : own(url, ...more);
    undefined`);
  await press('raw');
  await page.until('window.asked');
  check('of the raw file of a grid that is gone, nothing is said', await page.until("document.getElementById('state').textContent.startsWith('There is no picture')").then(async () => (await evaluate("document.getElementById('tool-says').textContent")) === '', () => false));

  // ---- Its volume is the second of a file, of which a copy was deleted (2026-11-28: the command drew the first one)
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&folded=0`);
  await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } });
    window.own = window.fetch;
    window.fetch = async (url, ...more) => {
      if (!String(url).includes('/volumes?to=')) return own(url, ...more);
      window.told = true;
      return new Response(JSON.stringify({ volumes: [{ raw: 'TWO', number_in_file: 2, time: '${ofGrid}' }, { raw: null, number_in_file: 2, time: '${ofGrid}' }] }));
    }; undefined`);
  await press('open');
  await page.until('window.told');
  await new Promise((done) => setTimeout(done, 300));
  await press('command');
  const ofSecond = await page.until('window.copied');
  check(`the command draws the second volume: ${ofSecond}`, ofSecond.startsWith('stormcellar frame TWO ') && ofSecond.includes('--volume 2'));

  // ---- Its volume came in chunks (2026-11-28: it was saved under the name of the first one)
  const began = (await evaluate('document.documentElement.dataset.drawn')).split('/').pop();
  const joinedName = station + began.slice(0, 19).replace(/[-:]/g, '').replace('T', '_');
  await evaluate(`window.fetch = (url, ...more) => String(url).includes('/volumes?to=') ? Promise.resolve(new Response(JSON.stringify({ volumes: [{ raw: '${joinedName}', number_in_file: 1, time: '${began}' }] }))) : own(url, ...more);
    HTMLAnchorElement.prototype.click = function () { window.taken = { href: this.href, name: this.download }; }; undefined`);
  await press('raw');
  const joined = await page.until('window.taken');
  check(`Raw volume gives the volume: ${joined.name}`, joined.name === joinedName && (await fetch(joined.href, { method: 'HEAD' })).status === 200);

  // ---- Its grid is another one than the program makes of the raw file (2026-11-28: the command drew that one)
  const spacingAt = 64; // of a packed grid
  await evaluate(`window.told = false;
    window.fetch = async (url, ...more) => {
      const answer = await own(url, ...more);
      if (String(url).includes('/packed')) {
        const bytes = await answer.arrayBuffer();
        new DataView(bytes).setFloat64(${spacingAt}, 900, true);
        return new Response(bytes);
      }
      if (!String(url).includes('/volumes?to=')) return answer;
      const read = await answer.json();
      // Readers have read it before the timer fires.
      return Object.assign(new Response(), { json: async () => (setTimeout(() => (window.told = true)), read) });
    };
    document.getElementById('moment-VEL').click(); undefined`);
  await page.until("document.documentElement.dataset.drawn?.includes('/VEL/') && window.told");
  await evaluate('window.copied = undefined');
  await press('command');
  const ofOther = await page.until('window.copied');
  check(`the command of another grid reads the cache: ${ofOther}`, ofOther.startsWith(`stormcellar frame ${station} `));

  // ---- Without a clipboard, as over plain HTTP (2026-11-28: it was said that the link is there)
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF`);
  await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: undefined }); window.prompt = (said, text) => (window.asked = [said, text], null); undefined`);
  for (const [id, part] of [['share', 'domain='], ['command', 'stormcellar frame']]) {
    await evaluate('window.asked = undefined');
    await press(id);
    const [said, copied] = await page.until('window.asked');
    check(`without a clipboard the page says so: ${said}`, said.includes('not available') && !said.includes('in the clipboard') && copied.includes(part));
  }

  // ---- The link, opened by somebody else
  await page.goto('about:blank');
  await page.goto(link);
  await page.until('document.documentElement.dataset.drawn', 60);
  check('the link shows the same picture', (await viewer.pixels()).equals(picture));
} finally {
  await browser.end();
}
