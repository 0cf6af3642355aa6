// Checks what the page says if something is missing: the radar, moment or time of a link, the server, its news, the
// graphics processor.
import { expect, test as base } from './fixtures.mjs';
import { Relay } from './relay.mjs';

const reset = 'event: reset\ndata: {"type":"reset","reason":"another run"}\n\n';

const test = base.extend({
  viewport: { width: 700, height: 440 },
  provoked: /./,
  relay: async ({ server }, use) => {
    const relay = await new Relay(server.address).begin();
    await use(relay);
    await relay.cut();
  },
  address: ({ relay }, use) => use(relay.address),
  // Expectations that many checks have.
  says: async ({ viewer }, use) => {
    const notice = viewer.byId('notice');
    const follow = viewer.byId('follow');
    await use({
      notice,
      nothing: () => expect(notice).toHaveText(''),
      // The newest is followed, or said not to be.
      live: (isLive = true) => expect(follow).toHaveAttribute('aria-pressed', String(isLive)),
    });
  },
  newest: ({ server }, use) => use(`domain=${server.station}&moment=REF&time=latest`),
});

// Opens a view whose picture need not come.
async function openOnly(viewer, view) {
  await viewer.page.goto('about:blank');
  await viewer.goto(view);
}
// Waits until the page has asked for something so many times.
const expectAsked = (viewer, part, times) => expect.poll(() => viewer.asked(part), `requests for ${part}`).toBeGreaterThanOrEqual(times);
// Tells the page of an event, once it listens.
async function tell(relay, kind, data) {
  await expect.poll(() => relay.streams.size, 'streams of events').toBeGreaterThan(0);
  relay.tell(kind, data);
}
// Lets the page wait 1.5 seconds for the server instead of 40.
const waitLess = (page) =>
  page.addInitScript(() => {
    const timer = setTimeout;
    window.setTimeout = (act, ms, ...more) => timer(act, ms === 40000 ? 1500 : ms, ...more);
  });
// Changes answers that are JSON and whose path begins so.
const changing = (pattern, change) => (path, body) => {
  if (body.length === 0 || !pattern.test(path)) return body;
  const all = JSON.parse(body.toString());
  return Buffer.from(JSON.stringify(change(all) ?? all));
};

test.describe('a link to what is not there', () => {
  // 2026-11-28: another radar was opened without a word.
  test('names the radar', async ({ viewer, says, server: { station, other } }) => {
    await viewer.goto('domain=KXXX&moment=REF&time=latest');
    await expect(says.notice).toContainText('No data for KXXX');
    // A lone station is shown, and the map is not.
    await expect(viewer.byId('start')).toBeVisible({ visible: station !== other });
    await expect(viewer.byId('start-notice')).toHaveText(await viewer.text('notice'));
  });

  test('names the moment and the time', async ({ viewer, says, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=XXX&time=2099-01-01T00:00:00Z`);
    await expect(says.notice).toContainText(`${station} has no XXX`);
    await expect(says.notice).toContainText('2099-01-01 00:00:00');
    await viewer.open(`domain=${station}&moment=REF&time=yesterday`);
    await expect(says.notice).toContainText('yesterday is not a time');
    await viewer.show(`domain=${station}&moment=REF&surface=20&surface-moment=XXX`);
    await expect(viewer.byId('layers-told')).toContainText('no XXX for this time');
  });

  // 2026-11-28: in the same window nothing was said.
  test('is told in the same window', async ({ page, viewer, says, newest, server: { station } }) => {
    await viewer.open(newest);
    expect(await viewer.text('notice'), 'what is there needs no notice').toBe('');
    await viewer.turnTo(`domain=${station}&moment=REF&time=tomorrow`);
    await expect(says.notice).toContainText('tomorrow is not a time');
    // A name with more than four numbers is not a region.
    await viewer.turnTo(`domain=${encodeURIComponent('region:-100,33,-95,37,/REF;x')}`);
    await expect(says.notice).toContainText('No data for region');
    // The page writes its own address meanwhile.
    await page.evaluate((own) => {
      location.hash = 'domain=KYYY&moment=REF';
      history.replaceState(null, '', `#${own}`);
    }, `domain=${station}&moment=REF`);
    await expect(says.notice).toContainText('No data for KYYY');
  });
});

