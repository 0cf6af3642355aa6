// Copies shaders without comments, blank lines and needless blanks, which keeps the page small.
//   node strip_shaders.mjs FROM_DIRECTORY TO_DIRECTORY
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

// Removes blanks beside operators, but not in `a - -b`, and not in directives, where they may matter.
const withoutBlanks = (line) =>
    line.startsWith('#') ? line : line.replace(/ ?([=*/,;(){}<>?:&|!%]) ?/g, '$1').replace(/ ([+-]) (?![+-])/g, '$1');

const [from, to] = process.argv.slice(2);
mkdirSync(to, { recursive: true });
for (const name of readdirSync(from)) {
    const lines = readFileSync(join(from, name), 'utf8')
        .split('\n')
        .map((line) => withoutBlanks(line.replace(/\/\/.*/, '').trim()));
    writeFileSync(join(to, name), lines.filter((line) => line !== '').join('\n'));
}
