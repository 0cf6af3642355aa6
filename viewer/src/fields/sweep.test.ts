import assert from 'node:assert/strict';
import test from 'node:test';

import { cutOf, kindOf, nearestSite, nextTilt, repeatsOf, tiltsOf } from './sweep_choice';
import { azimuthSteps, beamAt, coneOf, noRadial, radialsByAzimuth } from './sweep_cone';
import { planeOf } from '../earth/projection';
import { PackedError } from '../wire/packed_grid';
import { readPackedSweep } from '../wire/packed_sweep';
import { placeAbout } from '../testing/written_grid';

// Returns a packed sweep (docs/web/packed-grid.md) with radials at these azimuths. The code of each gate depends on
// radial and gate.
function packedSweep(azimuths: number[], gateCount: number): Uint8Array {
    const [radialsAt, codesAt] = [128, 128 + 32 * azimuths.length];
    const view = new DataView(new ArrayBuffer(codesAt + azimuths.length * gateCount));
    [0x89, 0x53, 0x43, 0x57, 0x0d, 0x0a, 0x1a, 0x0a, 1, 0, 0, 0, 128].forEach((byte, i) => view.setUint8(i, byte));
    view.setBigUint64(16, BigInt(view.byteLength), true);
    [35.3331, -97.2777, 389].forEach((value, i) => view.setFloat64(24 + 8 * i, value, true));
    view.setFloat32(60, 0.5, true);
    [azimuths.length, gateCount].forEach((value, i) => view.setUint32(72 + 4 * i, value, true));
    [2000, 1000].forEach((value, i) => view.setInt32(80 + 4 * i, value, true));
    [1, 2].forEach((value, i) => view.setUint32(88 + 4 * i, value, true));
    [2, 66].forEach((value, i) => view.setFloat32(96 + 4 * i, value, true));
    [radialsAt, codesAt].forEach((value, i) => view.setBigUint64(104 + 8 * i, BigInt(value), true));
    azimuths.forEach((azimuth, i) => {
        view.setFloat32(radialsAt + 32 * i + 8, azimuth, true);
        view.setFloat32(radialsAt + 32 * i + 12, 0.5, true);
        view.setUint32(radialsAt + 32 * i + 24, gateCount, true);
        for (let gate = 0; gate < gateCount; ++gate)
            view.setUint8(codesAt + i * gateCount + gate, (7 * i + gate) % 256);
    });
    return new Uint8Array(view.buffer);
}

test('a packed sweep is read as docs/web/packed-grid.md says', () => {
    const sweep = readPackedSweep(packedSweep([10, 11, 12], 20));
    assert.equal(sweep.firstGateM, 2000);
    assert.equal(sweep.codes[20 * 2 + 5], 19);
    assert.equal((sweep.codes[19]! - sweep.offset) / sweep.scale, -23.5);
    assert.equal(sweep.leftOut, null, 'all echo is there');
    const weather = packedSweep([10], 20);
    [0.5, 0.125].forEach((value, i) => new DataView(weather.buffer).setFloat32(120 + 4 * i, value, true));
    assert.deepEqual(readPackedSweep(weather).leftOut, { share: 0.125 });
    assert.throws(() => readPackedSweep(packedSweep([10], 20).subarray(0, 140)), PackedError);
    assert.throws(() => readPackedSweep(new Uint8Array(200)), PackedError);
});

test('each azimuth has its nearest radial, and azimuths in a gap have none', () => {
    const azimuths = Array.from({ length: 360 }, (_, i) => (i + 200.25) % 360).filter(
        (azimuth) => azimuth < 90 || azimuth > 95,
    );
    const found = radialsByAzimuth(readPackedSweep(packedSweep(azimuths, 4)));
    for (let step = 0; step < azimuthSteps; ++step) {
        const azimuth = ((step + 0.5) * 360) / azimuthSteps;
        const off = azimuths.map((one) => Math.abs(((one - azimuth + 540) % 360) - 180));
        const nearest = off.indexOf(Math.min(...off));
        if (off[nearest]! > 0.5001) assert.equal(found[step], noRadial, `${azimuth}`);
        else if (off[nearest]! < 0.4999) assert.equal(found[step], nearest, `${azimuth}`);
    }
});

test('the height of a beam at half a degree agrees with the formula of Doviak and Zrnic', () => {
    const radius = (4 / 3) * 6371e3;
    const { arcM, heightM } = beamAt({ latitudeDeg: 35, altitudeM: 400 }, 0.5, 200000);
    const height =
        Math.sqrt(200000 ** 2 + radius ** 2 + 2 * 200000 * radius * Math.sin((0.5 * Math.PI) / 180)) - radius + 400;
    assert(Math.abs(heightM - height) < 15, `${heightM} ${height}`);
    assert(
        Math.abs(arcM - radius * Math.asin((200000 * Math.cos((0.5 * Math.PI) / 180)) / (radius + height - 400))) < 60,
    );
});