// 2026-11-28: it looked like clear air.
test('echo that is on its way is told', async ({ viewer, relay, server: { station, other } }, info) => {
  info.skip(station === other, 'a lone station is opened at once');
  relay.isHeld = (path) => path.startsWith('/tiles/');
  await viewer.goto();
  await expect(viewer.byId('start-card')).toContainText('not loaded yet');
  relay.release();
  await expect(viewer.byId('start-card')).toHaveText('');
});

// 2026-11-28: the page said for good that it is not there.
test('a radar that comes later is shown', async ({ viewer, relay, says, server }, info) => {
  const { station, other } = server;
  info.skip(station === other, 'there is one station');
  const without = ({ domains }) => ({ domains: domains.filter(({ domain }) => domain !== other) });
  relay.listed = changing(/^\/api\/v1\/domains/, without);
  await viewer.goto(`domain=${other}&moment=REF&time=latest`);
  await expect(says.notice).toContainText(`No data for ${other}`);
  relay.listed = (path, body) => body;
  await tell(relay, 'volume_complete', { domain: other, station: other, moment: 'REF', grid: (await server.grid(other)).time });
  await says.nothing();
});

test('a moment that comes while nothing is heard is shown', async ({ viewer, relay, says, server: { station } }) => {
  const reflectivity = (one) => ({ ...one, moments: one.moments.filter(({ moment }) => moment === 'REF') });
  relay.listed = changing(/^\/api\/v1\/domains/, ({ domains }) => ({ domains: domains.map(reflectivity) }));
  await viewer.goto(`domain=${station}&moment=VEL&time=latest`);
  await expect(says.notice).toContainText(`${station} has no VEL`);
  relay.listed = (path, body) => body;
  relay.events = [reset];
  relay.endStreams();
  await says.nothing();
});

test.describe('a server that is gone', () => {
  // 2026-11-28: the page looked as if it were live, and stayed with the old picture.
  test('is told, and what came meanwhile is asked for', async ({ viewer, relay, says, newest }) => {
    await viewer.open(newest);
    await says.live();
    const port = relay.port;
    await relay.cut();
    await expect(says.notice).toContainText('does not answer');
    await says.live(false);
    const before = viewer.asked('/api/v1/grids?');
    relay.events = [reset];
    await relay.begin(port);
    await says.nothing();
    await says.live();
    await expectAsked(viewer, '/api/v1/grids?', before + 1);
    const again = viewer.asked('/api/v1/grids?');
    await tell(relay, 'reset', { reason: 'events were lost' });
    await expectAsked(viewer, '/api/v1/grids?', again + 1);
  });

  // 2026-11-28, 29: the page looked as if it were live.
  test('is told behind a proxy too', async ({ viewer, relay, says, newest }) => {
    await viewer.open(newest);
    for (const refusal of [
      [502, 'text/html', '<h1>Bad gateway</h1>'],
      [404, 'text/plain; charset=utf-8', '404 page not found'],
      [503, 'text/plain', 'no healthy upstream'],
      [401, 'text/html', '<h1>Sign in</h1>'],
      [200, 'text/html', '<h1>We are back soon</h1>'],
      [502, 'application/json', '{"message": "Bad Gateway"}'],
      [401, 'application/json', '{"message": "Unauthorized"}'],
      [404, 'application/json', '{"error": "Not Found"}'],
      [500, 'application/json', '{"error": "There was a problem proxying the request"}'],
    ]) {
      relay.refusal = refusal;
      relay.isStopped = true;
      relay.endStreams();
      await expect(says.notice, refusal.join(' ')).toContainText('does not answer');
      await says.live(false);
      relay.isStopped = false;
      await says.nothing();
      await says.live();
    }
  });

  // 2026-11-28: it was not asked for again.
  test('draws a region that was asked for meanwhile', async ({ viewer, relay, says, newest }) => {
    await viewer.open(newest);
    relay.isStopped = true;
    relay.endStreams();
    await viewer.turnTo('domain=region:-104,31,-99,36&moment=REF');
    await expect(says.notice).toContainText('does not answer');
    relay.isStopped = false;
    await viewer.until(() => document.documentElement.dataset.drawn?.startsWith('region:'));
    await says.nothing();
  });

  // A server that takes connections and says nothing (2026-11-28: it looked alive).
  test('is told when it hangs', async ({ page, viewer, relay, says, newest }) => {
    await waitLess(page);
    await viewer.open(newest);
    relay.isHanging = true;
    await expect(says.notice).toContainText('does not answer');
    relay.isHanging = false;
    await says.nothing();
  });
});

