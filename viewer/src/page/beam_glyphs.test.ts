import assert from 'node:assert/strict';
import test from 'node:test';

import { Camera, ViewGeometry, usualCamera } from '../camera/geometry';
import { GridPlane, destination, geodesic, planeOf } from '../earth/projection';
import { boxOf } from '../scene/grid_box';
import { evenLevels, packedGrid } from '../testing/written_grid';
import { readPackedGrid } from '../wire/packed_grid';
import { PackedSweep } from '../wire/packed_sweep';
import { BeamGlyph, Pixel, pixelsPerMps, planGlyphs } from './beam_glyphs';
import { beamAt, coneOf, radialsByAzimuth, rangeAt } from '../fields/sweep_cone';

const grid = readPackedGrid(packedGrid({ nx: 200, ny: 200, levelsM: evenLevels(16), codeOf: () => 1 }));
const plane = planeOf(grid);
const [width, height] = [500, 400];
const radians = Math.PI / 180;

// Returns a sweep about the middle of the grid, whose codes depend on the azimuth. A code of 500 is 0 m/s.
function sweepOf(codeAt: (azimuthDeg: number) => number): PackedSweep {
    const [radials, gates] = [360, 300];
    const site = plane.toPlace([0, 0]);
    return {
        ...site,
        altitudeM: 400,
        sweep: 0,
        elevationDeg: 0.5,
        firstGateM: 0,
        gateSpacingM: 500,
        firstValueCode: 3,
        ambiguousCode: 2,
        scale: 10,
        offset: 500,
        leftOut: null,
        gateStride: gates,
        azimuthsDeg: Float32Array.from({ length: radials }, (_, i) => i + 0.5),
        elevationsDeg: new Float32Array(radials).fill(0.5),
        gateCounts: new Uint32Array(radials).fill(gates),
        startMs: 0,
        timesMs: new Float64Array(radials),
        codes: Uint16Array.from({ length: radials * gates }, (_, i) => codeAt(Math.floor(i / gates))),
    };
}
function glyphsOf(gates: PackedSweep, camera: Partial<Camera>, onto: GridPlane = plane): BeamGlyph[] {
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, ...camera }, 3, width, height);
    const drawn = { station: 'KTLX', gates, radials: radialsByAzimuth(gates), cone: coneOf(gates, onto) };
    return planGlyphs(geometry, drawn, onto, 1, 1);
}
const lengthOf = ({ gate, tip }: BeamGlyph) => Math.hypot(tip[0] - gate[0], tip[1] - gate[1]);
const above: Partial<Camera> = { azimuthDeg: 180, tiltDeg: 0, fieldOfViewDeg: 0 };

test('a range is found from the arc of a beam', () => {
    const site = { latitudeDeg: 35, altitudeM: 400 };
    for (const elevationDeg of [0.5, 4, 19.5])
        for (const rangeM of [1000, 50_000, 230_000])
            assert.ok(Math.abs(rangeAt(site, elevationDeg, beamAt(site, elevationDeg, rangeM).arcM) - rangeM) < 0.01);
});

test('from above, each line points along the beam to where the air goes, with a length in proportion to the speed', () => {
    const [east, west] = [-12.5, 30];
    const sweep = sweepOf((azimuthDeg) => 500 + 10 * (azimuthDeg < 180 ? east : west));
    const glyphs = glyphsOf(sweep, above);
    assert.ok(glyphs.length > 60);
    for (const glyph of glyphs) {
        const [x, y] = [glyph.gate[0] - width / 2, height / 2 - glyph.gate[1]]; // from the radar
        if (Math.abs(x) < 1) continue; // between two radials of different values
        assert.equal(glyph.value, x > 0 ? east : west);
        assert.ok(Math.abs(lengthOf(glyph) - pixelsPerMps * Math.abs(glyph.value)) < 1e-6);
        const away = (glyph.tip[0] - glyph.gate[0]) * x - (glyph.tip[1] - glyph.gate[1]) * y;
        assert.ok(Math.abs(away - Math.hypot(x, y) * pixelsPerMps * glyph.value) < 0.01 * Math.abs(away));
        // The disc is across the line.
        const [[ax, ay]] = glyph.axes;
        assert.ok(Math.abs(ax * x - ay * y) < 0.05 * Math.hypot(ax, ay) * Math.hypot(x, y));
    }
});

