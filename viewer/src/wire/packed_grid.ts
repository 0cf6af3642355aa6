// Reads the packed form of a grid (docs/web/packed-grid.md).
//
// Units: meters and degrees; heights are above mean sea level.
// Errors: a PackedError if the bytes are cut or are not a packed grid.

import { isDerivedNumber } from './moments';

export class PackedError extends Error {}

// The states of a cell, with the numbers of CellStatus in include/stormcellar/grid/grid.h.
export const enum CellState {
    notSeen = 0,
    noEcho = 1,
    rangeFolded = 2,
    value = 3,
    ambiguous = 5, // in derived moments: echo whose value cannot be derived
}
// Bricks store and count this code and all codes above it. In derived moments this code means ambiguous, and values
// begin at the next code, `PackedGrid.firstCode`.
export const firstValueCode = 3;

export const enum BrickKind {
    uniform = 0,
    states = 1,
    codes = 2,
}

// Echo that is left out because it is probably not weather.
export interface LeftOutEcho {
    share: number; // of the echo; negative: unknown
}
// Reads the two numbers of LeftOutEcho at an offset; null if no echo is left out.
export const leftOutAt = (view: DataView, at: number): LeftOutEcho | null =>
    view.getFloat32(at, true) > 0 ? { share: view.getFloat32(at + 4, true) } : null;

export interface Site {
    latitudeDeg: number;
    longitudeDeg: number;
    altitudeM: number;
    icao: string;
}

// Describes where the columns of a grid are on the earth.
export interface GridPlace {
    projection: number;
    nx: number;
    ny: number;
    centerDeg: [number, number]; // latitude, longitude
    spacing: number; // in meters, or in degrees for a grid in latitude and longitude
    parallelsDeg: [number, number];
    offsetCells: [number, number];
}

export interface PackedGrid extends GridPlace {
    id: string;
    halvings: number; // how often columns and rows were halved
    nz: number;
    momentNumber: number;
    codeBytes: number;
    firstCode: number; // the first code that means a value
    firstValue: number; // value of code 3
    step: number;
    brickEdge: number;
    bricks: [number, number, number]; // along x, y, z
    timeMs: number;
    startMs: number;
    endMs: number;
    isPartial: boolean;
    isProvisional: boolean;
    leftOut: LeftOutEcho | null;
    levelsM: Float64Array;
    sites: Site[];
    // One entry for each brick, z fastest, then y, then x.
    kind: Uint8Array;
    state: Uint8Array;
    valueCount: Uint16Array;
    leastCode: Uint16Array;
    greatestCode: Uint16Array;
    block: Uint32Array;
    states: Uint8Array; // all blocks of states, four cells in a byte
    codes: Uint8Array | Uint16Array; // all blocks of codes
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

// The bricks [first, end) of a grid's table.
export interface PackedBricks {
    id: string;
    halvings: number;
    first: number;
    end: number;
    firstStates: number; // number of the first block of states, among all blocks of states of the grid
    states: Uint8Array;
    firstBlock: number; // number of the first block of codes, among all blocks of codes of the grid
    codes: Uint8Array | Uint16Array;
}

export const enum Part {
    whole = 0,
    table = 1,
    bricks = 2,
}

// Reads numbers and sections by the offsets of docs/web/packed-grid.md.
class Header {
    private view: DataView;
    readonly part: Part;
    readonly codeBytes: number;
    readonly cells: number; // number of cells in a brick