// 2026-11-28: it was said not to answer. 2026-11-29: where somebody on the way refused the stream alone, the server
// seemed to be gone.
for (const [who, refusal] of [
  ['a server without a place for another stream', [503, 'text/plain; charset=utf-8', 'As many as there may be']],
  ['a proxy that refuses events', [403, 'text/html', '<h1>Forbidden</h1>']],
]) {
  test(`${who} is asked for the lists again`, async ({ page, viewer, relay, says, newest }) => {
    await waitLess(page);
    relay.refusal = refusal;
    relay.isRefusing = true;
    await viewer.open(newest);
    await expectAsked(viewer, '/api/v1/grids?', 2);
    await says.nothing();
  });
}

// 2026-11-28: the page kept the old one.
test('a grid that was made again while another moment was shown is loaded again', async ({ viewer, relay, says, newest, server: { station } }) => {
  await viewer.open(newest);
  const time = (await viewer.data('drawn')).split('/').pop();
  const turn = (moment) => viewer.settled(() => viewer.press(`moment-${moment}`));
  for (const moment of ['VEL', 'REF']) await turn(moment);
  const velocities = `/${station}/VEL/${encodeURIComponent(time)}/packed`;
  const loaded = viewer.asked(velocities);
  expect(loaded).toBeGreaterThan(0);
  await turn('VEL');
  expect(viewer.asked(velocities), 'what was loaded is not loaded again').toBe(loaded);
  await turn('REF');
  await tell(relay, 'sweep_gridded', { domain: station, station, moment: 'VEL', grid: time });
  // The page hears events in their order.
  await tell(relay, 'station_silent', { station, silent_s: 840 });
  await expect(says.notice).toContainText('silent');
  await turn('VEL');
  expect(viewer.asked(velocities), 'what was made again is').toBeGreaterThan(loaded);
});

test.describe('a silent radar', () => {
  test('is told, until it speaks', async ({ viewer, relay, says, newest, server: { station } }) => {
    await viewer.open(newest);
    // The list of stations, which the page asks for once it is live, says that none is silent.
    await says.live();
    await tell(relay, 'station_silent', { station, silent_s: 840 });
    await expect(says.notice).toContainText(`${station} is silent: nothing came for 14 min`);
    await says.live(false);
    await tell(relay, 'station_spoke', { station });
    await says.nothing();
    // 2026-11-28: when the news that it speaks were lost, it stayed silent for good.
    await tell(relay, 'station_silent', { station, silent_s: 840 });
    await expect(says.notice).toContainText('silent');
    await tell(relay, 'reset', { reason: 'events were lost' });
    await says.nothing();
  });

  // 2026-11-28: nothing was said.
  test('is told if it fell silent before', async ({ viewer, relay, says, newest, server: { station } }) => {
    relay.listed = changing(/^\/api\/v1\/stations/, ({ stations }) => {
      for (const one of stations ?? []) one.silent_s = one.station === station ? 840 : null;
    });
    await viewer.open(newest);
    await expect(says.notice).toContainText(`${station} is silent: nothing came for 14 min`);
  });
});

// 2026-11-28: it looked like clear air.
test('a graphics processor that is lost is told, and comes back', async ({ page, viewer, says, newest }) => {
  await viewer.open(newest);
  await page.evaluate(() => {
    window.loser = document.getElementById('picture').getContext('webgl2').getExtension('WEBGL_lose_context');
    window.loser.loseContext();
  });
  await expect(says.notice).toContainText('graphics processor');
  await expect(viewer.byId('reload')).toBeVisible();
  await expect(viewer.byId('labels')).toHaveCSS('visibility', 'hidden');
  await viewer.settled(() => page.evaluate(() => window.loser.restoreContext()));
  await says.nothing();
  await expect(viewer.byId('labels')).toHaveCSS('visibility', 'visible');
});