test('the cone is around its site', () => {
    const plane = planeOf(placeAbout([35.3331, -97.2777]));
    const sweep = readPackedSweep(packedSweep([0, 90, 180, 270], 100));
    const { corners, triangles } = coneOf(sweep, plane);
    for (let i = 0; i < corners.length; i += 5 * 97) {
        const [x, y, height, azimuth, range] = corners.subarray(i, i + 5) as unknown as [
            number,
            number,
            number,
            number,
            number,
        ];
        const beam = beamAt(sweep, 0.5, range);
        assert(Math.abs(Math.hypot(x, y) - beam.arcM) < 0.1 && Math.abs(height - beam.heightM) < 0.1);
        assert(Math.abs(x - beam.arcM * Math.sin((azimuth * Math.PI) / 180)) < 0.1);
    }
    assert(Math.max(...triangles) < corners.length / 5);
});

test('a split cut shows the half that pictures take, and either half can be chosen (2026-11-28: reflectivity came from the Doppler half)', () => {
    const row = (sweep: number, elevation_deg: number, ...moments: string[]) => ({
        sweep,
        elevation_deg,
        moments: moments.map((text) => ({ moment: text.replace('!', ''), chosen: text.endsWith('!') })),
    });
    // Two split cuts and a whole cut. The lower split cut is repeated. The server says which cuts pictures take.
    const rows = [
        row(0, 0.48, 'REF', 'ZDR'),
        row(1, 0.5, 'REF', 'VEL'),
        row(2, 0.9, 'REF!', 'ZDR!'),
        row(3, 0.88, 'REF', 'VEL!'),
        row(4, 0.52, 'REF!', 'ZDR!'),
        row(5, 0.5, 'REF', 'VEL!'),
        row(6, 2.4, 'REF!', 'VEL!', 'ZDR!'),
    ];
    const shown = (moment: string, elevation: number, number: number | null = null) =>
        cutOf(rows, moment, elevation, number)?.sweep;
    assert.deepEqual([shown('REF', 0.5), shown('VEL', 0.5), shown('REF', 0.9), shown('VEL', 9)], [4, 5, 2, 6]);
    assert.equal(shown('SW', 0.5), undefined);
    assert.equal(shown('REF', 0.5, 1), 1, 'the user chose this cut by its number');
    assert.equal(shown('REF', 0.5, 3), 4, 'cut 3 has another elevation, so its number does not count');
    assert.deepEqual(
        tiltsOf(rows, 'REF').map((tilt) => tilt.map((one) => one.sweep)),
        [[0, 1, 4, 5], [2, 3], [6]],
    );
    const repeats = (moment: string, number: number) => repeatsOf(rows, moment, rows[number]!).map((one) => one.sweep);
    assert.deepEqual(
        [repeats('REF', 4), repeats('REF', 1), repeats('VEL', 5)],
        [
            [0, 4],
            [1, 5],
            [1, 5],
        ],
    );
    assert.deepEqual([repeats('ZDR', 6), repeats('VEL', 0)], [[6], []]);
    assert.deepEqual([cutOf(rows, 'REF', 0.5, 'first')?.sweep, cutOf(rows, 'VEL', 0.5, 'first')?.sweep], [0, 1]);
    const next = (moment: string, number: number, by: 1 | -1) => nextTilt(rows, moment, rows[number]!, by)?.sweep;
    assert.deepEqual([next('REF', 4, 1), next('REF', 2, 1), next('REF', 6, 1)], [2, 6, undefined]);
    assert.deepEqual([next('REF', 6, -1), next('REF', 3, -1), next('REF', 0, -1)], [2, 4, undefined]);
    assert.deepEqual([next('VEL', 1, 1), next('VEL', 6, -1), next('SW', 6, 1)], [3, 3, undefined]);
    assert.deepEqual(
        rows.map((one) => kindOf(one, rows)),
        ['surveillance', 'doppler', 'surveillance', 'doppler', 'surveillance', 'doppler', ''],
    );
});

test('the site nearest to a place is chosen', () => {
    const plane = planeOf(placeAbout([35, -97]));
    const site = (icao: string, latitudeDeg: number, longitudeDeg: number) => ({
        icao,
        latitudeDeg,
        longitudeDeg,
        altitudeM: 0,
    });
    const sites = [site('KTLX', 35.33, -97.28), site('KFDR', 34.36, -98.98)];
    assert.equal(nearestSite(sites, plane, [0, 0])!.icao, 'KTLX');
    assert.equal(nearestSite(sites, plane, [-150000, -60000])!.icao, 'KFDR');
    assert.equal(nearestSite([], plane, [0, 0]), null);
});
