// Draws the page's view with the slicer, and compares the pictures.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { decoded } from './pixels.mjs';

// Largest allowed difference between page and slicer: 99th percentile of CIEDE2000 over the pixels that show echo.
export const mostDifference = 2;

// Returns the view of a scene, which has only the volume.
export const viewOf = ({ station, moment, azimuth, tilt, zoom, field, exaggeration, opacity, at }) =>
  `domain=${station}&moment=${moment}&ground=0&azimuth=${azimuth}&tilt=${tilt}&zoom=${zoom}&field-of-view=${field}` +
  `&exaggeration=${exaggeration}&opacity=${opacity}&folded=0&look-at-km=${at.join(',')}`;

// Draws the page's volumes with the slicer.
export class Slicer {
  // `difference` is the program viewer_difference. Files go to `directory`, and pictures to `pictures` if it is set.
  constructor({ address, difference, directory, pictures = process.env.STORMCELLAR_PICTURES }) {
    Object.assign(this, { address, difference, directory, pictures, files: new Map() });
  }
  // Returns the path of a file with the newest grid; null if the server has none.
  async fileOf(station, moment) {
    const name = `${station}-${moment}.scg`;
    if (!this.files.has(name)) {
      const answer = await fetch(`${this.address}/api/v1/grids/${station}/${moment}/latest/file`);
      if (answer.ok) writeFileSync(join(this.directory, name), Buffer.from(await answer.arrayBuffer()));
      this.files.set(name, answer.ok ? join(this.directory, name) : null);
    }
    return this.files.get(name);
  }
  // Returns the difference between a picture and the slicer's picture in CIEDE2000: 99th percentile, mean, greatest,
  // and number of pixels. `before` and `behind` are more arguments for viewer_difference.
  async compare(scene, ppm, { name = 'picture', before = [], behind = [] } = {}) {
    const { azimuth, tilt, zoom, field, exaggeration, opacity, at } = scene;
    if (this.pictures) mkdirSync(this.pictures, { recursive: true });
    const picture = join(this.pictures || this.directory, `${name}.ppm`);
    writeFileSync(picture, ppm);
    const view = [azimuth, tilt, zoom, field, exaggeration, opacity, ...at.map((km) => km * 1000)].map(String);
    const words = [...before, await this.fileOf(scene.station, scene.moment), picture, ...view, ...behind];
    if (this.pictures) words.push(join(this.pictures, `${name}-slicer.png`));
    const said = execFileSync(this.difference, words, { encoding: 'utf8' });
    const [p99, mean, most, count] = said.trim().split(' ').map(Number);
    return { p99, mean, most, count };
  }
}

// Returns the picture of `stormcellar frame`.
export async function pictureOf(page, program, words, w, h, directory) {
  const file = join(directory, 'frame.png');
  execFileSync(program, ['frame', ...words, '--width', w, '--height', h, '-o', file].map(String), { stdio: 'ignore' });
  return decoded(page, `data:image/png;base64,${readFileSync(file).toString('base64')}`);
}
