// Reads the packed form of a sweep's gates (docs/web/packed-grid.md).
//
// Units: meters and degrees; heights are above mean sea level.
// Errors: a PackedError if the bytes are cut or are not a packed sweep.

import { isDerivedNumber } from './moments';
import { CellState, LeftOutEcho, PackedError, leftOutAt } from './packed_grid';

export interface PackedSweep {
    latitudeDeg: number;
    longitudeDeg: number;
    altitudeM: number;
    sweep: number; // number of the sweep in its volume, from 0
    elevationDeg: number;
    firstGateM: number; // slant range to the middle of gate 0
    gateSpacingM: number;
    firstValueCode: number;
    ambiguousCode: number; // -1 if no gate can be ambiguous
    scale: number; // value = (code - offset) / scale
    offset: number;
    leftOut: LeftOutEcho | null;
    gateStride: number; // number of codes for each radial
    azimuthsDeg: Float32Array; // azimuth of each radial
    elevationsDeg: Float32Array;
    gateCounts: Uint32Array;
    startMs: number; // time of the first radial; 0 without radials
    timesMs: Float64Array; // time of each radial
    codes: Uint8Array | Uint16Array; // radial by radial
}

const magic = [0x89, 0x53, 0x43, 0x57, 0x0d, 0x0a, 0x1a, 0x0a];
const headerBytes = 128;
const radialBytes = 32;

function need(holds: boolean, what: string): void {
    if (!holds) throw new PackedError(what);
}

export function readPackedSweep(bytes: Uint8Array): PackedSweep {
    need(bytes.length >= headerBytes && magic.every((byte, i) => bytes[i] === byte), 'this is no packed sweep');
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const u32 = (at: number) => view.getUint32(at, true);
    const f32 = (at: number) => view.getFloat32(at, true);
    const f64 = (at: number) => view.getFloat64(at, true);
    const big = (at: number) => Number(view.getBigUint64(at, true));
    need(u32(8) === 1 && u32(12) === headerBytes, 'the packed sweep has another version');
    need(big(16) === bytes.byteLength, 'the packed sweep is cut');
    const [count, gateStride, codeBytes] = [u32(72), u32(76), u32(88)];
    need(codeBytes === 1 || codeBytes === 2, 'codes have one byte or two');
    const [radialsAt, codesAt] = [big(104), big(112)];
    need(
        radialsAt + count * radialBytes <= bytes.byteLength &&
            codesAt + count * gateStride * codeBytes <= bytes.byteLength,
        'the packed sweep is cut',
    );
    const section = bytes.slice(codesAt, codesAt + count * gateStride * codeBytes);
    const sweep: PackedSweep = {
        latitudeDeg: f64(24),
        longitudeDeg: f64(32),
        altitudeM: f64(40),
        sweep: u32(52),
        elevationDeg: f32(60),
        firstGateM: view.getInt32(80, true),
        gateSpacingM: view.getInt32(84, true),
        firstValueCode: u32(92),
        ambiguousCode: isDerivedNumber(u32(48)) ? u32(92) - 1 : -1,
        scale: f32(96),
        offset: f32(100),
        leftOut: leftOutAt(view, 120),
        gateStride,
        azimuthsDeg: new Float32Array(count),
        elevationsDeg: new Float32Array(count),
        gateCounts: new Uint32Array(count),
        startMs: count > 0 ? Number(view.getBigInt64(radialsAt, true)) : 0,
        timesMs: new Float64Array(count),
        codes: codeBytes === 1 ? section : new Uint16Array(section.buffer),
    };
    need(sweep.gateSpacingM > 0 && sweep.scale !== 0, 'the gates of the packed sweep have no size or no scale');
    for (let i = 0; i < count; ++i) {
        const at = radialsAt + i * radialBytes;
        sweep.timesMs[i] = Number(view.getBigInt64(at, true));
        sweep.azimuthsDeg[i] = f32(at + 8);
        sweep.elevationsDeg[i] = f32(at + 12);
        sweep.gateCounts[i] = Math.min(gateStride, u32(at + 24));
    }
    return sweep;
}

// Returns the state that a code of a gate means.
export function stateOfGate(
    { firstValueCode, ambiguousCode }: Pick<PackedSweep, 'firstValueCode' | 'ambiguousCode'>,
    code: number,
): CellState {
    if (code >= firstValueCode) return CellState.value;
    if (code === ambiguousCode) return CellState.ambiguous;
    return code === 1 ? CellState.rangeFolded : CellState.noEcho;
}
