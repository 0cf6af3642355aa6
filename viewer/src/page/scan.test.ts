import assert from 'node:assert/strict';
import test from 'node:test';

import { SweepRow, VolumeRow } from '../wire/api';
import { cutCells, progressOf } from './scan';

const cut = (sweep: number, elevation_deg: number, moments: string[], minute: number): SweepRow => ({
    sweep,
    elevation_deg,
    start: `2016-06-01T15:0${minute}:00Z`,
    end: `2016-06-01T15:0${minute}:30Z`,
    nyquist_mps: 8.47,
    moments: moments.map((moment) => ({ moment })),
});
const rows = [cut(0, 0.53, ['REF', 'RATE'], 0), cut(1, 0.53, ['REF', 'VEL'], 1), cut(2, 3.1, ['REF', 'VEL'], 2)];
const volume = (complete: boolean, sweeps: number, vcp = 212): VolumeRow => ({ vcp, sweeps, complete });
const atMs = (time: string) => Date.parse(`2016-06-01T${time}Z`);

test('a row of the list has angle, kind, time, Nyquist velocity and measured moments of a cut', () => {
    const speed = (mps: number) => `${mps.toFixed(1)} m/s`;
    assert.deepEqual(cutCells(rows[0]!, rows, speed), ['0.5°', 'long range', '15:00:00', '8.5 m/s', 'REF']);
    assert.deepEqual(cutCells(rows[1]!, rows, speed), ['0.5°', 'Doppler', '15:01:00', '8.5 m/s', 'REF VEL']);
    assert.deepEqual(cutCells(rows[2]!, rows, speed), ['3.1°', '', '15:02:00', '8.5 m/s', 'REF VEL']);
    // The pattern tells more than the moments.
    for (const [waveform, word] of [
        ['CS', 'surveillance'],
        ['B', 'batch'],
        ['?', ''],
    ] as const)
        assert.equal(cutCells({ ...rows[2]!, waveform }, rows, speed)[1], word);
    assert.deepEqual(cutCells({ sweep: 3, elevation_deg: 4, moments: [] }, rows, speed), ['4.0°', '', '', '', '']);
});

test('the cuts of a scan and of the scan before tell how far the scan is', () => {
    const now = atMs('15:03:00');
    assert.deepEqual(progressOf(rows, [volume(true, 12), volume(false, 3)], now), {
        text: 'Pattern 212 · scan in progress: 3 of 12 cuts, up to 3.1°',
        share: 0.25,
    });
    // A scan before that has another pattern, or is incomplete, does not tell the number of cuts.
    for (const before of [volume(true, 12, 35), volume(false, 12)])
        assert.deepEqual(progressOf(rows, [before, volume(false, 3)], now), {
            text: 'Pattern 212 · scan in progress: 3 cuts, up to 3.1°',
            share: null,
        });
});

test('a scan that ended early is not in progress', () => {
    assert.deepEqual(progressOf(rows, [volume(false, 3)], atMs('15:30:00')), {
        text: 'Pattern 212 · the file ends after 3 cuts, up to 3.1°',
        share: null,
    });
    assert.deepEqual(progressOf(rows, [volume(true, 3)], atMs('15:30:00')), {
        text: 'Pattern 212 · complete, 3 cuts',
        share: 1,
    });
    assert.equal(progressOf([], [], atMs('15:30:00')).text, 'complete, 0 cuts');
});
