// Sweeps of raw volumes on the page: which cut is shown, all of them to choose from, and loops (scripts/check-viewer).
//   node sweeps.mjs ADDRESS STATION [SEQUENCE]
// SEQUENCE: the station has several volumes, which are played.
import { CheckedPage, check, gridsOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, sequence] = process.argv.slice(2);
await gridsOf(address, [station]);
const browser = await Browser.start();
try {
  const page = await browser.page(500, 400);
  const viewer = new CheckedPage(page, address);
  const evaluate = (text) => page.evaluate(text);
  const press = (id) => evaluate(`document.getElementById('${id}').click()`);
  const json = async (path) => (await fetch(`${address}/api/v1/${path}`)).json();
  const { volumes } = await json(`stations/${station}/volumes`);
  const { sweeps } = await json(`stations/${station}/volumes/${volumes[volumes.length - 1].time}/sweeps`);
  const having = sweeps.filter(({ moments }) => moments.some(({ moment }) => moment === 'REF'));
  const lowest = Math.min(...having.map(({ elevation_deg }) => elevation_deg));
  const atLowest = having.filter(({ elevation_deg }) => elevation_deg <= lowest + 0.2);
  const isOf = (row, moment) => row.moments.some((one) => one.moment === moment);
  const told = () => evaluate("document.getElementById('layers-told').textContent");
  const above = `domain=${station}&moment=REF&volume=0&azimuth=180&tilt=0&field-of-view=0&quality=${encodeURIComponent('64 slices')}`;

  // ---- The cut that pictures take, and every other one (2026-11-28: the Doppler half, and no other, was shown)
  await viewer.open(`${above}&elevation=0.5`);
  const chosen = atLowest.find(({ moments }) => moments.some((one) => one.moment === 'REF' && one.chosen));
  check(`the page shows the cut that pictures take: ${await told()}`, (await told()).includes(chosen.start.slice(11, 19)));
  const options = () => evaluate("[...document.getElementById('sweep-elevation').options].map((one) => one.textContent)");
  check(`each of the ${having.length} cuts is in the list: ${(await options()).slice(0, 4).join(', ')}`, (await options()).length === having.length);
  const other = atLowest.find((row) => row !== chosen);
  if (other) {
    const kind = isOf(other, 'VEL') === isOf(chosen, 'VEL') ? '' : isOf(other, 'VEL') ? 'Doppler' : 'long range';
    await viewer.settled(() => evaluate(`(() => { const list = document.getElementById('sweep-elevation'); list.value = '${other.sweep}'; list.dispatchEvent(new Event('change')); })()`));
    check(`another cut can be chosen: ${await told()}`, (await told()).includes(`${other.start.slice(11, 19)}${kind && ` ${kind}`}`) && (await viewer.number('sweep')) === other.sweep);
    await evaluate(`Object.defineProperty(navigator, 'clipboard', { value: { writeText: (text) => { window.copied = text; return Promise.resolve(); } } })`);
    await press('command');
    const command = await page.until('window.copied');
    check(`the command names it: ${command}`, command.includes(`--product ppi --sweep ${other.sweep} `));
  }

  // ---- The page says what it does not draw (2026-11-28: it told of a surface that it did not draw, and said that
  // there is no sweep if it could not fetch it)
  await viewer.show(`${above}&surface=20&surface-moment=ZZZ`);
  const notShown = await page.until("document.getElementById('layers-told').textContent.includes('not shown') && document.getElementById('layers-told').textContent", 20).catch(told);
  check(`a surface of a moment that is not there: ${notShown}`, notShown.includes('not shown: no ZZZ'));
  // Ten seconds, after which the page asks again, pass in half of one.
  await evaluate(`{
    const [clock, timer] = [performance.now.bind(performance), setTimeout];
    performance.now = () => 20 * clock();
    window.setTimeout = (act, ms, ...more) => timer(act, ms > 10_000 && ms < 11_000 ? ms / 20 : ms, ...more);
  }`);
  await page.send('Fetch.enable', { patterns: [{ urlPattern: '*/sweeps/*' }] });
  const cut = ({ method, params }) => void (method === 'Fetch.requestPaused' && page.send('Fetch.failRequest', { requestId: params.requestId, errorReason: 'ConnectionReset' }));
  browser.listeners.push(cut);
  await viewer.show(`${above}&elevation=9`);
  const failed = await page.until("!document.getElementById('layers-told').textContent.includes('loading') && document.getElementById('layers-told').textContent", 20);
  check(`a sweep that does not come: ${failed}`, failed.includes('could not be loaded'));
  browser.listeners.splice(browser.listeners.indexOf(cut), 1);
  await page.send('Fetch.disable');
  const comes = (part) => page.until(`document.getElementById('layers-told').textContent.includes(${JSON.stringify(part)})`, 20).then(() => true, () => false);
  check('it is asked for again', await comes(`sweep of ${station}: `));
  // 2026-11-28: one failed answer said for good that there is no such moment.
  let isWell = false;
  const fail = ({ method, params }) => {
    if (method !== 'Fetch.requestPaused') return;
    if (isWell) page.send('Fetch.continueRequest', { requestId: params.requestId });
    else page.send('Fetch.fulfillRequest', { requestId: params.requestId, responseCode: 500, responseHeaders: [{ name: 'Content-Type', value: 'application/json' }], body: Buffer.from('{"error":"trouble"}').toString('base64') });
  };
  browser.listeners.push(fail);
  await page.send('Fetch.enable', { patterns: [{ urlPattern: '*/VEL/*/packed*' }] });
  await viewer.show(`${above}&surface=20&surface-moment=VEL`);
  check('a surface that does not come is not said to be absent', await comes('VEL could not be loaded'));
  isWell = true;
  check('it is asked for again', await page.until("document.getElementById('layers-told').textContent.endsWith('m/s')", 20).then(() => true, () => false));
  browser.listeners.splice(browser.listeners.indexOf(fail), 1);
  await page.send('Fetch.disable');
  page.trouble = page.trouble.filter((one) => !/404|500|ERR_CONNECTION_RESET/.test(one));

  // ---- What is hidden is said (2026-11-28: a box, layers that are off, and a veil that is off looked like clear air)
  for (const [view, words] of [
    ['moment=REF&crop-km=-50,50,-50,50,14,16', 'echo outside the box from 14.0 km to 16.0 km is hidden'],
    ['moment=REF&volume=0', 'echo is hidden'],
    ['moment=REF&opacity=0.01', 'opacity × 0.01'],
    ['moment=VEL&folded=0', 'range-folded air is hidden'],
    ['moment=REF&folded=0', ''],
    ['moment=VEL', ''],
  ]) {
    await viewer.show(`domain=${station}&${view}`);
    check(`${view}: ${await told()}`, (await told()) === words);
  }

  // ---- The whole sweep is drawn, also beyond the grid (2026-11-28: it was cut off at the grid's box)
  const echo = (more) => evaluate(`(() => {
    const picture = document.getElementById('picture');
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [picture.width, picture.height];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let count = 0;
    for (let y = 0, i = 0; y < copy.height; ++y) for (let x = 0; x < copy.width; ++x, i += 4) {
      const isColored = Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 50;
      if (isColored && (${more})) ++count;
    }
    return count;
  })()`);
  // At this zoom the grid is a third as high as the picture, and as wide as high.
  await viewer.show(`${above}&elevation=0.5&zoom=0.333&ground=0`);
  const away = 'Math.max(Math.abs(x - copy.width / 2), Math.abs(y - copy.height / 2)) - copy.height / 6';
  const beyond = await echo(`${away} > 3`);
  const within = await echo(`${away} < -3`);
  const reaches = Math.max(...chosen.moments.filter(({ moment }) => moment === 'REF').map(({ gates, gate_spacing_m }) => gates * gate_spacing_m));
  if (reaches > 3e5) check(`of a sweep that reaches ${reaches / 1000} km ${within} pixels are drawn within the grid, ${beyond} beyond`, within > 50 && beyond > 0);

  if (sequence) {
    // ---- A loop never shows an empty map (2026-11-28: all of 24 pictures were empty at 4 frames a second)
    const looks = `window.pen = Object.assign(document.createElement('canvas'), { width: 100, height: 80 }).getContext('2d', { willReadFrequently: true });
      window.shown = () => {
        pen.drawImage(document.getElementById('picture'), 0, 0, 100, 80);
        const { data } = pen.getImageData(0, 0, 100, 80);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) if (Math.max(data[i], data[i + 1], data[i + 2]) > 60) ++count;
        return count;
      }; undefined`;
    await evaluate(looks);
    // Records what the page shows while it plays all times twice: time, layers, and how many pixels are not black.
    const played = async (view) => {
      await viewer.show(view);
      await page.until("Number(document.getElementById('times').max) >= 4");
      const full = await evaluate('shown()');
      await evaluate(`window.seen = []; window.watch = true; window.from = undefined;
        window.look = () => {
          const count = shown();
          window.seen.push([document.getElementById('title').textContent.match(/\\d\\d:\\d\\d:\\d\\d/)?.[0], document.getElementById('layers-told').textContent, count]);
          if (window.watch) requestAnimationFrame(look);
        };
        requestAnimationFrame(look); undefined`);
      await press('play');
      const all = 'new Set(window.seen.slice(window.from ?? 0).map(([time]) => time)).size >= 5';
      await page.until(all, 60);
      await page.until(`(window.from ??= window.seen.length, ${all})`, 60);
      await press('play');
      const seen = await evaluate('(window.watch = false, window.seen)');
      const least = Math.min(...seen.map(([, , count]) => count));
      const empty = seen.filter(([, , count]) => count < 0.1 * full).length;
      check(`${view.slice(view.indexOf('slices') + 7)}: none of ${seen.length} looks at a loop is empty: at least ${least} of ${full} pixels`, full > 20 && empty === 0, `${empty} are`);
      return new Map(seen.map(([time, line]) => [time, line]));
    };
    const alone = `${above}&ground=0`;
    const lines = await played(`${alone}&elevation=0.5`);
    const isOwn = ([time, line]) => Math.abs(Date.parse(`2000-01-01T${line.match(/\d\d:\d\d:\d\d/)?.[0]}Z`) - Date.parse(`2000-01-01T${time}Z`)) < 400e3;
    check(`each time names a sweep of its own volume: ${[...lines].map((one) => one.join(' ')).join('; ')}`, lines.size >= 5 && [...lines].every(isOwn) && new Set(lines.values()).size === lines.size);
    await played(`${alone}&surface=8&surface-moment=VEL`);
    await played(`${alone}&height-km=3`);
    // A grid in parts, whose layers are made of windows of it (2026-11-28: half of what was shown was empty).
    await page.goto('about:blank');
    await viewer.open(`memory=4&${alone}&height-km=3`);
    await evaluate(looks);
    await played(`memory=4&${alone}&height-km=3`);
    await played(`memory=4&${alone}&maximum=1`);
    // There is room for one sweep, beside the one that is shown.
    await played(`memory=4&${alone}&elevation=0.5`);

    // ---- Where the pointer rests, the gate is of the sweep that is drawn (2026-11-28: it was of the one before)
    await page.goto('about:blank');
    await viewer.open(`${alone}&elevation=0.5&zoom=4`);
    await page.until("Number(document.getElementById('times').max) >= 4");
    await page.mouse('mouseMoved', 260, 240);
    let ofDrawn = 0;
    for (let i = 0; i < 4; ++i) {
      await page.until("document.getElementById('hover').textContent.includes('seen at')", 20);
      await viewer.settled(() => press('earlier'));
      const [line, reading] = [await told(), await evaluate("document.getElementById('hover').textContent")];
      const secondsOf = (text, before) => Date.parse(`2000-01-01T${text.slice(text.indexOf(before) + before.length).match(/\d\d:\d\d:\d\d/)?.[0]}Z`) / 1000;
      const afterStart = secondsOf(reading, 'seen at ') - secondsOf(line, '° ');
      if (afterStart >= 0 && afterStart < 60) ++ofDrawn;
      else console.log(`${line}; the pointer reads ${reading}`);
    }
    check(`${ofDrawn} of 4 readings of a resting pointer are of the sweep that is drawn`, ofDrawn === 4);
  }
  check('nothing of the page failed, and the server was never too busy', page.trouble.length === 0, page.trouble.join('\n'));
} finally {
  await browser.end();
}
