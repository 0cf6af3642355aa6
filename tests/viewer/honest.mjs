// Checks what the page says of things that are not there: a radar, a moment or a time of a link, the server, news, the
// graphics processor (scripts/check-viewer). It passes requests on to the server, so that it can cut them off.
//   node honest.mjs ADDRESS STATION OTHER_STATION
import { createServer, request } from 'node:http';

import { CheckedPage, check, gridsOf } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, other] = process.argv.slice(2);
const grids = await gridsOf(address, [station, other]);
const upstream = new URL(address);

// ---- A server that can go away, tell of events, and have another list of times
let events = [];
let listed = (path, body) => body;
let isRefusing = false; // it has no place for another stream
let isStopped = false; // a proxy in front of it says so, in one of these ways
const refusals = [
  [502, 'text/html', '<h1>Bad gateway</h1>'],
  [404, 'text/plain; charset=utf-8', '404 page not found'],
  [503, 'text/plain', 'no healthy upstream'],
  [401, 'text/html', '<h1>Sign in</h1>'],
  [200, 'text/html', '<h1>We are back soon</h1>'],
  [502, 'application/json', '{"message": "Bad Gateway"}'],
  [401, 'application/json', '{"message": "Unauthorized"}'],
  [404, 'application/json', '{"error": "Not Found"}'],
  [500, 'application/json', '{"error": "There was a problem proxying the request"}'],
];
let refusal = refusals[0];
let isHanging = false; // it takes connections, and sends nothing
let isBreaking = (path) => false; // it breaks off before it answers
let isSlow = (path) => false; // it answers two seconds later
const streams = new Set();
setInterval(() => isHanging || streams.forEach((stream) => stream.write(': heartbeat\n\n')), 200).unref();
function pass(asked, answer, waited = false) {
  if (isHanging) return;
  if (!waited && isSlow(asked.url)) return void setTimeout(() => pass(asked, answer, true), 2000);
  if (isBreaking(asked.url)) return void answer.destroy();
  if (isStopped) return void answer.writeHead(refusal[0], { 'Content-Type': refusal[1] }).end(refusal[2]);
  if (asked.url.startsWith('/api/v1/events')) {
    if (isRefusing) return void answer.writeHead(refusal[0], { 'Retry-After': '10', 'Content-Type': refusal[1] }).end(refusal[2]);
    answer.writeHead(200, { 'Content-Type': 'text/event-stream' });
    answer.write(`retry: 200\n\n${events.join('')}`);
    streams.add(answer);
    answer.on('close', () => streams.delete(answer));
    return;
  }
  const { host, hostname, port } = upstream;
  // Whole answers alone can be changed: a browser that has one is not told that it is the same.
  const { 'if-none-match': known, ...headers } = asked.headers;
  const to = request({ hostname, port, path: asked.url, headers: { ...headers, host, 'accept-encoding': 'identity' } }, (from) => {
    const parts = [];
    from.on('data', (part) => parts.push(part));
    from.on('end', () => {
      const body = listed(asked.url, Buffer.concat(parts));
      const { 'content-length': length, ...headers } = from.headers;
      answer.writeHead(from.statusCode, headers);
      answer.end(body);
    });
  });
  to.on('error', () => answer.destroy());
  to.end();
}
let server;
const begin = (port) => new Promise((done) => (server = createServer((asked, answer) => pass(asked, answer)).listen(port, '127.0.0.1', () => done(server.address().port))));
const port = await begin(0);
const cut = () => new Promise((done) => {
  server.close(done);
  server.closeAllConnections();
});
const tell = (kind, data) => streams.forEach((stream) => stream.write(`event: ${kind}\ndata: ${JSON.stringify(data)}\n\n`));

