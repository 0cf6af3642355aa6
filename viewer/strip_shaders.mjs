// Copies shaders without comments, indents and blank lines, which keeps the page small.
//   node strip_shaders.mjs FROM_DIRECTORY TO_DIRECTORY
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [from, to] = process.argv.slice(2);
mkdirSync(to, { recursive: true });
for (const name of readdirSync(from)) {
    const lines = readFileSync(join(from, name), 'utf8')
        .split('\n')
        .map((line) => line.replace(/\/\/.*/, '').trim());
    writeFileSync(join(to, name), lines.filter((line) => line !== '').join('\n'));
}
