import assert from 'node:assert/strict';
import test from 'node:test';

import { Vec3, ViewGeometry, usualCamera } from '../camera/geometry';
import { Ray } from '../camera/ray';
import { emptyField } from '../fields/flat_field';
import { cutSection } from '../fields/section';
import { beamAt, radialsByAzimuth } from '../fields/sweep_cone';
import { boxOf } from './grid_box';
import { destination, planeOf } from '../earth/projection';
import { fieldAt, levelHit, sectionHit, sweepHit } from './solid_hits';
import { CellState, readPackedGrid } from '../wire/packed_grid';
import { PackedSweep } from '../wire/packed_sweep';
import { slantedGrid } from '../testing/written_grid';

const grid = readPackedGrid(slantedGrid(40, 36, 20));
const box = boxOf(grid);
const { halfXM, halfYM } = box;
const cameras = [
    usualCamera,
    { ...usualCamera, tiltDeg: 0 },
    { ...usualCamera, fieldOfViewDeg: 40, tiltDeg: 70, azimuthDeg: 30 },
];
const rayTo = (geometry: ViewGeometry, drawn: Vec3): Ray => new Ray(geometry, ...geometry.project(drawn)!);
const extent = { westM: -halfXM, eastM: halfXM, southM: -halfYM, northM: halfYM };

test('a reading takes the plane that the pixel shows (2026-11-28: it took the ground behind)', () => {
    const field = emptyField(4, 3);
    field.states.fill(CellState.value);
    field.values.forEach((_, i) => (field.values[i] = 10 * i));
    for (const camera of cameras) {
        const geometry = new ViewGeometry(box, camera, 2, 400, 400);
        for (let i = 0; i < 12; ++i) {
            const at: [number, number] = [((i % 4) + 0.5) / 4, (Math.floor(i / 4) + 0.5) / 3].map(
                (share, k) => (2 * share - 1) * [halfXM, halfYM][k]!,
            ) as [number, number];
            const hit = levelHit(rayTo(geometry, [...at, 6000]), { field, extent }, 3000, false)!;
            assert.equal(hit.value, 10 * i);
            assert.ok(Math.hypot(hit.at[0] - at[0], hit.at[1] - at[1]) < 1e-3);
        }
        assert.equal(levelHit(new Ray(geometry, -1e5, -1e5), { field, extent }, 3000, false), null);
    }
});

test('a reading between places of a field agrees with the drawing', () => {
    const field = emptyField(2, 1);
    field.states.set([CellState.value, CellState.value]);
    field.values.set([10, 20]);
    assert.equal(fieldAt(field, 0.9, 0.5, false).value, 10);
    assert.ok(Math.abs(fieldAt(field, 0.9, 0.5, true).value - 14) < 1e-9);
    field.states[1] = CellState.noEcho;
    assert.deepEqual(fieldAt(field, 0.9, 0.5, true), { state: CellState.value, value: 10 });
    assert.equal(fieldAt(field, 1.2, 0.5, true).state, CellState.noEcho);
});

test('a reading of a section takes the place where the ray meets it', () => {
    const plane = planeOf(grid);
    const section = cutSection(
        grid,
        'REF',
        plane.toPlace([-0.8 * halfXM, 1000]),
        plane.toPlace([0.8 * halfXM, -2000]),
        100,
        50,
    );
    const geometry = new ViewGeometry(box, cameras[2]!, 2, 400, 400);
    let read = 0;
    for (const column of [10, 33, 70]) {
        const [x, y] = [0, 1].map(
            (axis) => 0.5 * (section.ends[column]![axis]! + section.ends[column + 1]![axis]!),
        ) as [number, number];
        for (const row of [5, 25, 44]) {
            const heightM = section.bottomM + ((row + 0.5) / 50) * (section.topM - section.bottomM);
            const hit = sectionHit(rayTo(geometry, [x, y, 2 * heightM]), section, false)!;
            assert.ok(Math.abs(hit.heightM - heightM) < 1e-3 && Math.hypot(hit.at[0] - x, hit.at[1] - y) < 1e-3);
            assert.deepEqual(
                [hit.state, hit.value],
                [section.field.states[row * 100 + column]!, section.field.values[row * 100 + column]!],
            );
            if (hit.state === CellState.value) ++read;
        }
    }
    assert.ok(read > 0);
});

