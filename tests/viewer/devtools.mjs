// Drives Chromium over a pipe with the DevTools protocol; node alone, no package.
//
// Units: pixels of the page. Errors: an Error with what the browser said.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const switches = [
  '--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
  '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--hide-scrollbars', '--force-color-profile=srgb', '--remote-debugging-pipe',
];

export class Browser {
  static async start(program = 'chromium') {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'stormcellar-browser-'));
    // Also when a check throws.
    process.on('exit', () => rmSync(browser.profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 }));
    browser.child = spawn(program, [...switches, `--user-data-dir=${browser.profile}`, 'about:blank'], {
      stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
    });
    browser.waiting = new Map();
    browser.listeners = [];
    browser.number = 0;
    let rest = '';
    browser.child.stdio[4].setEncoding('utf8').on('data', (text) => {
      const parts = (rest + text).split('\0');
      rest = parts.pop();
      for (const part of parts) browser.take(JSON.parse(part));
    });
    browser.child.on('exit', () => {
      for (const { failed } of browser.waiting.values()) failed(new Error('the browser ended'));
      browser.waiting.clear();
    });
    return browser;
  }
  take(message) {
    if (message.id === undefined) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    const waiter = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) waiter.failed(new Error(`${waiter.method}: ${message.error.message}`));
    else waiter.done(message.result);
  }
  send(method, params = {}, sessionId = undefined) {
    const id = ++this.number;
    return new Promise((done, failed) => {
      this.waiting.set(id, { done, failed, method });
      this.child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }
  async page(width, height, ratio = 1) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    await page.begin(width, height, ratio);
    return page;
  }
  async end() {
    const ended = new Promise((done) => this.child.on('exit', done));
    this.send('Browser.close').catch(() => undefined);
    await ended;
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

class Page {
  constructor(browser, sessionId, targetId) {
    Object.assign(this, { browser, sessionId, targetId });
    this.trouble = []; // errors of the page, and what the policy refused
    this.bytes = 0; // that came over the wire
    this.requests = [];
  }
  send(method, params = {}) {
    return this.browser.send(method, params, this.sessionId);
  }
  async begin(width, height, ratio) {
    this.browser.listeners.push((message) => message.sessionId === this.sessionId && this.hear(message));
    for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await this.send(`${domain}.enable`);
    await this.send('Emulation.setTouchEmulationEnabled', { enabled: true, maxTouchPoints: 2 });
    await this.resize(width, height, ratio);
  }
  hear({ method, params }) {
    if (method === 'Runtime.exceptionThrown') this.trouble.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Log.entryAdded' && params.entry.level === 'error') this.trouble.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
    if (method === 'Network.loadingFinished') this.bytes += params.encodedDataLength;
  }
  resize(width, height, ratio = 1) {
    return this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: ratio, mobile: false });
  }
  goto(url) {
    return this.send('Page.navigate', { url });
  }
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }
  async until(expression, seconds = 30) {
    const end = Date.now() + seconds * 1000;
    while (Date.now() < end) {
      const value = await this.evaluate(expression).catch(() => undefined);
      if (value) return value;
      await new Promise((done) => setTimeout(done, 20));
    }
    throw new Error(`waited in vain for ${expression}`);
  }
  async screenshot() {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
    return Buffer.from(data, 'base64');
  }
  async key(key, more = {}) {
    const text = key.length === 1 ? { text: key } : {};
    await this.send('Input.dispatchKeyEvent', { type: 'keyDown', key, ...text, ...more });
    await this.send('Input.dispatchKeyEvent', { type: 'keyUp', key, ...more });
  }
  async mouse(type, x, y, more = {}) {
    await this.send('Input.dispatchMouseEvent', { type, x, y, button: type === 'mouseMoved' && !more.buttons ? 'none' : 'left', clickCount: 1, ...more });
  }
  async drag([x, y], [dx, dy], more = {}) {
    await this.mouse('mousePressed', x, y, { buttons: 1, ...more });
    for (let i = 1; i <= 4; ++i) await this.mouse('mouseMoved', x + (dx * i) / 4, y + (dy * i) / 4, { buttons: 1, ...more });
    await this.mouse('mouseReleased', x + dx, y + dy, more);
  }
  async wheel(x, y, deltaY) {
    await this.send('Input.dispatchMouseEvent', { type: 'mouseWheel', x, y, deltaX: 0, deltaY });
  }
  touch(type, points) {
    return this.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  }
  close() {
    return this.browser.send('Target.closeTarget', { targetId: this.targetId });
  }
}