test('in three dimensions, lines and discs follow the beam on its cone', () => {
    const sweep = sweepOf(() => 700);
    const camera = { azimuthDeg: 200, tiltDeg: 65 };
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, ...camera }, 3, width, height);
    const glyphs = glyphsOf(sweep, camera);
    assert.ok(glyphs.length > 30);
    const pixelAt = (azimuthDeg: number, rangeM: number): Pixel => {
        const { arcM, heightM } = beamAt(sweep, sweep.elevationDeg, rangeM);
        const [x, y] = plane.toPlane(destination(sweep, azimuthDeg * radians, arcM))!;
        return geometry.project([x, y, heightM * geometry.exaggeration])!;
    };
    for (const { gate, tip, axes } of glyphs) {
        // Find the gate again, among all beams, and look along its beam.
        let best = { off: Infinity, azimuthDeg: 0, rangeM: 0 };
        for (let azimuthDeg = 0; azimuthDeg < 360; azimuthDeg += 2)
            for (let rangeM = 2000; rangeM < 145_000; rangeM += 1500) {
                const [x, y] = pixelAt(azimuthDeg, rangeM);
                const off = Math.hypot(x - gate[0], y - gate[1]);
                if (off < best.off) best = { off, azimuthDeg, rangeM };
            }
        if (best.rangeM < 20_000) continue; // the directions of neighboring beams differ
        const [from, to] = [0, 8000].map((more) => pixelAt(best.azimuthDeg, best.rangeM + more));
        const wanted = Math.atan2(to![1] - from![1], to![0] - from![0]);
        const turned = Math.atan2(tip[1] - gate[1], tip[0] - gate[0]) - wanted;
        assert.ok(Math.abs(Math.atan2(Math.sin(turned), Math.cos(turned))) < 0.15);
        const [[a, b], [c, d]] = axes;
        assert.ok(Math.abs(a * d - b * c) > 5, 'a disc is never a line');
    }
});

test('only gates with a velocity have glyphs, and a calm has no head', () => {
    // Range folded, ambiguous, no echo, and values.
    const sweep = sweepOf((azimuthDeg) => [1, 2, 0, 505][Math.floor(azimuthDeg / 90)]!);
    const glyphs = glyphsOf(sweep, above);
    assert.ok(glyphs.length > 20);
    for (const glyph of glyphs) {
        assert.ok(glyph.gate[0] < width / 2 + 1 && glyph.gate[1] < height / 2 + 1, 'the north-west has the values');
        assert.equal(lengthOf(glyph), 0);
    }
    assert.deepEqual(
        glyphsOf(
            sweepOf(() => 2),
            above,
        ),
        [],
    );
    assert.deepEqual(
        glyphsOf(
            sweepOf(() => 1),
            { tiltDeg: 60 },
        ),
        [],
    );
});

test('glyphs keep apart, and stay at their places on the ground', () => {
    const sweep = sweepOf(() => 900);
    const apart = (glyphs: BeamGlyph[]) => {
        for (const [i, one] of glyphs.entries())
            for (const other of glyphs.slice(0, i))
                assert.ok(Math.hypot(one.gate[0] - other.gate[0], one.gate[1] - other.gate[1]) > 10);
    };
    const far = glyphsOf(sweep, above);
    const near = glyphsOf(sweep, { ...above, zoom: 30 });
    apart(far);
    apart(near);
    apart(glyphsOf(sweep, { tiltDeg: 80 }));
    assert.ok(near.length > 20);
    // A view that moves by a whole step of the lattice shows the same glyphs elsewhere.
    const [first] = glyphsOf(sweep, { ...above, zoom: 4 });
    const moved = glyphsOf(sweep, { ...above, zoom: 4, lookAtM: [3000, 0, 0] });
    const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, ...above, zoom: 4 }, 3, width, height);
    const shift = 3000 / geometry.metersPerPixel;
    assert.ok(
        moved.some(({ gate }) => Math.hypot(gate[0] + shift - first!.gate[0], gate[1] - first!.gate[1]) < 0.5) ||
            first!.gate[0] < shift + 10,
    );
    const place = plane.toPlace([0, 0]);
    assert.ok(geodesic(place, { latitudeDeg: sweep.latitudeDeg, longitudeDeg: sweep.longitudeDeg }).distanceM < 1);
});
