// Checks what the page copies and saves: link, command, picture, grid.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';

import { expect, test } from './fixtures.mjs';
import { decoded } from './pixels.mjs';

const [width, height] = [560, 420];
test.use({ viewport: { width, height } });

const state = (viewer) => viewer.byId('state');
const copied = (page) => page.evaluate(() => window.copied ?? null);
// Returns the time of the drawn grid.
const drawnTime = async (viewer) => (await viewer.data('drawn')).split('/').pop();

// Answers the page's requests for raw volumes with `volumes`. If `volumes` is null, lets the server answer. Sets
// window.told once the page has read the answer.
function tellVolumes(page, volumes = null) {
  return page.evaluate((volumes) => {
    const own = window.fetch;
    window.told = false;
    window.fetch = async (url, ...more) => {
      if (!String(url).includes('/volumes?to=')) return own(url, ...more);
      const read = volumes ? { volumes } : await (await own(url, ...more)).json();
      // Set window.told by a timer, which fires after the page has handled the answer.
      return Object.assign(new Response(), { json: async () => (setTimeout(() => (window.told = true)), read) });
    };
  }, volumes);
}
// Opens a station's reflectivity, answers requests for raw volumes with `volumes`, and returns the command.
async function commandFor(viewer, station, volumes) {
  await viewer.open(`domain=${station}&moment=REF&folded=0`);
  await viewer.catchCopies();
  const time = await drawnTime(viewer);
  await tellVolumes(viewer.page, volumes.map((one) => ({ time, ...one })));
  await viewer.press('open');
  await viewer.until(() => window.told);
  return viewer.copiedBy('command');
}

