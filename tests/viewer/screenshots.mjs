// Makes pictures of the page for README.md and docs/viewer.md, at 1440 x 900: the storms near Moore on 3 May 1999.
//   stormcellar serve KTLX19990503_235621.gz
//   node tests/viewer/screenshots.mjs ADDRESS DIRECTORY
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { openPage, withBrowser } from './viewer_page.mjs';

const [address, pictures] = process.argv.slice(2);
const mostBytes = 200_000;
const scenes = [
  // name of the picture, parameters of the address
  ['viewer-2d', 'moment=REF&view=2d&zoom=3.4&look-at-km=-35,5,0'],
  ['viewer-cells', 'moment=REF&azimuth=190&tilt=62&zoom=3&field-of-view=40&exaggeration=3&light=gradient&look-at-km=-40,18,4&cells=1'],
  ['viewer-panes', 'moment=REF&view=2d&zoom=6&look-at-km=-28,-2,0&pane=VEL&pane=VELD&pane=SW'],
];

// Returns a picture as WebP, of the best quality that is small enough.
async function webp(page, png) {
  for (let quality = 90; quality > 30; quality -= 5) {
    const text = await page.evaluate(
      async ([png, quality]) => {
        const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
        const canvas = new OffscreenCanvas(picture.width, picture.height);
        canvas.getContext('2d').drawImage(picture, 0, 0);
        const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: 'image/webp', quality: quality / 100 })).arrayBuffer());
        return btoa(bytes.reduce((all, byte) => all + String.fromCharCode(byte), ''));
      },
      [png.toString('base64'), quality],
    );
    const bytes = Buffer.from(text, 'base64');
    if (bytes.length <= mostBytes) return bytes;
  }
  throw new Error('the picture is too large');
}

await withBrowser(async (browser) => {
  const viewer = await openPage(browser, address, 1440, 900);
  const converter = await browser.newPage();
  for (const [name, view] of scenes) {
    await viewer.open(`domain=KTLX&${view}`);
    if (view.includes('cells=1')) await viewer.byId('cells').locator('tbody tr').first().waitFor();
    await viewer.drawn();
    const bytes = await webp(converter, await viewer.page.screenshot());
    writeFileSync(join(pictures, `${name}.webp`), bytes);
    console.log(name, bytes.length);
  }
});
