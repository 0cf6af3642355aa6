// Drives the viewer's page for checks and measurements: address, data attributes, mouse, keys and fingers. Units are
// pixels of the page.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import { chromium, expect } from '@playwright/test';

// Options for Debian's Chromium, which draws WebGL with the processor.
export const chromiumOptions = {
  executablePath: '/usr/bin/chromium',
  args: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic'],
};

// A picture may take so long while the machine also compiles.
const patience = 120_000;

// Names the tilt of the usual view in an address that says nothing about the view. Otherwise the page would fit the
// view to the storms.
function withUsualView(view) {
  const named = ['azimuth', 'tilt', 'zoom', 'field-of-view', 'look-at-km', 'exaggeration', 'opacity', 'view'];
  const query = new URLSearchParams(view.replace(/^#/, ''));
  return named.some((name) => query.has(name)) ? view : [view, 'tilt=60'].filter(Boolean).join('&');
}

export class ViewerPage {
  // `page` is Playwright's, and `address` is the server's, without a slash at its end.
  constructor(page, address) {
    Object.assign(this, { page, address });
    this.trouble = []; // errors of the page, and requests that its security policy refused
    this.requests = [];
    page.on('pageerror', (error) => this.trouble.push(error.stack ?? error.message));
    page.on('console', (message) => message.type() === 'error' && this.trouble.push(message.text()));
    page.on('request', (request) => this.requests.push(request.url()));
  }
  // Counts the bytes that come over the network from now on, in `bytes`. Notes when the first picture is drawn.
  async countBytes() {
    this.bytes = 0;
    this.loads = new Map(); // id of a request, its time in ms and its bytes
    const session = await this.protocol();
    session.on('Network.requestWillBeSent', ({ requestId, wallTime }) =>
      this.loads.set(requestId, { atMs: 1000 * wallTime, bytes: 0 }),
    );
    session.on('Network.loadingFinished', ({ requestId, encodedDataLength }) => {
      this.bytes += encodedDataLength;
      this.loads.get(requestId).bytes = encodedDataLength;
    });
    await session.send('Network.enable');
    await this.page.addInitScript(() =>
      new MutationObserver(() => (window.drawnAtMs ??= Date.now())).observe(document, {
        attributeFilter: ['data-drawn'],
        subtree: true,
      }),
    );
  }
  // Returns the bytes of the requests that began before the first picture was drawn.
  async bytesOfFirstPicture() {
    const drawnAtMs = await this.page.evaluate(() => window.drawnAtMs);
    return [...this.loads.values()].reduce((sum, { atMs, bytes }) => sum + (atMs < drawnAtMs ? bytes : 0), 0);
  }
  asked(part) {
    return this.requests.filter((url) => url.includes(part)).length;
  }

  goto(view = '') {
    return this.page.goto(`${this.address}/view/#${view}`, { waitUntil: 'commit' });
  }
  // Opens the page again with a view, and waits for its picture, and for its panels.
  async open(view = '') {
    await this.page.goto('about:blank');
    await this.goto(withUsualView(view));
    await this.drawn();
    await this.until(() => document.documentElement.dataset.panels, null, patience);
  }
  // Changes the view, and waits for its fine picture. Ignores a picture that the page draws before it has taken the
  // address.
  async show(view) {
    await this.page.evaluate(
      (hash) =>
        new Promise((done) => {
          const take = () => {
            delete document.documentElement.dataset.drawn;
            done();
          };
          addEventListener('hashchange', take, { once: true });
          location.hash = hash;
        }),
      withUsualView(view),
    );
    await this.drawn();
  }
  // Changes the address without waiting.
  turnTo(view) {
    return this.page.evaluate((hash) => void (location.hash = hash), view);
  }
  // Carries out an act, and waits for the fine picture after it. Waits first for a picture that is being drawn, because
  // the page would otherwise finish that picture after the act.
  async settled(act) {
    if (await this.data('frames')) await this.drawn();
    await this.page.evaluate(() => void delete document.documentElement.dataset.drawn);
    await act();
    await this.drawn();
  }
  drawn() {
    // The counties come after the first picture, and are drawn in a second one.
    const keyOfPicture = () => {
      const { ground, drawn } = document.documentElement.dataset;
      return ground === 'part' ? '' : drawn;
    };
    return this.until(keyOfPicture, null, patience);
  }
  // Waits until a function that runs in the page returns a truthy value, and returns this value.
  async until(condition, argument = null, timeout = 30_000) {
    const found = await this.page.waitForFunction(condition, argument, { timeout, polling: 20 });
    return found.jsonValue();
  }
  // Waits until the page has painted twice.
  frames() {
    return this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  // Returns a parameter of the address.
  told(name) {
    return this.page.evaluate((name) => new URLSearchParams(location.hash.slice(1)).get(name), name);
  }
  async number(name) {
    return Number(await this.told(name));
  }
  // Returns a data attribute of the document.
  data(name) {
    return this.page.evaluate((name) => document.documentElement.dataset[name], name);
  }
  text(id) {
    return this.page.evaluate((id) => document.getElementById(id).textContent, id);
  }
  byId(id) {
    return this.page.locator(`#${id}`);
  }
  // Carries out an act, and checks its effect on a number of the address.
  async changes(what, name, act, holds) {
    const before = await this.number(name);
    await this.settled(act);
    const after = await this.number(name);
    expect(holds(before, after), `${what}: ${name} ${before} to ${after}`).toBe(true);
  }

  // Returns the pixels of the stations on the start map, once the map shows `station`.
  async stationsOnMap(station = '') {
    const isThere = (station) => document.documentElement.dataset.map?.includes(station) && document.documentElement.dataset.map;
    const places = (await this.until(isThere, station)).split(',').map((place) => place.split(' '));
    return new Map(places.map(([icao, x, y]) => [icao, [Number(x), Number(y)]]));
  }

  // Presses a control, which may be hidden.
  press(id) {
    return this.byId(id).evaluate((one) => one.click());
  }
  // Sets the value of a control, and sends its event.
  give(id, value, event = 'change') {
    const set = (one, [value, event]) => {
      one.value = value;
      one.dispatchEvent(new Event(event));
    };
    return this.byId(id).evaluate(set, [String(value), event]);
  }
  key(key) {
    return this.page.keyboard.press(key);
  }
  hover([x, y]) {
    return this.page.mouse.move(x, y);
  }
  async drag([x, y], [dx, dy]) {
    const { mouse } = this.page;
    await mouse.move(x, y);
    await mouse.down();
    if (dx !== 0 || dy !== 0) await mouse.move(x + dx, y + dy, { steps: 4 });
    await mouse.up();
  }
  async shiftDrag(from, by) {
    await this.page.keyboard.down('Shift');
    await this.drag(from, by);
    await this.page.keyboard.up('Shift');
  }
  click(at) {
    return this.drag(at, [0, 0]);
  }
  async wheel([x, y], deltaY) {
    await this.page.mouse.move(x, y);
    await this.page.mouse.wheel(0, deltaY);
  }
  // Returns a session of the DevTools protocol, which can touch with several fingers.
  async protocol() {
    return (this.session ??= await this.page.context().newCDPSession(this.page));
  }
  async touch(type, points) {
    const session = await this.protocol();
    await session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  }
  async tap(at) {
    await this.touch('touchStart', [at]);
    await this.touch('touchEnd', []);
  }
  resize(width, height) {
    return this.page.setViewportSize({ width, height });
  }

  // Stores in window.copied the text that the page copies.
  catchCopies() {
    return this.page.evaluate(() => {
      const writeText = (text) => {
        window.copied = text;
        return Promise.resolve();
      };
      Object.defineProperty(navigator, 'clipboard', { value: { writeText } });
    });
  }
  // Presses a button that copies, and returns the copied text.
  async copiedBy(id) {
    await this.page.evaluate(() => void (window.copied = undefined));
    await this.press(id);
    return this.until(() => window.copied);
  }
  // Stores in window.taken the link that the page clicks to save something, and the title at this moment.
  catchLinks() {
    return this.page.evaluate(() => {
      HTMLAnchorElement.prototype.click = function () {
        window.taken = { href: this.href, name: this.download, title: document.getElementById('title').textContent };
      };
    });
  }
  // Presses a button that saves, and returns the link and the title.
  async takenBy(id) {
    await this.page.evaluate(() => void (window.taken = undefined));
    await this.press(id);
    return this.until(() => window.taken, null, 60_000);
  }

  // Returns the picture as bytes of a portable pixmap, scaled to width and height if they are not 0.
  async pixels(width = 0, height = 0) {
    const text = await this.page.evaluate(
      ([width, height]) => {
        const picture = document.getElementById('picture');
        const copy = document.createElement('canvas');
        [copy.width, copy.height] = [width || picture.width, height || picture.height];
        const pen = copy.getContext('2d');
        pen.drawImage(picture, 0, 0, copy.width, copy.height);
        const { data } = pen.getImageData(0, 0, copy.width, copy.height);
        let text = '';
        for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
        return `${copy.width} ${copy.height} ${btoa(text)}`;
      },
      [width, height],
    );
    const [w, h, bytes] = text.split(' ');
    return Buffer.concat([Buffer.from(`P6\n${w} ${h}\n255\n`), Buffer.from(bytes, 'base64')]);
  }
  // Saves a screenshot if STORMCELLAR_PICTURES names a directory.
  async keep(name) {
    const directory = process.env.STORMCELLAR_PICTURES;
    if (!directory) return;
    mkdirSync(directory, { recursive: true });
    await this.page.screenshot({ path: join(directory, `${name}.png`) });
  }
}

// Returns the grids of stations. Waits until each station has a grid of REF, which the server may still be making.
export async function gridsOf(address, stations) {
  const all = [];
  for (const domain of stations) {
    const list = async () => (await (await fetch(`${address}/api/v1/grids?domain=${domain}&limit=10000`)).json()).grids;
    let grids = [];
    const hasSome = async () => (grids = await list()).some(({ moment }) => moment === 'REF');
    await expect.poll(hasSome, { message: `there is a grid of ${domain}`, timeout: 60_000 }).toBe(true);
    all.push(...grids);
  }
  return all;
}

// Runs a measurement in a new browser.
export async function withBrowser(run) {
  const browser = await chromium.launch(chromiumOptions);
  try {
    await run(browser);
  } finally {
    await browser.close();
  }
}
export async function openPage(browser, address, width, height) {
  const context = await browser.newContext({ viewport: { width, height }, hasTouch: true });
  return new ViewerPage(await context.newPage(), address);
}
