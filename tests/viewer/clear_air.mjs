// Clear air has its own colors, also where the grid comes in parts (scripts/check-viewer).
//   node clear_air.mjs ADDRESS STATION
import { CheckedPage, check, gridsOf, shadesOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station] = process.argv.slice(2);
await gridsOf(address, [station]);
const browser = await Browser.start();
try {
  const page = await browser.page(560, 420);
  const viewer = new CheckedPage(page, address);
  // 2026-11-28: with little memory it was drawn with the colors of storms, which show nothing of it.
  for (const memory of [256, 8]) {
    await page.goto('about:blank');
    await viewer.open(`domain=${station}&moment=REF&memory=${memory}&volume=0&maximum=1`);
    await page.evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } }); undefined`);
    await page.evaluate(`document.getElementById('command').click()`);
    const command = await page.until('window.copied');
    const isInParts = page.requests.some((url) => url.includes('half='));
    check(`${memory} MiB: ${command}`, isInParts === (memory < 256) && command.includes('--colors smooth-clear-air') && shadesOf(await viewer.pixels()).size > 100);
  }
} finally {
  await browser.end();
}
