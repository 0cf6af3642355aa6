// Checks what the page draws first in Firefox, which has a renderer of its own (scripts/check-viewer).
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, Slicer, check, gridsOf, mostDifference, shadesOf, viewOf } from './checked_page.mjs';
import { Firefox } from './firefox.mjs';

const [address, station, difference, directory] = process.argv.slice(2);
const browser = await Firefox.start(400, 266);
try {
  const viewer = new CheckedPage(browser, address);
  await viewer.open(`domain=${station}`);
  check('the first picture in Firefox has many colors', shadesOf(await viewer.pixels()).size > 200);
  check('the title names the station', (await browser.evaluate('document.title')).includes(station));
  const slicer = new Slicer(address, await gridsOf(address, [station]), difference, directory);
  for (const field of [0, 40]) {
    const scene = { station, moment: 'REF', azimuth: 180, tilt: 55, zoom: 2, field, exaggeration: 3, opacity: 1, at: [0, 0, 4] };
    await viewer.show(viewOf(scene));
    const picture = join(directory, `firefox-${field}.ppm`);
    writeFileSync(picture, await viewer.pixels());
    const { p99, mean, count } = slicer.compare(await slicer.fileOf(station, 'REF'), picture, scene);
    check(`Firefox, field of view ${field}: dE ${p99} (mean ${mean}) over ${count} pixels, ${await viewer.frameMs()} ms`, p99 <= mostDifference && count > 300);
  }
} finally {
  await browser.end();
}
