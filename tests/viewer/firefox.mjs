// Drives Firefox with WebDriver BiDi; of Debian's packages, node and its ws.
//
// Units: pixels of the page. Errors: an Error with what the browser said.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const WebSocket = createRequire(import.meta.url)('/usr/share/nodejs/ws');

// Nothing is asked of the makers of the browser, and WebGL is drawn by the processor where there is no other.
const preferences = {
  'app.normandy.enabled': false,
  'app.update.enabled': false,
  'browser.safebrowsing.malware.enabled': false,
  'browser.safebrowsing.phishing.enabled': false,
  'browser.shell.checkDefaultBrowser': false,
  'browser.startup.homepage_override.mstone': 'ignore',
  'datareporting.policy.dataSubmissionEnabled': false,
  'network.captive-portal-service.enabled': false,
  'network.connectivity-service.enabled': false,
  'services.settings.server': 'http://127.0.0.1:9/',
  'toolkit.telemetry.enabled': false,
  'webgl.force-enabled': true,
  'webgl.disable-fail-if-major-performance-caveat': true,
  'gfx.webrender.software': true,
  'webgl.out-of-process': false,
};

export class Firefox {
  static async start(width, height, program = 'firefox-esr') {
    const browser = new Firefox();
    browser.profile = mkdtempSync(join(tmpdir(), 'stormcellar-firefox-'));
    // Also when a check throws.
    process.on('exit', () => rmSync(browser.profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 100 }));
    const lines = Object.entries(preferences).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${JSON.stringify(value)});`);
    writeFileSync(join(browser.profile, 'user.js'), lines.join('\n'));
    browser.child = spawn(
      program,
      ['--no-remote', '--profile', browser.profile, '--remote-debugging-port', '0', '--width', String(width), '--height', String(height), 'about:blank'],
      { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, HOME: browser.profile, MOZ_REMOTE_SETTINGS_DEVTOOLS: '1' } },
    );
    browser.waiting = new Map();
    browser.number = 0;
    browser.socket = new WebSocket(`${await browser.address()}/session`);
    browser.socket.on('message', (text) => browser.take(JSON.parse(text)));
    await new Promise((done, failed) => browser.socket.on('open', done).on('error', failed));
    await browser.send('session.new', { capabilities: {} });
    const { contexts } = await browser.send('browsingContext.getTree', {});
    browser.context = contexts[0].context;
    await browser.send('browsingContext.setViewport', { context: browser.context, viewport: { width, height } });
    return browser;
  }
  // Firefox tells its port.
  address() {
    return new Promise((done, failed) => {
      let said = '';
      this.child.stderr.setEncoding('utf8').on('data', (text) => {
        said += text;
        const found = said.match(/WebDriver BiDi listening on (ws:\S+)/);
        if (found) done(found[1]);
      });
      this.child.on('error', failed);
      this.child.on('exit', () => failed(new Error(`Firefox ended: ${said}`)));
    });
  }
  take(message) {
    const waiter = this.waiting.get(message.id);
    if (!waiter) return;
    this.waiting.delete(message.id);
    if (message.type === 'error') waiter.failed(new Error(`${waiter.method}: ${message.message}`));
    else waiter.done(message.result);
  }
  send(method, params) {
    const id = ++this.number;
    return new Promise((done, failed) => {
      this.waiting.set(id, { done, failed, method });
      this.socket.send(JSON.stringify({ id, method, params }));
    });
  }
  goto(url) {
    return this.send('browsingContext.navigate', { context: this.context, url, wait: 'none' });
  }
  async evaluate(expression) {
    const answer = await this.send('script.evaluate', { expression, target: { context: this.context }, awaitPromise: true });
    if (answer.type === 'exception') throw new Error(`${expression}: ${answer.exceptionDetails.text}`);
    return answer.result.value;
  }
  async until(expression, seconds = 60) {
    const end = Date.now() + seconds * 1000;
    while (Date.now() < end) {
      const value = await this.evaluate(expression).catch(() => undefined);
      if (value) return value;
      await new Promise((done) => setTimeout(done, 50));
    }
    throw new Error(`waited in vain for ${expression}`);
  }
  async screenshot() {
    const { data } = await this.send('browsingContext.captureScreenshot', { context: this.context });
    return Buffer.from(data, 'base64');
  }
  async end() {
    const ended = new Promise((done) => this.child.on('exit', done));
    this.send('browser.close', {}).catch(() => undefined);
    const slow = setTimeout(() => this.child.kill('SIGKILL'), 5000);
    await ended;
    clearTimeout(slow);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}
