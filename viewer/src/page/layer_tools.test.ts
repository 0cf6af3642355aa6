import assert from 'node:assert/strict';
import test from 'node:test';

import { ViewGeometry, usualCamera } from '../camera/geometry';
import { levelCodes } from '../fields/level_codes';
import { CropTool, SectionGrip, SectionTool, acrossView, fromRadar } from './layer_tools';
import { TextureShelf } from '../renderer/graphics';
import { boxOf } from '../scene/grid_box';
import { usualLayers } from '../scene/layers';
import { Place, planeOf } from '../earth/projection';
import { codeAt, readPackedGrid } from '../wire/packed_grid';
import { evenLevels, packedGrid, scrambled } from '../testing/written_grid';

const grid = readPackedGrid(
    packedGrid({
        nx: 100,
        ny: 80,
        levelsM: evenLevels(18),
        codeOf: (x, y, z) => (x < 30 ? scrambled(x, y, z) % 200 : x < 60 ? (y + z) % 3 : 1),
    }),
);
const plane = planeOf(grid);
// A view from above, in which a pixel is a place on the ground.
const geometry = new ViewGeometry(boxOf(grid), { ...usualCamera, tiltDeg: 0 }, 3, 400, 300);

Object.assign(globalThis, { window: { devicePixelRatio: 1 } });
function madeApp() {
    const app = {
        state: { layers: { ...usualLayers } },
        shown: { loaded: { grid } },
        changes: 0,
        changed: () => {
            ++app.changes;
        },
    };
    return app;
}
type Args = ConstructorParameters<typeof SectionTool>;
const drawing = { geometry: () => geometry, move: () => undefined } as unknown as Args[1];
const nothing = () => undefined;
const isNear = (a: readonly number[], b: readonly number[]) => Math.hypot(a[0]! - b[0]!, a[1]! - b[1]!) < 1;

test('a section goes from the press to the release, and its ends can be moved', () => {
    const app = madeApp();
    let done = 0;
    const tool = new SectionTool(
        app as unknown as Args[0],
        drawing,
        () => {
            ++done;
        },
        nothing,
    );
    assert(tool.press(100, 100));
    tool.drag(300, 200);
    tool.release();
    assert.equal(done, 1);
    const ends = () => app.state.layers.section!.map((place) => plane.toPlane(place)!);
    assert(isNear(ends()[0]!, geometry.ground(100, 100)!) && isNear(ends()[1]!, geometry.ground(300, 200)!));
    tool.press(102, 98); // near A
    tool.drag(50, 250);
    tool.release();
    assert(isNear(ends()[0]!, geometry.ground(50, 250)!) && isNear(ends()[1]!, geometry.ground(300, 200)!));
});

test('without the tool, only presses on an end move the section, and A can go to the radar', () => {
    const app = madeApp();
    const [a, b] = [geometry.ground(100, 100)!, geometry.ground(300, 200)!].map((at) => plane.toPlace(at)) as [
        Place,
        Place,
    ];
    app.state.layers.section = [a, b];
    const grip = new SectionGrip(app as unknown as Args[0], drawing);
    assert.equal(grip.press(200, 150), false);
    assert(grip.press(302, 199));
    grip.drag(250, 280);
    grip.release();
    const [first, second] = app.state.layers.section as readonly Place[];
    assert(isNear(plane.toPlane(first!)!, plane.toPlane(a)!));
    assert(isNear(plane.toPlane(second!)!, geometry.ground(250, 280)!));
    const site = grid.sites[0]!;
    const radial = fromRadar(app as unknown as Args[0], [site, b])!;
    assert.deepEqual(radial, [{ latitudeDeg: site.latitudeDeg, longitudeDeg: site.longitudeDeg }, b]);
    assert.deepEqual(fromRadar(app as unknown as Args[0], [b, site]), radial, 'the farther end is B');
});

test('a press without a drag makes no section', () => {
    const app = madeApp();
    const tool = new SectionTool(app as unknown as Args[0], drawing, nothing, nothing);
    tool.press(100, 100);
    tool.drag(101, 101);
    tool.release();
    assert.equal(app.state.layers.section, null);
    assert.equal(app.changes, 0);
});

test('a section across the view is level in the picture', () => {
    const [a, b] = acrossView(madeApp() as unknown as Args[0], geometry)!.map((place) =>
        geometry.project([...plane.toPlane(place)!, 0])!,
    );
    assert(Math.abs(a![1] - b![1]) < 0.1 && Math.abs(b![0] - a![0] - 0.6 * 400) < 0.1);
});

test('a box has corners at the press and at the release', () => {
    const app = madeApp();
    const tool = new CropTool(app as unknown as Args[0], drawing, nothing, nothing);
    tool.press(300, 100);
    tool.drag(120, 220);
    const { westM, eastM, southM, northM, bottomM } = app.state.layers.crop!;
    assert(isNear([westM, southM], geometry.ground(120, 220)!) && isNear([eastM, northM], geometry.ground(300, 100)!));
    assert.equal(bottomM, boxOf(grid).bottomM);
});

test('levelCodes() returns the codes of the cells of a level', () => {
    for (const z of [0, 15, 16, 17]) {
        const codes = levelCodes(grid, z);
        for (let y = 0; y < grid.ny; ++y)
            for (let x = 0; x < grid.nx; ++x) assert.equal(codes[y * grid.nx + x], codeAt(grid, x, y, z));
    }
});

test('textures are made once, and released after a picture that did not need them', () => {
    const deleted: unknown[] = [];
    const shelf = new TextureShelf({
        deleteTexture: (one: unknown) => deleted.push(one),
    } as unknown as WebGL2RenderingContext);
    const [a, b] = [{}, {}];
    let made = 0;
    const make = () => ++made as unknown as WebGLTexture;
    assert.equal(shelf.take('plane', a, make), shelf.take('plane', a, make));
    assert.equal(made, 1);
    shelf.clear();
    assert.deepEqual(deleted, []);
    shelf.take('plane', b, make);
    assert.deepEqual(deleted, [1]);
    shelf.clear();
    shelf.clear();
    assert.deepEqual(deleted, [1, 2]);
});