// A clock of a browser that is two hours behind (2026-11-28: ages were told by it).
for (const [whose, behind] of [['the data', 0], ['the data by the clock of the server', 7200e3]]) {
  test(`the title tells the age of ${whose}`, async ({ page, viewer, relay, newest }) => {
    const timeAt = 136; // of a packed grid
    const hour = BigInt(Date.now() - 3600e3);
    relay.listed = (path, body) => {
      if (path.includes('/packed') && body.length > timeAt + 8) body.writeBigInt64LE(hour, timeAt);
      return body;
    };
    await page.addInitScript((behind) => {
      const clock = Date.now;
      Date.now = () => clock() - behind;
    }, behind);
    await viewer.open(newest);
    await expect(viewer.byId('title')).toContainText(/6[01] min ago/);
  });
}

// A volume of a wrong time (2026-11-28: the page followed it for good).
test('what is followed is not of the future', async ({ viewer, relay, newest, server }) => {
  relay.listed = changing(/^\/api\/v1\/grids\?/, ({ grids }) => void grids.push({ ...grids.at(-1), time: '2099-01-01T00:00:00Z' }));
  await viewer.open(newest);
  expect((await server.grid(server.station)).time).toBe((await viewer.data('drawn')).split('/').pop());
  await expect(viewer.byId('follow')).toHaveText('Newest');
});

// 2026-11-28: it said that it tries again, and did not.
test('a list that does not come before anything is shown is asked for again', async ({ viewer, relay, newest }) => {
  relay.isBreaking = (path) => path.startsWith('/api/v1/grids?');
  await viewer.goto(newest);
  await expect(viewer.byId('state')).toContainText('Trying again');
  relay.isBreaking = () => false;
  await viewer.drawn();
});

test.describe('volumes that are listed and gone', () => {
  const old = ['2001-01-01T00:00:00Z', '2001-01-01T00:05:00Z'];
  test.beforeEach(async ({ viewer, relay, newest, server: { station } }) => {
    relay.listed = changing(/^\/api\/v1\/(domains|grids\?)/, (all) => {
      for (const one of all.domains ?? []) if (one.domain === station) one.moments = one.moments.filter(({ moment }) => moment === 'REF');
      if (all.grids?.length > 0) all.grids.unshift(...old.map((time) => ({ ...all.grids[0], time })));
    });
    await viewer.open(newest);
  });

  // 2026-11-28: it was.
  test('are not said to fail once another one is shown', async ({ page, viewer, relay }) => {
    relay.isHeld = (path) => path.includes('2001-01-01');
    await viewer.settled(async () => {
      await viewer.press('earlier');
      await viewer.press('later');
    });
    await expect.poll(() => relay.held, 'requests for what is gone').toBeGreaterThan(0);
    const answered = page.waitForEvent('requestfinished', (request) => request.url().includes('2001-01-01'));
    relay.release();
    await answered;
    // An answer to a later question comes after it.
    await page.evaluate(() => fetch('../api/v1/stations').then((answer) => answer.text()));
    await viewer.frames();
    expect(await viewer.text('state')).not.toContain('no picture');
  });

  // 2026-11-28: the timeline kept them, and a loop waited for them; a moment that came after the first one of its radar
  // got no button.
  test('leave the timeline, and a moment that comes later gets its button', async ({ viewer, relay, server }) => {
    const { station } = server;
    const time = (await viewer.data('drawn')).split('/').pop();
    const stored = (await server.grids([station])).filter(({ moment }) => moment === 'REF').length;
    const hasTimes = (count) => expect(viewer.byId('times')).toHaveAttribute('max', String(count - 1));
    await hasTimes(stored + 2);
    const button = viewer.byId('moment-VEL');
    await expect(button).toHaveCount(0);
    let hasMore = true; // than those of a list
    relay.listed = changing(/^\/api\/v1\/grids\?/, (all) => ({ ...all, more: hasMore }));
    await tell(relay, 'volume_complete', { domain: station, station, moment: 'VEL', grid: time });
    await expect(button).toHaveCount(1);
    const evict = (gone, oldest) => tell(relay, 'grid_evicted', { domain: station, moment: 'REF', count: 1, from: gone, to: gone, grids: [gone], oldest });
    await evict(old[0], old[1]);
    await hasTimes(stored + 1);
    hasMore = false;
    await evict(old[1], time);
    await hasTimes(stored);
  });
});