    constructor(private bytes: Uint8Array) {
        need(isMagic(bytes), 'this is no packed grid');
        this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
        need(this.u32(8) === 1 && this.u32(12) === headerBytes, 'the packed grid has another version');
        need(this.big(16) === bytes.byteLength, 'the packed grid is cut');
        this.part = this.u32(160);
        this.codeBytes = this.u32(108);
        need(this.codeBytes === 1 || this.codeBytes === 2, 'codes have one byte or two');
        this.cells = this.u32(120) ** 3;
    }
    u32(at: number): number {
        return this.view.getUint32(at, true);
    }
    f32(at: number): number {
        return this.view.getFloat32(at, true);
    }
    f64(at: number): number {
        return this.view.getFloat64(at, true);
    }
    big(at: number): number {
        return Number(this.view.getBigUint64(at, true));
    }
    ms(at: number): number {
        return Number(this.view.getBigInt64(at, true));
    }
    get id(): string {
        return this.view.getBigUint64(24, true).toString(16).padStart(16, '0');
    }
    get data(): DataView {
        return this.view;
    }
    get place(): GridPlace {
        return {
            projection: this.u32(32),
            nx: this.u32(36),
            ny: this.u32(40),
            centerDeg: [this.f64(48), this.f64(56)],
            spacing: this.f64(64),
            parallelsDeg: [this.f64(72), this.f64(80)],
            offsetCells: [this.f64(88), this.f64(96)],
        };
    }
    // Returns a section of `size` bytes. The header has the offset of the section at `offsetAt`.
    section(offsetAt: number, size: number): Uint8Array {
        if (size === 0) return new Uint8Array(0);
        const from = this.big(offsetAt);
        need(from + size <= this.bytes.byteLength, 'the packed grid is cut');
        return this.bytes.subarray(from, from + size);
    }
    codes(count = this.u32(196) * this.cells): Uint8Array | Uint16Array {
        const section = this.section(240, count * this.codeBytes);
        // Copy the section, so that it is aligned and the rest of the answer can be freed.
        const own = section.slice();
        return this.codeBytes === 1 ? own : new Uint16Array(own.buffer);
    }
}

function readTable(header: Header, grid: PackedGrid): void {
    const tableAt = header.big(224);
    const view = header.data;
    const rows = grid.kind.length;
    need(tableAt + rows * rowBytes <= view.byteLength, 'the packed grid is cut');
    for (let i = 0; i < rows; ++i) {
        const at = tableAt + i * rowBytes;
        grid.kind[i] = view.getUint8(at);
        need(grid.kind[i]! <= BrickKind.codes, 'the packed grid has a brick of an unknown kind');
        grid.state[i] = view.getUint8(at + 1);
        grid.valueCount[i] = view.getUint16(at + 2, true);
        grid.leastCode[i] = view.getUint16(at + 4, true);
        grid.greatestCode[i] = view.getUint16(at + 6, true);
        grid.block[i] = view.getUint32(at + 8, true);
    }
}

// Reads the place of a grid, which is in the header.
export function readPlace(bytes: Uint8Array): GridPlace {
    return new Header(bytes).place;
}

// Reads a whole grid, or the table of a grid without states and codes.
export function readGridOrTable(bytes: Uint8Array): { grid: PackedGrid; isWhole: boolean } {
    const header = new Header(bytes);
    need(header.part !== Part.bricks, 'a part of a packed grid is no grid');
    const u32 = (at: number) => header.u32(at);
    const f64 = (at: number) => header.f64(at);
    const nz = u32(44);
    const bricks: [number, number, number] = [u32(124), u32(128), u32(132)];
    const rows = u32(204);
    need(rows === bricks[0] * bricks[1] * bricks[2], 'the table does not fit the bricks');
    const [stateBlocks, codeBlocks] = [u32(188), u32(196)];
    const levelsAt = header.big(208);
    need(levelsAt + nz * 8 <= bytes.byteLength, 'the packed grid is cut');
    const levelsM = new Float64Array(nz);
    for (let z = 0; z < nz; ++z) levelsM[z] = f64(levelsAt + 8 * z);
    const isWhole = header.part === Part.whole;
    const hasValuesAlone = isWhole && (u32(172) & 4) !== 0;
    const hasCells = isWhole && !hasValuesAlone;
    const grid: PackedGrid = {
        id: header.id,
        halvings: u32(164),
        ...header.place,
        nz,
        momentNumber: u32(104),
        codeBytes: header.codeBytes,
        firstCode: isDerivedNumber(u32(104)) ? firstValueCode + 1 : firstValueCode,
        firstValue: header.f32(112),
        step: header.f32(116),
        brickEdge: u32(120),
        bricks,
        timeMs: header.ms(136),
        startMs: header.ms(144),
        endMs: header.ms(152),
        isPartial: (u32(172) & 1) !== 0,
        isProvisional: (u32(172) & 2) !== 0,
        leftOut: leftOutAt(header.data, 248),
        levelsM,
        sites: readSites(header.data, header.big(216), u32(200)),
        kind: new Uint8Array(rows),
        state: new Uint8Array(rows),
        valueCount: new Uint16Array(rows),
        leastCode: new Uint16Array(rows),
        greatestCode: new Uint16Array(rows),
        block: new Uint32Array(rows),
        states: hasCells ? header.section(232, (stateBlocks * header.cells) / 4) : new Uint8Array(0),
        codes: hasCells ? header.codes() : new Uint8Array(0),
    };
    readTable(header, grid);
    if (hasValuesAlone) spreadValues(header, grid);
    else if (isWhole) needBlocks(grid, stateBlocks, codeBlocks);
    return { grid, isWhole };
}

// Decodes the form that has codes only for cells with values. The states of all cells tell which cells have values.
// Each code is stored as the difference from the previous code.
function spreadValues(header: Header, grid: PackedGrid): void {
    const { cells } = header;
    const states = header.section(232, (header.u32(188) * cells) / 4);
    const values = header.codes(header.u32(196));
    const count = (kind: BrickKind) => grid.kind.reduce((sum, one) => sum + (one === kind ? 1 : 0), 0);
    const codeBricks = count(BrickKind.codes);
    need(count(BrickKind.states) + codeBricks === header.u32(188), 'a block of states is missing');
    const codes = grid.codeBytes === 1 ? new Uint8Array(codeBricks * cells) : new Uint16Array(codeBricks * cells);
    grid.states = new Uint8Array((count(BrickKind.states) * cells) / 4);
    let [block, value, toStates, toCodes] = [0, 0, 0, 0];
    for (let i = 1; i < values.length; ++i) values[i]! += values[i - 1]!;
    for (const kind of grid.kind) {
        if (kind === BrickKind.uniform) continue;
        const four = states.subarray((block * cells) / 4, (++block * cells) / 4);
        if (kind === BrickKind.states) {
            grid.states.set(four, toStates);
            toStates += four.length;
            continue;
        }
        for (let i = 0; i < four.length; ++i, toCodes += 4) {
            const bits = four[i]!;
            if (bits === 0) continue;
            for (let cell = 0; cell < 4; ++cell) {
                const state = (bits >> (2 * cell)) & 3;
                codes[toCodes + cell] = state === CellState.value ? values[value++]! : state;
            }
        }
    }
    need(value === values.length, 'there are not as many codes as values');
    grid.codes = codes;
}

function needBlocks(grid: PackedGrid, stateBlocks: number, codeBlocks: number): void {
    for (let i = 0; i < grid.kind.length; ++i) {
        need(grid.kind[i] !== BrickKind.states || grid.block[i]! < stateBlocks, 'a block of states is missing');
        need(grid.kind[i] !== BrickKind.codes || grid.block[i]! < codeBlocks, 'a block of codes is missing');
    }
}

// Reads a whole grid: its table, states and codes.
export function readPackedGrid(bytes: Uint8Array): PackedGrid {
    const { grid, isWhole } = readGridOrTable(bytes);
    need(isWhole, 'a part of a packed grid is no grid');
    return grid;
}

export function readPackedBricks(bytes: Uint8Array): PackedBricks {
    const header = new Header(bytes);
    need(header.part === Part.bricks, 'these are no bricks of a packed grid');
    const [first, end] = [header.u32(176), header.u32(180)];
    return {
        id: header.id,
        halvings: header.u32(164),
        first,
        end,
        firstStates: header.u32(184),
        states: header.section(232, (header.u32(188) * header.cells) / 4),
        firstBlock: header.u32(192),
        codes: header.codes(),
    };
}

// Adds the cells of some bricks to the table of a grid. Only these bricks of the result may be read.
export function withBricks(grid: PackedGrid, bricks: PackedBricks): PackedGrid {
    const block = grid.block.slice();
    for (let i = bricks.first; i < bricks.end; ++i)
        block[i]! -= grid.kind[i] === BrickKind.codes ? bricks.firstBlock : bricks.firstStates;
    return { ...grid, block, states: bricks.states, codes: bricks.codes };
}

// Returns the state that a code means.
export function stateOf(grid: Pick<PackedGrid, 'firstCode'>, code: number): CellState {
    if (code < firstValueCode) return code;
    return code < grid.firstCode ? CellState.ambiguous : CellState.value;
}

// Returns true if a brick may hold a value. Bricks count ambiguous cells like values.
export function mayHoldValues(grid: PackedGrid, brick: number): boolean {
    return (
        grid.kind[brick] === BrickKind.codes &&
        grid.valueCount[brick]! > 0 &&
        grid.greatestCode[brick]! >= grid.firstCode
    );
}

// Returns the code of a cell: 0 not seen, 1 no echo, 2 range folded, 3 and above a value (see stateOf()).
export function codeAt(grid: PackedGrid, x: number, y: number, z: number): number {
    const edge = grid.brickEdge;
    const brick =
        (Math.floor(x / edge) * grid.bricks[1] + Math.floor(y / edge)) * grid.bricks[2] + Math.floor(z / edge);
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