test.describe('sharing', { tag: '@full' }, () => {
  test('a link shows the same view at the same time', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2&least=30&height-km=3`);
    await viewer.catchCopies();
    await viewer.settled(() => viewer.key('ArrowRight'));
    const link = await viewer.copiedBy('share');
    const pinned = page.url().replace('time=latest', `time=${encodeURIComponent(await drawnTime(viewer))}`);
    expect(link).toBe(pinned);
    expect(link).toContain('height-km=3');
    const picture = await viewer.pixels();
    // The page offers no command if no command draws the same picture (2026-11-28: the command drew one of several
    // layers).
    await page.evaluate(() => void (window.copied = undefined));
    await viewer.press('command');
    await expect(state(viewer)).toContainText('one layer');
    expect(await copied(page)).toBeNull();
    // Open the link in a new page.
    await page.goto('about:blank');
    await page.goto(link);
    await viewer.drawn();
    expect((await viewer.pixels()).equals(picture), 'the picture is the same').toBe(true);
  });

  test('a command runs in the folder of the raw volume', async ({ viewer, server }) => {
    const { station, program, directory } = server;
    const volume = server.volumes[0];
    await viewer.open(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2`);
    await viewer.catchCopies();
    await viewer.catchLinks();
    await tellVolumes(viewer.page);
    await viewer.press('open');
    await viewer.until(() => window.told);
    const command = await viewer.copiedBy('command');
    // Let a shell split the command.
    const words = execFileSync('sh', ['-c', `printf '%s\\n' ${command}`], { encoding: 'utf8' }).trimEnd().split('\n').slice(1);
    expect(words.slice(0, 2), command).toEqual(['frame', basename(volume)]);
    const drawn = join(directory, 'command.png');
    execFileSync(program, [...words.slice(0, -1), drawn], { cwd: dirname(volume), stdio: 'ignore' });
    expect(readFileSync(drawn).length, 'bytes of the picture that the command draws').toBeGreaterThan(10000);
    expect(command, 'the command names the colors').toContain('--colors ');
    expect(command, 'the command names the size of the page').toContain(`--width ${width} --height ${height}`);
    // 2026-11-28: the button of the raw volume gave the file another name than the command.
    const taken = await viewer.takenBy('raw');
    const file = await fetch(taken.href, { method: 'HEAD' });
    expect(file.status).toBe(200);
    // A browser prefers the name in the answer to the name in the link.
    const saved = file.headers.get('content-disposition')?.match(/filename="(.*)"/)?.[1] ?? taken.name;
    expect(saved, 'the name of the raw volume').toBe(words[1]);
  });

  test('a command draws the shown moment', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2`);
    await viewer.catchCopies();
    // 2026-11-28: the command had the colors of the chosen moment, which was not yet shown.
    const said = await page.evaluate(() => {
      document.getElementById('moment-VEL').click();
      document.getElementById('command').click();
      return document.getElementById('state').textContent;
    });
    expect(said, 'the page refuses while another moment is loading').toContain('not complete');
    expect(await copied(page)).toBeNull();
    await viewer.until(() => document.documentElement.dataset.drawn?.includes('/VEL/'), null, 60_000);
    // 2026-11-28: the command drew range-folded air as clear.
    await viewer.press('command');
    await expect(state(viewer), 'a veil has no command').toContainText('range-folded air');
    expect(await copied(page)).toBeNull();
    // 2026-11-29: the button was still marked for the previous picture.
    const button = viewer.byId('command');
    await expect(button, 'the button is disabled for a veil').not.toHaveAttribute('aria-disabled', 'false');
    await viewer.show(`domain=${station}&moment=VEL&azimuth=200&tilt=60&zoom=2&folded=0`);
    const command = await viewer.copiedBy('command');
    await expect(button, 'the button is enabled without a veil').toHaveAttribute('aria-disabled', 'false');
    expect(command).toContain('--moment VEL');
  });

  test('a saved picture has title, colors and legend', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&azimuth=200&tilt=60&zoom=2&least=30&height-km=3`);
    await viewer.catchLinks();
    const { name, href } = await viewer.takenBy('save');
    expect(href).toMatch(/^data:image\/png/);
    expect(name).toMatch(new RegExp(`^${station}_REF_`));
    const saved = await decoded(page, href);
    expect([saved.width, saved.height]).toEqual([width, height]);
    let letters = 0;
    for (let y = 8; y < 30; ++y) for (let x = 0; x < 300; ++x) if (Math.min(...saved.at(x, y)) > 200) ++letters;
    expect(letters, 'light pixels of a title').toBeGreaterThan(300);
    const bar = await viewer.byId('bar').boundingBox();
    const [left, top, long] = [bar.x, bar.y, bar.height].map(Math.floor);
    const colors = new Set(Array.from({ length: long - 34 }, (_, y) => String(saved.at(left + 6, top + 22 + y))));
    expect(colors.size, 'colors of the bar').toBeGreaterThan(40);
    const pictures = process.env.STORMCELLAR_PICTURES;
    if (!pictures) return;
    mkdirSync(pictures, { recursive: true });
    writeFileSync(join(pictures, 'saved.png'), Buffer.from(href.split(',')[1], 'base64'));
  });

  test('the browser saves a grid as a file', async ({ page, viewer, server: { station, address } }) => {
    await viewer.open(`domain=${station}&moment=REF`);
    const { headers, status } = await fetch(`${address}/api/v1/grids/${await viewer.data('drawn')}/netcdf`);
    expect(status).toBe(200);
    expect(headers.get('content-type')).toContain('netcdf');
    const [download] = await Promise.all([page.waitForEvent('download'), viewer.press('netcdf')]);
    expect(download.url()).toMatch(/\/netcdf$/);
    expect(headers.get('content-disposition')).toContain(download.suggestedFilename());
  });

  // 2026-11-28: the command named an older raw file.
  test('without its raw file, a command reads the cache and says so', async ({ viewer, server: { station } }) => {
    const command = await commandFor(viewer, station, [{ raw: 'OLDER', time: '2016-06-01T14:50:00Z' }]);
    expect(command).toMatch(new RegExp(`^stormcellar frame ${station} `));
    await expect(state(viewer)).toContainText('cache');
  });

  // 2026-11-28: the command and the link named the deleted file.
  test('a raw file that was deleted is not offered', async ({ page, viewer, server: { station } }) => {
    expect(await commandFor(viewer, station, [{ raw: null }])).toMatch(new RegExp(`^stormcellar frame ${station} `));
    await page.evaluate(() => {
      const own = window.fetch;
      const gone = async () => new Response(null, { status: 410 });
      window.fetch = (url, options, ...more) => (options?.method === 'HEAD' ? gone() : own(url, options, ...more));
    });
    await viewer.press('raw');
    await expect(viewer.byId('tool-says')).toContainText('does not have the raw files');
  });

  // 2026-11-29: the page said that there is no raw file.
  test('the page says nothing of the raw file of an evicted grid', async ({ page, viewer, server: { station } }) => {
    // The facts of the grid do not come.
    await page.addInitScript(() => {
      const own = window.fetch;
      const gone = async () => new Response('{"error": "no such grid"}', { status: 404, headers: { 'Stormcellar-Status': '404' } });
      window.fetch = (url, ...more) => (/\/grids\/[^/]+\/REF\/[^/]+$/.test(url) ? gone() : own(url, ...more));
    });
    await viewer.open(`domain=${station}&moment=REF&folded=0`);
    await viewer.press('raw');
    await expect(state(viewer)).toHaveText(`No REF of ${station} for this time. Choose another time or radar.`);
    await expect(viewer.byId('tool-says')).toHaveText('');
  });

  // The volume had two files, and one was deleted (2026-11-28: the command drew the first volume of the file).
  test('a command draws the second volume of a file', async ({ viewer, server: { station } }) => {
    const command = await commandFor(viewer, station, [{ raw: 'TWO', number_in_file: 2 }, { raw: null, number_in_file: 2 }]);
    expect(command).toMatch(/^stormcellar frame TWO /);
    expect(command).toContain('--volume 2');
  });

  // 2026-11-28: the volume was saved under the name of its first chunk.
  test('a volume that came in chunks has a name of its own', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&folded=0`);
    const began = await drawnTime(viewer);
    const joined = station + began.slice(0, 19).replace(/[-:]/g, '').replace('T', '_');
    await tellVolumes(page, [{ raw: joined, number_in_file: 1, time: began }]);
    await viewer.catchLinks();
    const { name, href } = await viewer.takenBy('raw');
    expect(name).toBe(joined);
    expect((await fetch(href, { method: 'HEAD' })).status).toBe(200);
  });

  // 2026-11-28: the command named the raw file, from which the program makes another grid.
  test('the command for an unusual grid reads the cache', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&folded=0`);
    await viewer.catchCopies();
    await viewer.press('open');
    await page.evaluate(() => {
      const spacingAt = 64; // of a packed grid
      const own = window.fetch;
      window.fetch = async (url, ...more) => {
        const answer = await own(url, ...more);
        if (!String(url).includes('/packed')) return answer;
        const bytes = await answer.arrayBuffer();
        new DataView(bytes).setFloat64(spacingAt, 900, true);
        return new Response(bytes);
      };
    });
    await tellVolumes(page);
    await viewer.press('moment-VEL');
    await viewer.until(() => document.documentElement.dataset.drawn?.includes('/VEL/') && window.told);
    expect(await viewer.copiedBy('command')).toMatch(new RegExp(`^stormcellar frame ${station} `));
  });

  // A browser gives no clipboard over plain HTTP (2026-11-28: the page said that it had copied the link).
  test('without a clipboard the page says so', async ({ page, viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF`);
    await page.evaluate(() => {
      Object.defineProperty(navigator, 'clipboard', { value: undefined });
      window.prompt = (said, text) => {
        window.asked = [said, text];
        return null;
      };
    });
    for (const [id, part] of [['share', 'domain='], ['command', 'stormcellar frame']]) {
      await page.evaluate(() => void (window.asked = undefined));
      await viewer.press(id);
      const [said, text] = await viewer.until(() => window.asked);
      expect(said).toContain('not available');
      expect(said).not.toContain('in the clipboard');
      expect(text).toContain(part);
    }
  });

  // A page of another site shows the viewer in a frame (`[web] embed_in`).
  test('an embedded page has the picture without controls', async ({ page, viewer, server: { station } }) => {
    await page.goto(`${viewer.address}/view/?embed=1#domain=${station}&moment=REF`);
    await viewer.drawn();
    expect(await page.locator('button:visible, select:visible, input:visible').count()).toBe(0);
    await expect(page.locator('#title')).toBeVisible();
    await expect(page.locator('#picture')).toBeVisible();
    // 2026-11-30: the needle of the compass was drawn in the upper left corner.
    expect(await page.locator('#compass').boundingBox(), 'the place of the compass').toMatchObject({ width: expect.closeTo(48, 0) });
    await viewer.open(`domain=${station}&moment=REF`);
    expect(await page.locator('button:visible').count(), 'controls of the page itself').toBeGreaterThan(5);
  });
});
