// Reads the packed form of a grid (docs/web/packed-grid.md).
//
// Units: meters and degrees; heights are above mean sea level.
// Errors: a PackedError for bytes that are no packed grid or are cut.

export class PackedError extends Error {}

export const enum CellState {
    notSeen = 0,
    noEcho = 1,
    rangeFolded = 2,
    value = 3,
}
export const firstValueCode = 3;

export const enum BrickKind {
    uniform = 0,
    states = 1,
    codes = 2,
}

export interface Site {
    latitudeDeg: number;
    longitudeDeg: number;
    altitudeM: number;
    icao: string;
}

export interface PackedGrid {
    id: string;
    projection: number;
    nx: number;
    ny: number;
    nz: number;
    centerDeg: [number, number]; // latitude, longitude
    spacing: number; // meters, or degrees of a grid in latitude and longitude
    parallelsDeg: [number, number];
    offsetCells: [number, number];
    momentNumber: number;
    codeBytes: number;
    firstValue: number;
    step: number;
    brickEdge: number;
    bricks: [number, number, number]; // along x, y, z
    timeMs: number;
    startMs: number;
    endMs: number;
    isPartial: boolean;
    isProvisional: boolean;
    levelsM: Float64Array;
    sites: Site[];
    // Of each brick, z fastest, then y, then x.
    kind: Uint8Array;
    state: Uint8Array;
    valueCount: Uint16Array;
    leastCode: Uint16Array;
    greatestCode: Uint16Array;
    block: Uint32Array;
    states: Uint8Array; // of all blocks of states, four cells a byte
    codes: Uint8Array | Uint16Array; // of all blocks of codes
}

const magic = [0x89, 0x53, 0x43, 0x50, 0x0d, 0x0a, 0x1a, 0x0a];
const headerBytes = 256;
const rowBytes = 12;
const siteBytes = 32;

function need(holds: boolean, what: string): void {
    if (!holds) throw new PackedError(what);
}

function isMagic(bytes: Uint8Array): boolean {
    return bytes.length >= headerBytes && magic.every((byte, i) => bytes[i] === byte);
}

function readSites(view: DataView, at: number, count: number): Site[] {
    const sites: Site[] = [];
    for (let i = 0; i < count; ++i) {
        const from = at + i * siteBytes;
        let icao = '';
        for (let c = 0; c < 8; ++c) {
            const letter = view.getUint8(from + 24 + c);
            if (letter !== 0) icao += String.fromCharCode(letter);
        }
        sites.push({
            latitudeDeg: view.getFloat64(from, true),
            longitudeDeg: view.getFloat64(from + 8, true),
            altitudeM: view.getFloat64(from + 16, true),
            icao,
        });
    }
    return sites;
}