// A sweep with a radial in each degree.
const [radialCount, gateCount] = [360, 60];
const site = { latitudeDeg: 35.3, longitudeDeg: -97.3, altitudeM: 400 };
function sweepOf(elevationDeg: number, firstGateM: number, codeOf: (radial: number, gate: number) => number) {
    const gates: PackedSweep = {
        ...site,
        sweep: 0,
        elevationDeg,
        firstGateM,
        gateSpacingM: 250,
        firstValueCode: 2,
        ambiguousCode: -1,
        scale: 1,
        offset: 0,
        leftOut: null,
        gateStride: gateCount,
        azimuthsDeg: Float32Array.from({ length: radialCount }, (_, i) => i + 0.5),
        elevationsDeg: new Float32Array(radialCount).fill(elevationDeg),
        gateCounts: new Uint32Array(radialCount).fill(gateCount),
        startMs: 0,
        timesMs: Float64Array.from({ length: radialCount }, (_, i) => 50 * i),
        codes: Uint16Array.from({ length: radialCount * gateCount }, (_, i) =>
            codeOf(Math.floor(i / gateCount), i % gateCount),
        ),
    };
    return { station: 'KTLX', gates, radials: radialsByAzimuth(gates) };
}

test('a reading of a sweep has azimuth, range, elevation and time of the gate', () => {
    const codeOf = (radial: number, gate: number) => {
        const i = radial * gateCount + gate;
        return i % 7 === 0 ? i % 2 : 2 + i;
    };
    const sweep = sweepOf(4, 1000, codeOf);
    const plane = planeOf(grid);
    let read = 0;
    for (const camera of cameras) {
        const geometry = new ViewGeometry(box, camera, 2, 400, 400);
        for (const radial of [3, 100, 215, 300]) {
            for (const gate of [14, 30, 50]) {
                const rangeM = 1000 + 250 * gate;
                const { arcM, heightM } = beamAt(site, 4, rangeM);
                const [x, y] = plane.toPlane(destination(site, ((radial + 0.5) * Math.PI) / 180, arcM))!;
                const hit = sweepHit(rayTo(geometry, [x, y, 2 * heightM]), sweep, plane, () => true);
                assert.ok(
                    hit &&
                        Math.abs(hit.rangeM - rangeM) < 1 &&
                        Math.abs(hit.azimuthDeg - radial - 0.5) < 0.01 &&
                        Math.abs(hit.heightM - heightM) < 1,
                    JSON.stringify(hit),
                );
                const code = codeOf(radial, gate);
                assert.equal(
                    hit.state,
                    code >= 2 ? CellState.value : code === 1 ? CellState.rangeFolded : CellState.noEcho,
                );
                if (code >= 2) assert.equal(hit.value, code);
                assert.deepEqual([hit.timeMs, hit.elevationDeg], [50 * radial, 4]);
                ++read;
            }
        }
    }
    assert.ok(read > 8, `${read}`);
});

test('a reading passes clear gates of the near side of a sweep and takes the far side, as drawn (2026-11-28: it took the clear gate)', () => {
    // Echo is only north of the radar.
    const sweep = sweepOf(20, 0, (radial) => (Math.abs(radial - 180) > 90 ? 50 : 0));
    const plane = planeOf(grid);
    const { arcM, heightM } = beamAt(site, 20, 10_000);
    const north = plane.toPlane(destination(site, 0.01, arcM))!;
    // The view is from the south, along the ground.
    const geometry = new ViewGeometry(box, { ...usualCamera, tiltDeg: 90 }, 1, 400, 400);
    const ray = rayTo(geometry, [...north, heightM]);
    const read = (isShown: (hit: { state: CellState }) => boolean) => sweepHit(ray, sweep, plane, isShown)!;
    const seen = read((hit) => hit.state === CellState.value);
    assert.deepEqual([seen.state, seen.value, seen.station], [CellState.value, 50, 'KTLX']);
    assert.ok(seen.at[1] > 0 && Math.abs(seen.rangeM - 10_000) < 5, `${seen.rangeM}`);
    const clear = read(() => false);
    assert.ok(clear.state === CellState.noEcho && clear.at[1] < 0, 'if no gate is shown, the nearest gate is read');
});
