// Starts `stormcellar serve` for checks. Errors: an Error with the output of the server.
import { spawn } from 'node:child_process';
import { resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

// Root of the tree, and the directory of real data.
export const root = fileURLToPath(new URL('../..', import.meta.url));
export const data = resolve(root, process.env.STORMCELLAR_DATA || '../shared/data');

// Starts a program, which ends with this process.
export function startBeside(program, words) {
  const child = spawn(program, words, { stdio: ['ignore', 'pipe', 'pipe'] });
  const kill = () => child.kill();
  process.on('exit', kill);
  const ended = new Promise((done) => child.on('close', done));
  const stop = async () => {
    kill();
    await ended;
    process.off('exit', kill);
  };
  return { child, stop };
}

// Starts a server. Returns its address, without a slash at the end, and a function that stops the server.
export async function startServer(program, words) {
  const { child, stop } = startBeside(program, ['serve', ...words, '--listen', '127.0.0.1:0']);
  let said = '';
  child.stderr.setEncoding('utf8').on('data', (text) => (said += text));
  const address = await new Promise((done, failed) => {
    createInterface({ input: child.stdout }).on('line', (line) => {
      const found = /^listening on (http:.*)\/$/.exec(line);
      if (found) done(found[1]);
    });
    child.on('error', failed);
    child.on('close', () => failed(new Error(`the server does not answer: ${said}`)));
  });
  return { address, stop };
}
