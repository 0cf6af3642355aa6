// Passes requests of a page on to the data server. Checks can make the relay refuse, hang, break off, change answers,
// and send events.
import { createServer, request } from 'node:http';

export class Relay {
  #upstream;
  #server;
  #held = [];
  #heartbeat;
  streams = new Set();
  events = []; // texts with which a stream begins
  listed = (path, body) => body; // changes the body of an answer
  refusal = [502, 'text/html', '<h1>Bad gateway</h1>'];
  isStopped = false; // answers every request with `refusal`, as a proxy before a stopped server does
  isRefusing = false; // answers requests for a stream with `refusal`
  isHanging = false; // takes connections, and sends nothing
  isBreaking = () => false; // returns true for requests that are broken off without an answer
  isHeld = () => false; // returns true for requests that wait until release()

  constructor(address) {
    this.#upstream = new URL(address);
  }
  async begin(port = 0) {
    this.#server = createServer((asked, answer) => this.#pass(asked, answer));
    await new Promise((done) => this.#server.listen(port, '127.0.0.1', done));
    this.port = this.#server.address().port;
    this.#heartbeat = setInterval(() => this.isHanging || this.streams.forEach((stream) => stream.write(': heartbeat\n\n')), 200);
    return this;
  }
  get address() {
    return `http://127.0.0.1:${this.port}`;
  }
  cut() {
    clearInterval(this.#heartbeat);
    return new Promise((done) => {
      this.#server.close(done);
      this.#server.closeAllConnections();
    });
  }
  tell(kind, data) {
    const event = `event: ${kind}\ndata: ${JSON.stringify({ type: kind, ...data })}\n\n`;
    this.streams.forEach((stream) => stream.write(event));
  }
  // Ends the streams, so that the page asks for them again.
  endStreams() {
    this.streams.forEach((stream) => stream.end());
  }
  get held() {
    return this.#held.length;
  }
  // Answers the requests that wait. Later requests do not wait.
  release() {
    this.isHeld = () => false;
    for (const act of this.#held.splice(0)) act();
  }

  #pass(asked, answer) {
    if (this.isHanging) return;
    if (this.isHeld(asked.url)) return void this.#held.push(() => this.#pass(asked, answer));
    if (this.isBreaking(asked.url)) return void answer.destroy();
    const [status, type, body] = this.refusal;
    if (this.isStopped) return void answer.writeHead(status, { 'Content-Type': type }).end(body);
    if (asked.url.startsWith('/api/v1/events')) {
      if (this.isRefusing) return void answer.writeHead(status, { 'Retry-After': '10', 'Content-Type': type }).end(body);
      answer.writeHead(200, { 'Content-Type': 'text/event-stream' });
      answer.write(`retry: 200\n\n${this.events.join('')}`);
      this.streams.add(answer);
      answer.on('close', () => this.streams.delete(answer));
      return;
    }
    this.#ask(asked, answer);
  }
  #ask(asked, answer) {
    const { host, hostname, port } = this.#upstream;
    // Ask for whole answers, which can be changed, even if the browser has a cached answer.
    const { 'if-none-match': known, ...headers } = asked.headers;
    const to = request({ hostname, port, path: asked.url, headers: { ...headers, host, 'accept-encoding': 'identity' } }, (from) => {
      const parts = [];
      from.on('data', (part) => parts.push(part));
      from.on('end', () => {
        const { 'content-length': length, ...headers } = from.headers;
        answer.writeHead(from.statusCode, headers);
        answer.end(this.listed(asked.url, Buffer.concat(parts)));
      });
    });
    to.on('error', () => answer.destroy());
    to.end();
  }
}
