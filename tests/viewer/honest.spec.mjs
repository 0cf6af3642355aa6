// Checks what the page says if something is missing: the radar, moment or time of a link, the server, its news, or the
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
      // Checks that the button is pressed, which shows that the page follows the newest volume, if and only if
      // `isLive`.
      live: (isLive = true) => expect(follow).toHaveAttribute('aria-pressed', String(isLive)),
    });
  },
  newest: ({ server }, use) => use(`domain=${server.station}&moment=REF&time=latest`),
});

// Opens a view without waiting for its picture.
async function openOnly(viewer, view) {
  await viewer.page.goto('about:blank');
  await viewer.goto(view);
}
// Waits until the page has sent at least `times` requests whose address has this part.
const expectAsked = (viewer, part, times) => expect.poll(() => viewer.asked(part), `requests for ${part}`).toBeGreaterThanOrEqual(times);
// Sends an event to the page once the page listens.
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
// Returns a function that changes JSON answers whose path matches the pattern.
const changing = (pattern, change) => (path, body) => {
  if (body.length === 0 || !pattern.test(path)) return body;
  const all = JSON.parse(body.toString());
  return Buffer.from(JSON.stringify(change(all) ?? all));
};

test.describe('a link to missing data', () => {
  // 2026-11-28: the page opened another radar and did not say so.
  test('names the radar', async ({ viewer, says, server: { station, other } }) => {
    await viewer.goto('domain=KXXX&moment=REF&time=latest');
    await expect(says.notice).toContainText('No data for KXXX');
    // The page shows the map, or the station if there is only one.
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

  // 2026-11-28: the page said nothing if the link was opened in the same window.
  test('is reported in the same window', async ({ page, viewer, says, newest, server: { station } }) => {
    await viewer.open(newest);
    expect(await viewer.text('notice'), 'the notice about data that exist').toBe('');
    await viewer.turnTo(`domain=${station}&moment=REF&time=tomorrow`);
    await expect(says.notice).toContainText('tomorrow is not a time');
    // A name with more than four numbers is not a region.
    await viewer.turnTo(`domain=${encodeURIComponent('region:-100,33,-95,37,/REF;x')}`);
    await expect(says.notice).toContainText('No data for region');
    // Let the page write its own address before it takes the new address.
    await page.evaluate((own) => {
      location.hash = 'domain=KYYY&moment=REF';
      history.replaceState(null, '', `#${own}`);
    }, `domain=${station}&moment=REF`);
    await expect(says.notice).toContainText('No data for KYYY');
  });
});

// 2026-11-28: echo that had not come looked like clear air.
test('the page says that echo is loading', async ({ viewer, relay, server: { station, other } }, info) => {
  info.skip(station === other, 'a lone station is opened at once');
  relay.isHeld = (path) => path.startsWith('/tiles/');
  await viewer.goto();
  await expect(viewer.byId('start-card')).toContainText('not loaded yet');
  relay.release();
  await expect(viewer.byId('start-card')).toHaveText('');
});

// 2026-11-28: the page went on saying that the radar was missing.
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

// 2026-11-28: the start map kept its first view, and told of new radars after half a minute.
test('the start map takes in radars that come later', async ({ viewer, relay, server: { station, other } }, info) => {
  info.skip(station === other, 'there is only one station');
  relay.listed = changing(/^\/api\/v1\/stations/, ({ stations }) => ({ stations: stations.filter((one) => one.station !== other) }));
  await viewer.goto();
  await viewer.stationsOnMap(station);
  relay.listed = (path, body) => body;
  await tell(relay, 'volume_complete', { domain: 'KXXX', station: 'KXXX', moment: 'REF' });
  await viewer.stationsOnMap(other);
  const shown = await viewer.data('map');
  await viewer.press('start-all');
  await viewer.frames();
  expect(await viewer.data('map'), 'the view is that of Fit all').toBe(shown);
});

test('a moment that comes while the stream is broken is shown', async ({ viewer, relay, says, server: { station } }) => {
  const reflectivity = (one) => ({ ...one, moments: one.moments.filter(({ moment }) => moment === 'REF') });
  relay.listed = changing(/^\/api\/v1\/domains/, ({ domains }) => ({ domains: domains.map(reflectivity) }));
  await viewer.goto(`domain=${station}&moment=VEL&time=latest`);
  await expect(says.notice).toContainText(`${station} has no VEL`);
  relay.listed = (path, body) => body;
  relay.events = [reset];
  relay.endStreams();
  await says.nothing();
});

test.describe('a server that does not answer', () => {
  // 2026-11-28: the page looked live, and kept the old picture.
  test('is reported, and the page catches up later', async ({ viewer, relay, says, newest }) => {
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

  // 2026-11-28, 29: the page looked live.
  test('is reported also behind a proxy', async ({ viewer, relay, says, newest }) => {
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

  // 2026-11-28: the page did not ask again for the region.
  test('is asked again for a region that was chosen in the meantime', async ({ viewer, relay, says, newest }) => {
    await viewer.open(newest);
    relay.isStopped = true;
    relay.endStreams();
    await viewer.turnTo('domain=region:-104,31,-99,36&moment=REF');
    await expect(says.notice).toContainText('does not answer');
    relay.isStopped = false;
    await viewer.until(() => document.documentElement.dataset.drawn?.startsWith('region:'));
    await says.nothing();
  });

  // The server takes connections and sends nothing (2026-11-28: the page looked live).
  test('is reported if it hangs', async ({ page, viewer, relay, says, newest }) => {
    await waitLess(page);
    await viewer.open(newest);
    relay.isHanging = true;
    await expect(says.notice).toContainText('does not answer');
    relay.isHanging = false;
    await says.nothing();
  });
});

// 2026-11-28: the page said that a server without a place for another stream does not answer. 2026-11-29: the page said
// the same if a proxy refused only the stream.
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

// 2026-11-28: the page kept the old grid.
test('a grid that was made again while another moment was shown is loaded again', async ({ viewer, relay, says, newest, server: { station } }) => {
  await viewer.open(newest);
  const time = (await viewer.data('drawn')).split('/').pop();
  const turn = (moment) => viewer.settled(() => viewer.press(`moment-${moment}`));
  for (const moment of ['VEL', 'REF']) await turn(moment);
  const velocities = `/${station}/VEL/${encodeURIComponent(time)}/packed`;
  const loaded = viewer.asked(velocities);
  expect(loaded).toBeGreaterThan(0);
  await turn('VEL');
  expect(viewer.asked(velocities), 'requests for the grid that was loaded before').toBe(loaded);
  await turn('REF');
  await tell(relay, 'sweep_gridded', { domain: station, station, moment: 'VEL', grid: time });
  // Wait for a later event, because the page handles events in order.
  await tell(relay, 'station_silent', { station, silent_s: 840 });
  await expect(says.notice).toContainText('silent');
  await turn('VEL');
  expect(viewer.asked(velocities), 'requests for the grid after it was made again').toBeGreaterThan(loaded);
});

test.describe('a silent radar', () => {
  test('is reported until it sends again', async ({ viewer, relay, says, newest, server: { station } }) => {
    await viewer.open(newest);
    // Wait until the page is live, because it then asks for the list of stations, in which no station is silent.
    await says.live();
    await tell(relay, 'station_silent', { station, silent_s: 840 });
    await expect(says.notice).toContainText(`${station} is silent: nothing came for 14 min`);
    await expect(viewer.byId('follow')).toHaveText('Feed silent for 14 min');
    await expect(viewer.byId('follow')).toHaveAttribute('data-health', 'silent');
    await expect(viewer.byId('follow')).toHaveAttribute('aria-pressed', 'false');
    await says.live(false);
    await tell(relay, 'station_spoke', { station });
    await says.nothing();
    // 2026-11-28: if the news that a radar sends again was lost, the page called it silent forever.
    await tell(relay, 'station_silent', { station, silent_s: 840 });
    await expect(says.notice).toContainText('silent');
    await tell(relay, 'reset', { reason: 'events were lost' });
    await says.nothing();
  });

  // 2026-11-28: the page did not report a radar that was already silent.
  test('is reported if it fell silent before the page was opened', async ({ viewer, relay, says, newest, server: { station } }) => {
    relay.listed = changing(/^\/api\/v1\/stations/, ({ stations }) => {
      for (const one of stations ?? []) one.silent_s = one.station === station ? 840 : null;
    });
    await viewer.open(newest);
    await expect(says.notice).toContainText(`${station} is silent: nothing came for 14 min`);
  });
});

// 2026-11-28: the empty picture looked like clear air.
test('a lost WebGL context is reported until it comes back', async ({ page, viewer, says, newest }) => {
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

// In the second case, the browser's clock is two hours behind (2026-11-28: ages were computed by this clock).
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

// 2026-11-28: the page followed a volume with a wrong time forever.
test('the page does not follow a volume of the future', async ({ viewer, relay, newest, server }) => {
  relay.listed = changing(/^\/api\/v1\/grids\?/, ({ grids }) => void grids.push({ ...grids.at(-1), time: '2099-01-01T00:00:00Z' }));
  await viewer.open(newest);
  expect((await server.grid(server.station)).time).toBe((await viewer.data('drawn')).split('/').pop());
  await expect(viewer.byId('follow')).toHaveText('Newest');
});

// 2026-11-28: the page said that it would try again, and did not.
test('a list that fails before the first picture is asked for again', async ({ viewer, relay, newest }) => {
  relay.isBreaking = (path) => path.startsWith('/api/v1/grids?');
  await viewer.goto(newest);
  await expect(viewer.byId('state')).toContainText('Trying again');
  relay.isBreaking = () => false;
  await viewer.drawn();
});

test.describe('volumes that are listed but no longer exist', () => {
  const old = ['2001-01-01T00:00:00Z', '2001-01-01T00:05:00Z'];
  test.beforeEach(async ({ viewer, relay, newest, server: { station } }) => {
    relay.listed = changing(/^\/api\/v1\/(domains|grids\?)/, (all) => {
      for (const one of all.domains ?? []) if (one.domain === station) one.moments = one.moments.filter(({ moment }) => moment === 'REF');
      if (all.grids?.length > 0) all.grids.unshift(...old.map((time) => ({ ...all.grids[0], time })));
    });
    await viewer.open(newest);
  });

  // 2026-11-28: the page reported the failure.
  test('are not reported as failed once another volume is shown', async ({ page, viewer, relay }) => {
    relay.isHeld = (path) => path.includes('2001-01-01');
    await viewer.settled(async () => {
      await viewer.press('earlier');
      await viewer.press('later');
    });
    await expect.poll(() => relay.held, 'requests for the volume that no longer exists').toBeGreaterThan(0);
    const answered = page.waitForEvent('requestfinished', (request) => request.url().includes('2001-01-01'));
    relay.release();
    await answered;
    // Wait for the answer to a later request, which comes after the failed answer.
    await page.evaluate(() => fetch('../api/v1/stations').then((answer) => answer.text()));
    await viewer.frames();
    expect(await viewer.text('state')).not.toContain('Choose another time');
  });

  // 2026-11-28: the timeline kept such volumes, and a loop waited for them. A moment that came later than the first
  // moment of its radar got no button.
  test('leave the timeline, and a moment that the radar sends later gets its button', async ({ viewer, relay, server }) => {
    const { station } = server;
    const time = (await viewer.data('drawn')).split('/').pop();
    const stored = (await server.grids([station])).filter(({ moment }) => moment === 'REF').length;
    const hasTimes = (count) => expect(viewer.byId('times')).toHaveAttribute('max', String(count - 1));
    await hasTimes(stored + 2);
    const button = viewer.byId('moment-VEL');
    await expect(button).toHaveCount(0);
    let hasMore = true; // the server says that it has more grids than it lists
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