// The whole of a grid: its table, states and codes.
export function readPackedGrid(bytes: Uint8Array): PackedGrid {
    need(isMagic(bytes), 'this is no packed grid');
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const u32 = (at: number) => view.getUint32(at, true);
    const f64 = (at: number) => view.getFloat64(at, true);
    const big = (at: number) => Number(view.getBigUint64(at, true));
    const ms = (at: number) => Number(view.getBigInt64(at, true));
    need(u32(8) === 1 && u32(12) === headerBytes, 'the packed grid has another version');
    need(big(16) === bytes.byteLength, 'the packed grid is cut');
    need(u32(160) === 0, 'a part of a packed grid is no grid');
    const nz = u32(44);
    const brickEdge = u32(120);
    const bricks: [number, number, number] = [u32(124), u32(128), u32(132)];
    const rows = u32(204);
    need(rows === bricks[0] * bricks[1] * bricks[2], 'the table does not fit the bricks');
    const cells = brickEdge ** 3;
    const codeBytes = u32(108);
    need(codeBytes === 1 || codeBytes === 2, 'codes have one byte or two');
    const offsets = [208, 216, 224, 232, 240].map(big);
    const [levelsAt, sitesAt, tableAt, statesAt, codesAt] = offsets as [number, number, number, number, number];
    const stateBlocks = u32(188);
    const codeBlocks = u32(196);
    need(levelsAt + nz * 8 <= bytes.byteLength && tableAt + rows * rowBytes <= bytes.byteLength, 'the packed grid is cut');
    need(statesAt + (stateBlocks * cells) / 4 <= bytes.byteLength, 'the packed grid is cut');
    need(codesAt + codeBlocks * cells * codeBytes <= bytes.byteLength, 'the packed grid is cut');
    const levelsM = new Float64Array(nz);
    for (let z = 0; z < nz; ++z) levelsM[z] = f64(levelsAt + 8 * z);
    const grid: PackedGrid = {
        id: view.getBigUint64(24, true).toString(16).padStart(16, '0'),
        projection: u32(32),
        nx: u32(36),
        ny: u32(40),
        nz,
        centerDeg: [f64(48), f64(56)],
        spacing: f64(64),
        parallelsDeg: [f64(72), f64(80)],
        offsetCells: [f64(88), f64(96)],
        momentNumber: u32(104),
        codeBytes,
        firstValue: view.getFloat32(112, true),
        step: view.getFloat32(116, true),
        brickEdge,
        bricks,
        timeMs: ms(136),
        startMs: ms(144),
        endMs: ms(152),
        isPartial: (u32(172) & 1) !== 0,
        isProvisional: (u32(172) & 2) !== 0,
        levelsM,
        sites: readSites(view, sitesAt, u32(200)),
        kind: new Uint8Array(rows),
        state: new Uint8Array(rows),
        valueCount: new Uint16Array(rows),
        leastCode: new Uint16Array(rows),
        greatestCode: new Uint16Array(rows),
        block: new Uint32Array(rows),
        states: stateBlocks === 0 ? new Uint8Array(0) : bytes.subarray(statesAt, statesAt + (stateBlocks * cells) / 4),
        codes: new Uint8Array(0),
    };
    for (let i = 0; i < rows; ++i) {
        const at = tableAt + i * rowBytes;
        grid.kind[i] = view.getUint8(at);
        grid.state[i] = view.getUint8(at + 1);
        grid.valueCount[i] = view.getUint16(at + 2, true);
        grid.leastCode[i] = view.getUint16(at + 4, true);
        grid.greatestCode[i] = view.getUint16(at + 6, true);
        grid.block[i] = u32(at + 8);
        need(grid.kind[i] !== BrickKind.states || grid.block[i]! < stateBlocks, 'a block of states is missing');
        need(grid.kind[i] !== BrickKind.codes || grid.block[i]! < codeBlocks, 'a block of codes is missing');
    }
    if (codeBlocks > 0) {
        const section = bytes.slice(codesAt, codesAt + codeBlocks * cells * codeBytes);
        grid.codes = codeBytes === 1 ? section : new Uint16Array(section.buffer);
    }
    return grid;
}

// The code of a cell: 0 not seen, 1 no echo, 2 range folded, from 3 on a value.
export function codeAt(grid: PackedGrid, x: number, y: number, z: number): number {
    const edge = grid.brickEdge;
    const brick = (Math.floor(x / edge) * grid.bricks[1] + Math.floor(y / edge)) * grid.bricks[2] + Math.floor(z / edge);
    const cell = ((x % edge) * edge + (y % edge)) * edge + (z % edge);
    const cells = edge ** 3;
    switch (grid.kind[brick]) {
        case BrickKind.codes:
            return grid.codes[grid.block[brick]! * cells + cell]!;
        case BrickKind.states: {
            const at = grid.block[brick]! * cells + cell;
            return (grid.states[at >> 2]! >> (2 * (at & 3))) & 3;
        }
        default:
            return grid.state[brick]!;
    }
}

export function valueOf(grid: PackedGrid, code: number): number {
    return grid.firstValue + grid.step * (code - firstValueCode);
}
