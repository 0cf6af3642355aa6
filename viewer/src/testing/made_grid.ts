// A packed grid made by the document alone (docs/web/packed-grid.md): its bytes, and its cells.

export interface Made {
    bytes: Uint8Array;
    code(x: number, y: number, z: number): number;
    nx: number;
    ny: number;
    nz: number;
}

const edge = 16;

// Codes that tell every axis apart: echo in a slanted band, its neighborhood seen, the rest not.
export function madeCode(x: number, y: number, z: number): number {
    const far = Math.abs(x - 2 * y + 3 * z - 10);
    if (far < 6) return 40 + ((x * 7 + y * 3 + z * 5) % 60);
    if (far < 30) return 1;
    return far < 60 && (x + y + z) % 11 === 0 ? 2 : 0;
}

export function makeGrid(nx: number, ny: number, nz: number, codeBytes: 1 | 2 = 1, scale = 1): Made {
    const code = (x: number, y: number, z: number) => {
        const own = madeCode(x, y, z);
        return own < 3 ? own : own * scale;
    };
    const bricks = [nx, ny, nz].map((n) => Math.ceil(n / edge)) as [number, number, number];
    const table: number[][] = [];
    const states: number[][] = [];
    const codes: number[][] = [];
    for (let bx = 0; bx < bricks[0]; ++bx) {
        for (let by = 0; by < bricks[1]; ++by) {
            for (let bz = 0; bz < bricks[2]; ++bz) {
                const cells: number[] = [];
                for (let x = bx * edge; x < (bx + 1) * edge; ++x)
                    for (let y = by * edge; y < (by + 1) * edge; ++y)
                        for (let z = bz * edge; z < (bz + 1) * edge; ++z)
                            cells.push(x < nx && y < ny && z < nz ? code(x, y, z) : 0);
                const values = cells.filter((one) => one >= 3);
                if (values.length > 0) {
                    table.push([2, 0, values.length, Math.min(...values), Math.max(...values), codes.length]);
                    codes.push(cells);
                } else if (cells.every((one) => one === cells[0])) {
                    table.push([0, cells[0]!, 0, 0, 0, 0]);
                } else {
                    table.push([1, 0, 0, 0, 0, states.length]);
                    states.push(cells);
                }
            }
        }
    }
    const cellCount = edge ** 3;
    const levelsAt = 256;
    const sitesAt = levelsAt + nz * 8;
    const tableAt = sitesAt + 32;
    const statesAt = tableAt + table.length * 12 + ((4 - ((tableAt + table.length * 12) % 4)) % 4);
    const codesAt = statesAt + (states.length * cellCount) / 4;
    const size = codesAt + codes.length * cellCount * codeBytes;
    const bytes = new Uint8Array(size);
    const view = new DataView(bytes.buffer);
    bytes.set([0x89, 0x53, 0x43, 0x50, 0x0d, 0x0a, 0x1a, 0x0a]);
    const u32 = (at: number, ...values: number[]) =>
        values.forEach((value, i) => view.setUint32(at + 4 * i, value, true));
    const f64 = (at: number, ...values: number[]) =>
        values.forEach((value, i) => view.setFloat64(at + 8 * i, value, true));
    u32(8, 1, 256);
    view.setBigUint64(16, BigInt(size), true);
    view.setBigUint64(24, 0x0123456789abcdefn, true);
    u32(32, 0, nx, ny, nz);
    f64(48, 35.3, -97.3, 1000, 0, 0, 0, 0);
    u32(104, 0, codeBytes);
    view.setFloat32(112, -32, true);
    view.setFloat32(116, 0.5 / scale, true);
    u32(120, edge, ...bricks);
    view.setBigInt64(136, 1_000_000n, true);
    u32(188, states.length);
    u32(196, codes.length, 1, table.length);
    [levelsAt, sitesAt, tableAt, statesAt, codesAt].forEach((at, i) =>
        view.setBigUint64(208 + 8 * i, BigInt(at), true),
    );
    for (let z = 0; z < nz; ++z) f64(levelsAt + 8 * z, 500 * (z + 1));
    f64(sitesAt, 35.3, -97.3, 400);
    bytes.set([75, 84, 76, 88], sitesAt + 24);
    table.forEach(([kind, state, count, least, greatest, block], i) => {
        const at = tableAt + 12 * i;
        bytes[at] = kind!;
        bytes[at + 1] = state!;
        view.setUint16(at + 2, count!, true);
        view.setUint16(at + 4, least!, true);
        view.setUint16(at + 6, greatest!, true);
        u32(at + 8, block!);
    });
    states.forEach((cells, b) =>
        cells.forEach((one, i) => (bytes[(statesAt + (b * cellCount + i) / 4) | 0]! |= one << (2 * (i & 3)))),
    );
    codes.forEach((cells, b) =>
        cells.forEach((one, i) =>
            codeBytes === 1
                ? (bytes[codesAt + b * cellCount + i] = one)
                : view.setUint16(codesAt + 2 * (b * cellCount + i), one, true),
        ),
    );
    return { bytes, code, nx, ny, nz };
}