const browser = await Browser.start();
try {
  const page = await browser.page(700, 440);
  const viewer = new CheckedPage(page, `http://127.0.0.1:${port}`);
  const text = (id) => page.evaluate(`document.getElementById('${id}').textContent`);
  const says = (id, part, seconds = 30) => page.until(`document.getElementById('${id}').textContent.includes(${JSON.stringify(part)}) && document.getElementById('${id}').textContent`, seconds).catch(() => '');

  // ---- Links to what is not there (2026-11-28: another radar was opened without a word)
  await page.goto(`${viewer.address}/view/#domain=KXXX&moment=REF&time=latest`);
  const isAlone = station === other; // then it is shown, and the map is not
  check(`a radar that is not there: ${await says('notice', 'No data for KXXX')}`, (await text('notice')).includes('KXXX') && (await page.evaluate("document.getElementById('start').hidden")) === isAlone);
  check('the map says it too', (await text('start-notice')) === (await text('notice')));
  await viewer.open(`domain=${station}&moment=XXX&time=2099-01-01T00:00:00Z`);
  check(`a moment and a time that are not there: ${await text('notice')}`, (await text('notice')).includes(`${station} has no XXX`) && (await text('notice')).includes('2099-01-01 00:00:00'));
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=yesterday`);
  check(`a time that is none: ${await text('notice')}`, (await text('notice')).includes('yesterday is no time'));
  await viewer.show(`domain=${station}&moment=REF&surface=20&surface-moment=XXX`);
  check(`a surface of a moment that is not there: ${await says('layers-told', 'no XXX for this time')}`, (await text('layers-told')).includes('no XXX for this time'));
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  if (!isAlone) {
    isSlow = (path) => path.startsWith('/tiles/');
    await page.goto('about:blank');
    await page.goto(`${viewer.address}/view/`);
    check(`echo that is on its way (2026-11-28: it looked like clear air): ${await says('start-card', 'not loaded yet')}`, (await text('start-card')).includes('not loaded yet'));
    isSlow = () => false;
    check('it has come', await page.until("document.getElementById('start-card').textContent === ''", 30).then(() => true, () => false));
    await page.goto('about:blank');
    await viewer.open(`domain=${station}&moment=REF&time=latest`);
  }
  check('what is there needs no notice', (await text('notice')) === '');
  await page.evaluate(`location.hash = 'domain=${station}&moment=REF&time=tomorrow'`);
  check(`a time that is none in the same window (2026-11-28: nothing was said): ${await says('notice', 'tomorrow is no time')}`, (await text('notice')).includes('tomorrow'));
  check('what is no link of ours is no region', await page.evaluate(`(location.hash = 'domain=' + encodeURIComponent('region:-100,33,-95,37,/REF;x'), true)`) && (await says('notice', 'No data for region')) !== '');
  check('a link is taken though the page wrote its own address meanwhile', await page.evaluate(`(location.hash = 'domain=KYYY&moment=REF', history.replaceState(null, '', '#domain=${station}&moment=REF'), true)`) && (await says('notice', 'No data for KYYY')) !== '');
  await page.goto('about:blank');

  // ---- A radar that comes later (2026-11-28: the page said for good that it is not there)
  listed = (path, body) => (path.startsWith('/api/v1/domains') ? JSON.stringify({ domains: JSON.parse(body).domains.filter((one) => one.domain !== other) }) : body);
  await page.goto(`${viewer.address}/view/#domain=${other}&moment=REF&time=latest`);
  const isTold = await says('notice', `No data for ${other}`);
  listed = (path, body) => body;
  const isNotSaidAnyMore = () => page.until("document.getElementById('notice').textContent === ''", 10).then(() => true, () => false);
  tell('volume_complete', { type: 'volume_complete', domain: other, station: other, moment: 'REF', grid: grids.find((grid) => grid.domain === other).time });
  check(`a radar that comes later: ${isTold}`, station === other || (isTold !== '' && (await isNotSaidAnyMore())));
  // The same of a moment, while nothing is heard.
  await page.goto('about:blank');
  listed = (path, body) => (path.startsWith('/api/v1/domains') ? JSON.stringify({ domains: JSON.parse(body).domains.map((one) => ({ ...one, moments: one.moments.filter(({ moment }) => moment === 'REF') })) }) : body);
  await page.goto(`${viewer.address}/view/#domain=${station}&moment=VEL&time=latest`);
  const isWithout = await says('notice', `${station} has no VEL`);
  listed = (path, body) => body;
  events = ['event: reset\ndata: {"type":"reset","reason":"another run"}\n\n'];
  streams.forEach((stream) => stream.end());
  check(`a moment that comes while nothing is heard: ${isWithout}`, isWithout !== '' && (await isNotSaidAnyMore()));
  events = [];
  await page.goto('about:blank');

  // ---- A server that is gone (2026-11-28: the page looked as if it were live)
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  const lit = "document.getElementById('follow').getAttribute('aria-pressed')";
  check('the newest is followed', (await page.evaluate(lit)) === 'true');
  await cut();
  check(`a server that is gone: ${await says('notice', 'does not answer')}`, (await text('notice')).includes('does not answer') && (await page.evaluate(lit)) === 'false');
  const isQuiet = () => page.until("document.getElementById('notice').textContent === ''", 30).then(() => true, () => false);

  // ---- News that came meanwhile (2026-11-28: the page stayed with the old picture)
  const before = page.requests.filter((url) => url.includes('/api/v1/grids?')).length;
  events = ['event: reset\ndata: {"type":"reset","reason":"another run"}\n\n'];
  await begin(port);
  check('the server is back, and nothing is said', (await isQuiet()) && (await page.evaluate(lit)) === 'true');
  const requests = (part) => page.requests.filter((url) => url.includes(part)).length;
  const asksFor = async (part, more) => {
    for (let tries = 0; tries < 300 && requests(part) < more; ++tries) await new Promise((done) => setTimeout(done, 50));
    return requests(part) >= more;
  };
  check('it asks for the lists anew', await asksFor('/api/v1/grids?', before + 1));
  const asked = requests('/api/v1/grids?');
  tell('reset', { type: 'reset', reason: 'events were lost' });
  check('and so it does when events were lost', await asksFor('/api/v1/grids?', asked + 1));

  // ---- A server behind a proxy that is gone (2026-11-28, 29: the page looked as if it were live)
  for (refusal of refusals) {
    isStopped = true;
    streams.forEach((stream) => stream.end());
    check(`a server that is gone behind a proxy that says ${refusal[0]} ${refusal[1]}: ${await says('notice', 'does not answer')}`, (await text('notice')).includes('does not answer') && (await page.evaluate(lit)) === 'false');
    isStopped = false;
    check('it is back', (await isQuiet()) && (await page.evaluate(lit)) === 'true');
  }

  // 2026-11-28: a region that was asked for meanwhile was not asked for again.
  isStopped = true;
  streams.forEach((stream) => stream.end());
  await page.evaluate("location.hash = 'domain=region:-104,31,-99,36&moment=REF'; undefined");
  await says('notice', 'does not answer');
  isStopped = false;
  check('a region that was asked for while it was gone is drawn', await page.until("document.documentElement.dataset.drawn.startsWith('region:') && document.getElementById('notice').textContent === ''", 30).then(() => true, () => false));
  await viewer.settled(() => page.evaluate(`location.hash = 'domain=${station}&moment=REF'; undefined`));

  // ---- A grid that was made again while another moment was shown (2026-11-28: the page kept the old one)
  const time = (await page.evaluate('document.documentElement.dataset.drawn')).split('/').pop();
  for (const moment of ['VEL', 'REF']) await viewer.settled(() => page.evaluate(`document.getElementById('moment-${moment}').click()`));
  const velocities = `/${station}/VEL/${encodeURIComponent(time)}/packed`;
  const loaded = requests(velocities);
  await viewer.settled(() => page.evaluate(`document.getElementById('moment-VEL').click()`));
  check('what was loaded is not loaded again', requests(velocities) === loaded);
  await viewer.settled(() => page.evaluate(`document.getElementById('moment-REF').click()`));
  tell('sweep_gridded', { type: 'sweep_gridded', domain: station, station, moment: 'VEL', grid: time });
  await new Promise((done) => setTimeout(done, 500));
  await viewer.settled(() => page.evaluate(`document.getElementById('moment-VEL').click()`));
  check('what was made again is', requests(velocities) > loaded);
  await viewer.settled(() => page.evaluate(`document.getElementById('moment-REF').click()`));

  // ---- A radar that is silent, and speaks again
  tell('station_silent', { type: 'station_silent', station, silent_s: 840 });
  check(`a silent radar: ${await says('notice', 'silent')}`, (await text('notice')).includes(`${station} is silent: nothing came for 14 min`) && (await page.evaluate(lit)) === 'false');
  tell('station_spoke', { type: 'station_spoke', station });
  check('it speaks again', await isQuiet());
  // 2026-11-28: when the news that it speaks were lost, it stayed silent for good.
  tell('station_silent', { type: 'station_silent', station, silent_s: 840 });
  await says('notice', 'silent');
  tell('reset', { type: 'reset', reason: 'events were lost' });
  check('after lost events it is asked who is silent', await isQuiet());

  // ---- A graphics processor that is lost, and comes back (2026-11-28: it looked like clear air)
  await page.evaluate(`window.loser = document.getElementById('picture').getContext('webgl2').getExtension('WEBGL_lose_context'); loser.loseContext()`);
  check(`a lost graphics processor: ${await says('notice', 'graphics processor')}`, (await page.evaluate("!document.getElementById('reload').hidden && getComputedStyle(document.getElementById('labels')).visibility")) === 'hidden');
  await viewer.settled(() => page.evaluate('loser.restoreContext()'));
  check('it is back', (await text('notice')) === '' && (await page.evaluate("getComputedStyle(document.getElementById('labels')).visibility")) === 'visible');

  // ---- How old the data are
  const timeAt = 136; // of a packed grid
  const hour = BigInt(Date.now() - 3600e3);
  listed = (path, body) => {
    if (path.includes('/packed') && body.length > timeAt + 8) body.writeBigInt64LE(hour, timeAt);
    return body;
  };
  await page.send('Network.setCacheDisabled', { cacheDisabled: true });
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  check(`the title tells the age of what is shown: ${await text('title')}`, /6[01] min ago/.test(await text('title')));
  // The clock of this browser is two hours behind, and it waits less for a server (2026-11-28: ages were told by it).
  const { identifier } = await page.send('Page.addScriptToEvaluateOnNewDocument', {
    source: `const [clock, timer] = [Date.now, setTimeout]; Date.now = () => clock() - 7200e3;
      window.setTimeout = (act, ms, ...more) => timer(act, ms === 40000 ? 1500 : ms, ...more);`,
  });
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  check(`by the clock of the server: ${await text('title')}`, /6[01] min ago/.test(await text('title')));

  // ---- A server that takes connections and says nothing (2026-11-28: it looked alive)
  isHanging = true;
  check(`a server that hangs: ${await says('notice', 'does not answer')}`, (await text('notice')).includes('does not answer'));
  isHanging = false;
  check('it goes on', await isQuiet());

  // ---- A server without a place for another stream (2026-11-28: it was said not to answer)
  isRefusing = true;
  refusal = [503, 'text/plain; charset=utf-8', 'As many as there may be'];
  await page.goto('about:blank');
  const lists = requests('/api/v1/grids?');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  check('without events the lists are asked for again', (await asksFor('/api/v1/grids?', lists + 2)) && (await isQuiet()));
  // 2026-11-29: where somebody on the way refused the stream alone, the server seemed to be gone.
  refusal = [403, 'text/html', '<h1>Forbidden</h1>'];
  streams.forEach((stream) => stream.end());
  await page.goto('about:blank');
  const more = requests('/api/v1/grids?');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  check('and where a proxy refuses events', (await asksFor('/api/v1/grids?', more + 2)) && (await isQuiet()));
  isRefusing = false;
  await page.send('Page.removeScriptToEvaluateOnNewDocument', { identifier });

  // ---- A radar that fell silent before the page was opened (2026-11-28: nothing was said)
  listed = (path, body) => {
    if (!path.startsWith('/api/v1/stations')) return body;
    const all = JSON.parse(body.toString());
    for (const one of all.stations) one.silent_s = one.station === station ? 840 : null;
    return Buffer.from(JSON.stringify(all));
  };
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  check(`silent before: ${await says('notice', 'silent')}`, (await text('notice')).includes(`${station} is silent: nothing came for 14 min`));

  // ---- A volume of a wrong time in the future (2026-11-28: the page followed it for good)
  listed = (path, body) => {
    if (body.length === 0 || !path.startsWith('/api/v1/grids?')) return body;
    const all = JSON.parse(body.toString());
    all.grids.push({ ...all.grids.at(-1), time: '2099-01-01T00:00:00Z' });
    return Buffer.from(JSON.stringify(all));
  };
  await page.goto('about:blank');
  await viewer.open(`domain=${station}&moment=REF&time=latest`);
  const followed = await page.evaluate('document.documentElement.dataset.drawn');
  check(`what is followed is not of the future: ${followed}`, followed.endsWith(time) && (await text('follow')) === 'Newest');

  // ---- A list that does not come, before anything is shown (2026-11-28: it said that it tries again, and did not)
  const old = ['2001-01-01T00:00:00Z', '2001-01-01T00:05:00Z'];
  listed = (path, body) => {
    if (body.length === 0 || !/^\/api\/v1\/(domains|grids\?)/.test(path)) return body;
    const all = JSON.parse(body.toString());
    for (const one of all.domains ?? []) if (one.domain === station) one.moments = one.moments.filter(({ moment }) => moment === 'REF');
    if (all.grids?.length > 0) all.grids.unshift(...old.map((time) => ({ ...all.grids[0], time })));
    return Buffer.from(JSON.stringify(all));
  };
  events = [];
  isBreaking = (path) => path.startsWith('/api/v1/grids?');
  const isTrue = (condition) => page.until(condition, 15).then(() => true, () => false);
  await page.goto('about:blank');
  await page.goto(`${viewer.address}/view/#domain=${station}&moment=REF&time=latest`);
  const trying = await says('state', 'Trying again');
  check(`a list that does not come: ${trying}`, trying !== '');
  isBreaking = () => false;
  check('it is asked for again', await isTrue('document.documentElement.dataset.drawn'));

  // ---- A moment that comes after the first one of its radar (2026-11-28: it got no button), and volumes that are
  // evicted (2026-11-28: the timeline kept them, and a loop waited for them)
  isSlow = (path) => path.includes('2001-01-01');
  await page.evaluate("document.getElementById('earlier').click(); document.getElementById('later').click()");
  await new Promise((done) => setTimeout(done, 3500));
  check(`what fails late is not said of what is shown (2026-11-28: it was): ${await text('state')}`, !(await text('state')).includes('no picture'));
  isSlow = () => false;
  let hasMore = true; // than those of a list
  const hasTimes = (count) => isTrue(`Number(document.getElementById('times').max) + 1 === ${count}`);
  const stored = grids.filter(({ domain, moment }) => domain === station && moment === 'REF').length;
  check('the page has what the lists have', (await hasTimes(stored + 2)) && (await page.evaluate("!document.getElementById('moment-VEL')")));
  listed = (path, body) => path.startsWith('/api/v1/grids?') ? Buffer.from(JSON.stringify({ ...JSON.parse(body.toString()), more: hasMore })) : body;
  tell('volume_complete', { type: 'volume_complete', domain: station, station, moment: 'VEL', grid: time });
  check('a moment that comes later gets its button', await isTrue("document.getElementById('moment-VEL')"));
  const evict = (gone, oldest) => tell('grid_evicted', { type: 'grid_evicted', domain: station, moment: 'REF', count: 1, from: gone, to: gone, grids: [gone], oldest });
  evict(old[0], old[1]);
  check('an evicted volume leaves the timeline', await hasTimes(stored + 1));
  hasMore = false;
  evict(old[1], time);
  check('and so does one that the list would have', await hasTimes(stored));
} finally {
  await browser.end();
  await cut();
}
