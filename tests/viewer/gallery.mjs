// Makes the pairs of pictures in docs/gallery.md: the picture of the page, and the picture of the command that the page
// copies.
//   node tests/viewer/gallery.mjs PROGRAM ADDRESS DIRECTORY_OF_VOLUMES DIRECTORY_OF_PICTURES
import { execFileSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';

import { openPage, withBrowser } from './viewer_page.mjs';

const [program, address, volumes, pictures] = process.argv.slice(2);
const [width, height] = [796, 532];
const scenes = [
  // name of the picture, station, other parameters of the address
  ['supercells', 'KTLX', 'azimuth=190&tilt=62&zoom=3.2&field-of-view=40&exaggeration=3&light=gradient&look-at-km=-45,15,4'],
  ['hurricane', 'KCRP', 'azimuth=180&tilt=50&zoom=1.6&field-of-view=40&exaggeration=4&light=gradient'],
  ['tornadoes', 'KDMX', 'azimuth=180&tilt=58&zoom=1.7&field-of-view=40&exaggeration=4&light=gradient'],
  ['outer-bands', 'KLIX', 'azimuth=180&tilt=55&zoom=1.3&field-of-view=40&exaggeration=5&light=gradient'],
  ['rain', 'KLBB', 'azimuth=180&tilt=60&zoom=2&field-of-view=40&exaggeration=4&light=gradient'],
  ['winter', 'KOKX', 'azimuth=180&tilt=45&zoom=1.6&field-of-view=40&exaggeration=6&opacity=2&light=gradient'],
];

await withBrowser(async (browser) => {
  const viewer = await openPage(browser, address, width, height);
  await viewer.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await viewer.open(`domain=${scenes[0][1]}&moment=REF&zoom=0.9`);
  for (const [name, station, more] of scenes) {
    const volume = readdirSync(volumes).find((file) => file.startsWith(`${station}${{ KTLX: 1999, KDMX: 2022, KLBB: 2016 }[station] ?? ''}`));
    await viewer.show(`domain=${station}&moment=REF&${more}`);
    await viewer.page.screenshot({ path: join(pictures, `viewer-${name}.png`) });
    await viewer.press('command');
    const words = (await viewer.page.evaluate(() => navigator.clipboard.readText())).split(' ').slice(1);
    words[1] = join(volumes, volume);
    words[words.indexOf('-o') + 1] = join(pictures, `slicer-${name}.png`);
    console.log(name, words.join(' '));
    execFileSync(program, words, { stdio: 'inherit' });
  }
});
