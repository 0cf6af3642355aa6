import assert from 'node:assert/strict';
import test from 'node:test';

import { beamReading, beamWidthM } from './beam_reading';
import { beamAt, beamTo } from './sweep_cone';
import { destination } from '../earth/projection';
import { GridFacts } from '../wire/api';

const site = { latitudeDeg: 35.33, longitudeDeg: -97.28, altitudeM: 389, icao: 'KTLX' };

test('beamTo() is the inverse of beamAt()', () => {
    for (const elevationDeg of [0.5, 4, 19.5, 60]) {
        for (const rangeM of [1000, 50000, 230000]) {
            const { arcM, heightM } = beamAt(site, elevationDeg, rangeM);
            const back = beamTo(site, arcM, heightM);
            assert.ok(Math.abs(back.elevationDeg - elevationDeg) < 1e-9 && Math.abs(back.rangeM - rangeM) < 1e-5);
        }
    }
});

test('a reading has the nearest site, the nearest sweep, the time of the radial and the audit of its range', () => {
    const facts = {
        provenance: {
            source_files: [],
            stations: ['KTLX'],
            predicted_error: '',
            sweeps: [
                { elevation_deg: 0.5, start: '2024-01-01T00:00:00Z', first_azimuth_deg: 350, degrees_per_s: 20 },
                { elevation_deg: 4, start: '2024-01-01T00:01:00Z', first_azimuth_deg: 90, degrees_per_s: -10 },
            ],
        },
        audit: {
            unit: 'dB',
            summary: '',
            rows: [
                { elevation_deg: 0.5, range_from_m: 0, range_to_m: 60000, count: 9, rms: 1 },
                { elevation_deg: 0.5, range_from_m: 60000, range_to_m: null, count: 9, rms: 2 },
                { elevation_deg: 4, range_from_m: 60000, range_to_m: null, count: 0, rms: 0 },
            ],
        },
    } as unknown as GridFacts;
    const at = (elevationDeg: number, azimuthDeg: number) => {
        const { arcM, heightM } = beamAt(site, elevationDeg, 100000);
        return beamReading(
            [{ ...site, latitudeDeg: 40, icao: 'KFAR' }, site],
            facts,
            destination(site, (azimuthDeg * Math.PI) / 180, arcM),
            heightM,
        )!;
    };
    const low = at(0.7, 30);
    assert.deepEqual([low.icao, low.sweepDeg, low.rms], ['KTLX', 0.5, 2]);
    assert.ok(Math.abs(low.timeMs! - Date.parse('2024-01-01T00:00:02Z')) < 1, 'forty degrees take two seconds');
    assert.ok(Math.abs(low.widthM - 1658) < 1);
    assert.ok(
        Math.abs(beamWidthM('TSTL', 100000) - 960) < 1 && Math.abs(beamWidthM('TJUA', 100000) - 1658) < 1,
        'a TDWR has a narrower beam (2026-11-28)',
    );
    const high = at(5, 80);
    assert.ok(Math.abs(high.timeMs! - Date.parse('2024-01-01T00:01:01Z')) < 1, 'the antenna turns the other way');
    const unknown = beamReading([site], null, destination(site, 1, 50000), 2000)!;
    assert.deepEqual([unknown.sweepDeg, unknown.timeMs, unknown.rms], [null, null, null]);
    assert.equal(beamReading([], facts, site, 0), null);
});
