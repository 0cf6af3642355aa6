// Writes packed grids (docs/web/packed-grid.md) for tests.

import { GridPlace } from '../wire/packed_grid';

export interface Made {
    nx: number;
    ny: number;
    levelsM: number[];
    moment?: number; // number of the moment
    codeBytes?: 1 | 2;
    firstValue?: number;
    step?: number;
    spacing?: number;
    offsetCells?: [number, number];
    halvings?: number;
    // Returns the code of a cell: 0 not seen, 1 no echo, 2 range folded, 3 and above a value.
    codeOf(x: number, y: number, z: number): number;
}

const edge = 16;
const cells = edge ** 3;

interface Brick {
    kind: number;
    state: number;
    count: number;
    least: number;
    greatest: number;
    codes: number[];
}

function brickOf(made: Made, bx: number, by: number, bz: number): Brick {
    const brick: Brick = { kind: 0, state: 0, count: 0, least: 0, greatest: 0, codes: [] };
    for (let i = 0; i < cells; ++i) {
        const [x, y, z] = [
            bx * edge + Math.floor(i / 256),
            by * edge + (Math.floor(i / 16) % 16),
            bz * edge + (i % 16),
        ];
        const inside = x < made.nx && y < made.ny && z < made.levelsM.length;
        brick.codes.push(inside ? made.codeOf(x, y, z) : 0);
    }
    const values = brick.codes.filter((code) => code >= 3);
    brick.count = values.length;
    if (values.length > 0) {
        brick.kind = 2;
        brick.least = Math.min(...values);
        brick.greatest = Math.max(...values);
    } else if (brick.codes.some((code) => code !== brick.codes[0])) brick.kind = 1;
    else brick.state = brick.codes[0]!;
    return brick;
}

export function packedGrid(made: Made): Uint8Array {
    const { nx, ny, levelsM } = made;
    const nz = levelsM.length;
    const codeBytes = made.codeBytes ?? 1;
    const counts = [nx, ny, nz].map((n) => Math.ceil(n / edge)) as [number, number, number];
    const bricks: Brick[] = [];
    for (let x = 0; x < counts[0]; ++x)
        for (let y = 0; y < counts[1]; ++y) for (let z = 0; z < counts[2]; ++z) bricks.push(brickOf(made, x, y, z));
    const stateBlocks = bricks.filter((brick) => brick.kind === 1);
    const codeBlocks = bricks.filter((brick) => brick.kind === 2);
    const levelsAt = 256;
    const sitesAt = levelsAt + 8 * nz;
    const tableAt = sitesAt + 32;
    const statesAt = tableAt + 12 * bricks.length;
    const codesAt = statesAt + (stateBlocks.length * cells) / 4;
    const size = codesAt + codeBlocks.length * cells * codeBytes;
    const view = new DataView(new ArrayBuffer(size));
    [0x89, 0x53, 0x43, 0x50, 0x0d, 0x0a, 0x1a, 0x0a].forEach((byte, i) => view.setUint8(i, byte));
    const u32 = (at: number, value: number) => view.setUint32(at, value, true);
    const f64 = (at: number, value: number) => view.setFloat64(at, value, true);
    const big = (at: number, value: number) => view.setBigUint64(at, BigInt(value), true);
    u32(8, 1);
    u32(12, 256);
    big(16, size);
    view.setBigUint64(24, 0xabc0123456789defn, true);
    [nx, ny, nz].forEach((n, i) => u32(36 + 4 * i, n));
    f64(48, 35.3331);
    f64(56, -97.2777);
    f64(64, made.spacing ?? 1000);
    (made.offsetCells ?? [0, 0]).forEach((cells, i) => f64(88 + 8 * i, cells));
    u32(164, made.halvings ?? 0);
    u32(104, made.moment ?? 0);
    u32(108, codeBytes);
    view.setFloat32(112, made.firstValue ?? -32, true);
    view.setFloat32(116, made.step ?? 0.5, true);
    u32(120, edge);
    counts.forEach((n, i) => u32(124 + 4 * i, n));
    [1000, 500, 1500].forEach((ms, i) => view.setBigInt64(136 + 8 * i, BigInt(ms), true));
    u32(180, bricks.length);
    u32(188, stateBlocks.length);
    u32(196, codeBlocks.length);
    u32(200, 1);
    u32(204, bricks.length);
    [levelsAt, sitesAt, tableAt, statesAt, codesAt].forEach((at, i) => big(208 + 8 * i, at));
    levelsM.forEach((height, i) => f64(levelsAt + 8 * i, height));
    f64(sitesAt, 35.3331);
    f64(sitesAt + 8, -97.2777);
    f64(sitesAt + 16, 389);
    Array.from('KTLX').forEach((letter, i) => view.setUint8(sitesAt + 24 + i, letter.charCodeAt(0)));
    bricks.forEach((brick, i) => {
        const at = tableAt + 12 * i;
        view.setUint8(at, brick.kind);
        view.setUint8(at + 1, brick.state);
        view.setUint16(at + 2, brick.count, true);
        view.setUint16(at + 4, brick.least, true);
        view.setUint16(at + 6, brick.greatest, true);
        u32(at + 8, brick.kind === 1 ? stateBlocks.indexOf(brick) : brick.kind === 2 ? codeBlocks.indexOf(brick) : 0);
    });
    stateBlocks.forEach((brick, block) =>
        brick.codes.forEach((code, i) => {
            const at = statesAt + (block * cells + i) / 4;
            view.setUint8(Math.floor(at), view.getUint8(Math.floor(at)) | (code << (2 * (i % 4))));
        }),
    );
    codeBlocks.forEach((brick, block) =>
        brick.codes.forEach((code, i) => {
            const at = codesAt + (block * cells + i) * codeBytes;
            if (codeBytes === 1) view.setUint8(at, code);
            else view.setUint16(at, code, true);
        }),
    );
    return new Uint8Array(view.buffer);
}

// Returns the place of a grid of 400 x 400 km about a center.
export const placeAbout = (centerDeg: [number, number]): GridPlace => ({
    projection: 0,
    centerDeg,
    parallelsDeg: [0, 0],
    offsetCells: [0, 0],
    spacing: 1000,
    nx: 400,
    ny: 400,
});

export function evenLevels(count: number, spacingM = 500): number[] {
    return Array.from({ length: count }, (_, i) => 500 + i * spacingM);
}

// Returns a pseudo-random number for a cell, the same in each run.
export function scrambled(x: number, y: number, z: number): number {
    let bits = (x * 73856093) ^ (y * 19349663) ^ (z * 83492791);
    bits = Math.imul(bits ^ (bits >>> 13), 1274126177);
    return (bits ^ (bits >>> 16)) >>> 0;
}

// Makes a slanted band of echo with clear air about it and unseen air beyond. Codes change along each axis.
export function slantedGrid(nx: number, ny: number, nz: number, codeBytes: 1 | 2 = 1, scale = 1): Uint8Array {
    const codeOf = (x: number, y: number, z: number): number => {
        const far = Math.abs(x - 2 * y + 3 * z - 10);
        if (far < 6) return (40 + ((x * 7 + y * 3 + z * 5) % 60)) * scale;
        if (far < 30) return 1;
        return far < 60 && (x + y + z) % 11 === 0 ? 2 : 0;
    };
    return packedGrid({ nx, ny, levelsM: evenLevels(nz), codeBytes, step: 0.5 / scale, codeOf });
}
