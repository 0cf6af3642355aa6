// Checks what the timeline of the page does with several volumes of one station (scripts/check-viewer).
import { CheckedPage, check, gridsOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station] = process.argv.slice(2);
const browser = await Browser.start();
try {
  const page = await browser.page(796, 532);
  const viewer = new CheckedPage(page, address);
  const grids = await gridsOf(address, [station]);
  const times = grids.filter(({ moment }) => moment === 'REF').map(({ time }) => time);
  // The server takes in the later volumes beside its first answers.
  await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0`);
  const evaluate = (expression) => page.evaluate(expression);
  const press = (id) => evaluate(`document.getElementById('${id}').click()`);
  const choose = (id, value) => evaluate(`(() => { const one = document.getElementById('${id}'); one.value = '${value}'; one.dispatchEvent(new Event('change')); })()`);
  const count = () => evaluate("Number(document.getElementById('times').max) + 1");
  const shown = () => evaluate('document.documentElement.dataset.drawn');
  await page.until(`Number(document.getElementById('times').max) + 1 >= ${times.length}`);
  check(`the timeline has ${await count()} volumes`, (await count()) >= 5);
  check(`the newest is shown: ${await shown()}`, (await viewer.told('time')) === 'latest');

  await viewer.settled(() => press('earlier'));
  const second = await shown();
  await viewer.settled(() => press('earlier'));
  const third = await shown();
  check('a step shows the volume before', third < second);

  // By keys: the newest is followed, a loop begins and ends.
  await viewer.settled(() => page.key('l'));
  check('L follows the newest', (await viewer.told('time')) === 'latest');
  await viewer.settled(() => page.key(','));
  await page.key('>');
  await viewer.settled(() => page.key(','));
  await page.key('<');
  check('< and > set a loop, comma steps', (await evaluate("!document.getElementById('loop-all').hidden")) && (await shown()) === third);
  await press('loop-all');
  await viewer.settled(() => page.key('.'));
  await viewer.settled(() => page.key(','));

  // Playback shows loaded pictures alone: never one of another time than the page says.
  await press('loop-to');
  await viewer.settled(() => press('earlier'));
  await press('loop-from');
  await choose('speed', 15);
  await evaluate(`window.seen = new Set(); new MutationObserver(() => window.seen.add(document.documentElement.dataset.drawn)).observe(document.documentElement, { attributes: true })`);
  await press('play');
  await page.until('window.seen.size >= 2', 30);
  await new Promise((done) => setTimeout(done, 1500));
  await press('play');
  const seen = await evaluate('[...window.seen].filter(Boolean)');
  check(`playback stays in its loop: ${seen.length} volumes`, seen.length === 2 && seen.includes(third));

  // Frames between volumes.
  await press('loop-all');
  const before = await count();
  const kept = await page.until('document.documentElement.dataset.drawn');
  await choose('between', 60);
  await page.until(`Number(document.getElementById('times').max) + 1 > ${3 * before}`);
  check('the volume that is shown stays', (await page.until('document.documentElement.dataset.drawn')) === kept);
  await press('later');
  // The server makes it first.
  await page.until("document.getElementById('title').textContent.includes('made between volumes')", 60).catch(() => undefined);
  const after = await count();
  check(`with frames every minute the timeline has ${after} times`, after > 3 * before);
  const title = await evaluate("document.getElementById('title').textContent");
  check(`the title says what it is: ${title}`, title.includes('made between volumes') && title.includes(':00 UTC'));
  check('the address says it', (await viewer.told('between')) === '60');
  // 2026-11-28: it said that there was no volume of the time of one.
  const notice = await evaluate("document.getElementById('notice').textContent");
  check(`nothing is missing${notice}`, notice === '');

  // ---- A link to a volume among frames in between, and a pause before anything else was shown (2026-11-28: "no volume
  // of" a time of which there is one; the oldest volume took the place of the newest)
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0&time=${times[1]}&between=60`);
  const noticeOf = () => evaluate("document.getElementById('notice').textContent");
  check(`the volume of a link is there${await noticeOf()}`, (await shown()).endsWith(times[1]) && (await noticeOf()) === '');
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0`);
  await page.until(`Number(document.getElementById('times').max) + 1 >= ${times.length}`);
  await press('play');
  await press('play');
  await evaluate("document.getElementById('moment-VEL').click()");
  await page.until("document.documentElement.dataset.drawn.includes('/VEL/')", 30);
  check(`who paused stays at the newest: ${await shown()}${await noticeOf()}`, (await shown()).endsWith(times.at(-1)) && (await noticeOf()) === '');

  // ---- A link to a time between two volumes (2026-11-28: the later one was called the nearest)
  const wanted = new Date(Date.parse(times[1]) + 60_000).toISOString();
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0&time=${wanted}`);
  const told = await evaluate("document.getElementById('notice').textContent");
  check(`a minute after ${times[1]}: ${told}`, (await shown()).endsWith(times[1]) && told.includes('the nearest'));
  check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));

  // ---- Instants for which there is no frame (2026-11-28: the next one was called the nearest)
  await page.goto('about:blank');
  const soon = new Date(Date.parse(times[0]) + 46_000).toISOString().slice(0, 19);
  await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0&time=${soon}Z&between=60`);
  check(`nothing is made at ${soon}: ${await shown()}, ${await noticeOf()}`, (await shown()).endsWith(times[0]) && (await noticeOf()).includes('the nearest'));
  await viewer.settled(() => press('later'));
  check(`a step goes on to what is made: ${await shown()}`, !(await shown()).endsWith(times[0]) && (await noticeOf()) === '');
} finally {
  await browser.end();
}
