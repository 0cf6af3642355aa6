// Compiles and links each variant of each program with glslangValidator, as a browser would. Exits with 77 if there is
// no glslangValidator.

import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { exit } from 'node:process';

import * as programs from '../renderer/shader_programs';

const either = [false, true];
const grids: programs.GridVariant[] = either.flatMap((isPerspective) =>
    either.flatMap((hasUnevenLevels) => either.map((hasHalved) => ({ isPerspective, hasUnevenLevels, hasHalved }))),
);
const volumes: Partial<programs.VolumeVariant>[] = [
    {},
    { countsFetches: true },
    { endsAtSolids: true },
    { isLit: true },
    { endsAtSolids: true, isLit: true },
    { isLit: true, measuresLight: true },
];
const all: programs.ShaderProgram[] = [
    programs.lineProgram,
    programs.solidsShownProgram,
    ...either.flatMap((isPerspective) => [
        programs.groundProgram(isPerspective),
        programs.fieldProgram(isPerspective),
        programs.sweepProgram(isPerspective),
        programs.maximumProgram(isPerspective),
    ]),
    ...grids.flatMap((grid) => [
        ...volumes.map((volume) => programs.volumeProgram({ ...grid, ...volume })),
        ...either.flatMap((one) => [
            programs.surfaceProgram({ ...grid, isBelow: one, isColumn: true }),
            ...either.flatMap((other) => [
                programs.airProgram({ ...grid, hasHaze: one, hasFolded: other }),
                programs.surfaceProgram({ ...grid, isBelow: one, hasOther: other }),
            ]),
        ]),
    ]),
];

// Returns the errors of a program; an empty text if it links.
function complaintOf(directory: string, { name, defines, vertex, fragment }: programs.ShaderProgram): string {
    const files = [join(directory, 'program.vert'), join(directory, 'program.frag')];
    [vertex, fragment].forEach((parts, i) => writeFileSync(files[i]!, programs.shaderText(parts, defines)));
    const { status, stdout } = spawnSync('glslangValidator', ['-l', ...files], { encoding: 'utf8' });
    return status === 0 ? '' : `${name}:\n${stdout}`;
}

function main(): number {
    if (spawnSync('glslangValidator', ['--version']).error) {
        console.log('glslangValidator is not here (package glslang-tools)');
        return 77;
    }
    const directory = mkdtempSync(join(tmpdir(), 'shaders-'));
    const complaints = all.map((program) => complaintOf(directory, program)).filter((complaint) => complaint !== '');
    rmSync(directory, { recursive: true });
    const names = new Set(all.map(({ name }) => name));
    if (names.size !== all.length) complaints.push(`${all.length} programs have ${names.size} names`);
    console.log(complaints.join('\n') || `${all.length} programs link`);
    return complaints.length === 0 ? 0 : 1;
}

exit(main());
