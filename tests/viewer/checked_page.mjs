// The viewer's page in a browser, and what checks of it share.
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

// The largest difference allowed between page and slicer: CIEDE2000, 99th percentile of the pixels that show echo.
export const mostDifference = 2;

// Says what holds and what does not; the program's status follows.
export function check(what, holds, more = '') {
  console.log(holds ? what : `FAILED: ${what} ${more}`);
  if (!holds) process.exitCode = 1;
}

// Seconds for a picture, on a machine that compiles beside.
const patience = 120;
const drawn = 'document.documentElement.dataset.drawn';

export class CheckedPage {
  // `page` evaluates expressions in the page: of devtools.mjs or firefox.mjs.
  constructor(page, address) {
    Object.assign(this, { page, address });
  }
  async open(view = '') {
    await this.page.goto(`${this.address}/view/#${view}`);
    await this.page.until(drawn, patience);
  }
  // Changes the view, and waits for its fine picture. A picture that is drawn before the page has taken the address
  // does not count.
  async show(view) {
    await this.page.evaluate(`new Promise((done) => {
      addEventListener('hashchange', () => { delete ${drawn}; done(); }, { once: true });
      location.hash = ${JSON.stringify(view)};
    })`);
    await this.page.until(drawn);
  }
  // Waits for the fine picture after an act.
  async settled(act) {
    await this.page.evaluate(`delete ${drawn}; undefined`);
    await act();
    await this.page.until(drawn, patience);
  }
  frameMs() {
    return this.page.evaluate('document.documentElement.dataset.frameMs');
  }
  // Returns what the address says.
  told(name) {
    return this.page.evaluate(`new URLSearchParams(location.hash.slice(1)).get(${JSON.stringify(name)})`);
  }
  async number(name) {
    return Number(await this.told(name));
  }
  async changes(what, name, act, holds) {
    const before = await this.number(name);
    await this.settled(act);
    const after = await this.number(name);
    check(`${what}: ${name} ${before} to ${after}`, holds(before, after));
  }
  // The pixels of the picture as bytes of a portable pixmap, in its own size or as large as the page shows it.
  async pixels(width = 0, height = 0) {
    const text = await this.page.evaluate(`(() => {
    const picture = document.getElementById('picture');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [${width} || picture.width, ${height} || picture.height];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0, copy.width, copy.height);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let text = '';
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return copy.width + ' ' + copy.height + ' ' + btoa(text);
  })()`);
    const [w, h, bytes] = text.split(' ');
    return Buffer.concat([Buffer.from(`P6\n${w} ${h}\n255\n`), Buffer.from(bytes, 'base64')]);
  }
}

export const shadesOf = (ppm) => new Set(Array.from({ length: Math.floor((ppm.length - 15) / 3) }, (_, i) => ppm.readUIntBE(15 + 3 * i, 3)));

// A portable pixmap as pixels.
export function image(ppm) {
  const [, w, h] = ppm.toString('latin1', 0, 40).match(/^P6\n(\d+) (\d+)\n255\n/).map(Number);
  const from = ppm.length - 3 * w * h;
  return { width: w, height: h, at: (x, y) => [...ppm.subarray(from + 3 * (y * w + x), from + 3 * (y * w + x) + 3)] };
}

// The picture of `stormcellar frame`, which the browser reads.
export async function pictureOf(page, program, words, w, h, directory) {
  const file = join(directory, 'frame.png');
  execFileSync(program, ['frame', ...words, '--width', String(w), '--height', String(h), '-o', file], { stdio: 'ignore' });
  const text = await page.evaluate(`(async () => {
    const picture = new Image();
    picture.src = 'data:image/png;base64,${readFileSync(file).toString('base64')}';
    await picture.decode();
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [picture.width, picture.height];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let text = '';
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return btoa(text);
  })()`);
  return image(Buffer.concat([Buffer.from(`P6\n${w} ${h}\n255\n`), Buffer.from(text, 'base64')]));
}

// Latitude and longitude of a text that says them as the page does: "35.292 N, 97.561 W".
export function placeOf(text) {
  const [, latitude, north, longitude, east] = text.match(/(\d+\.\d+) ([NS]), (\d+\.\d+) ([EW])/);
  return [Number(latitude) * (north === 'S' ? -1 : 1), Number(longitude) * (east === 'W' ? -1 : 1)];
}

// The grids of some stations, once there are some; the server may still be making them.
export async function gridsOf(address, stations) {
  const ofOne = async (domain) => {
    for (let tries = 0; tries < 300; ++tries) {
      const { grids } = await (await fetch(`${address}/api/v1/grids?domain=${domain}&limit=10000`)).json();
      if (grids.some(({ moment }) => moment === 'REF')) return grids;
      await new Promise((done) => setTimeout(done, 100));
    }
    throw new Error(`there is no grid of ${domain}`);
  };
  return (await Promise.all(stations.map(ofOne))).flat();
}

// Draws the page's volumes with the slicer.
export class Slicer {
  // `difference` is the program of that name beside this file; files go to `directory`.
  constructor(address, grids, difference, directory) {
    Object.assign(this, { address, grids, difference, directory, files: new Map(), before: [] });
  }
  async fileOf(domain, moment) {
    const grid = this.grids.find((one) => one.domain === domain && one.moment === moment);
    if (!grid) return null;
    if (!this.files.has(grid.path)) {
      const file = join(this.directory, `${domain}-${moment}.scg`);
      const answer = await fetch(`${this.address}${grid.path}/file`);
      writeFileSync(file, Buffer.from(await answer.arrayBuffer()));
      this.files.set(grid.path, file);
    }
    return this.files.get(grid.path);
  }
  // Returns the CIEDE2000 of a picture: 99th percentile, mean, greatest, and the number of pixels. `before` has words
  // for the program.
  compare(file, picture, scene, more = []) {
    const { azimuth, tilt, zoom, field, exaggeration, opacity, at } = scene;
    const words = [azimuth, tilt, zoom, field, exaggeration, opacity, ...at.map((km) => km * 1000)].map(String);
    const [p99, mean, most, count] = execFileSync(this.difference, [...this.before, file, picture, ...words, ...more], { encoding: 'utf8' }).trim().split(' ').map(Number);
    return { p99, mean, most, count };
  }
}

// The view of a scene: the volume alone.
export const viewOf = ({ station, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at }) =>
  `domain=${station}&moment=${moment}&ground=0&azimuth=${azimuth}&tilt=${tilt}&zoom=${zoom}&field-of-view=${field}` +
  `&exaggeration=${exaggeration}&opacity=${opacity}&folded=0&look-at-km=${at.join(',')}`;
