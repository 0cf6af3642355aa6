// Tests which pictures the start map shows, and which tiles it asks for.
import assert from 'node:assert/strict';
import test from 'node:test';

import { isInside } from '../../map/places';
import type { Domain } from '../../wire/api';

const at = (minute: number): string => `2026-11-28T10:${String(minute).padStart(2, '0')}:00Z`;
const server = {
    stations: [] as object[],
    stationsOf: {} as Record<string, string[]>,
    id: 'first',
    tiles: [] as string[],
};
Object.assign(globalThis, {
    window: globalThis,
    document: { baseURI: 'http://localhost/view/' },
    Image: class {
        src = '';
        width = 256;
        decode = (): Promise<void> => Promise.resolve();
    },
    fetch: (url: string, options: RequestInit): Promise<Response> => {
        const { pathname } = new URL(url);
        if (pathname.startsWith('/tiles/'))
            return (server.tiles.push(`${pathname} ${options.cache}`), Promise.resolve(new Response('png')));
        if (pathname.endsWith('/stations'))
            return Promise.resolve(new Response(JSON.stringify({ stations: server.stations })));
        const [, domain] = /grids\/(\w+)\//.exec(pathname)!;
        const isStation = domain!.startsWith('K');
        const cells = isStation ? 460 : 800;
        const provenance = { stations: server.stationsOf[domain!] ?? [domain] };
        return Promise.resolve(
            new Response(
                JSON.stringify({
                    id: server.id,
                    projection: 'azimuthal_equidistant',
                    center: isStation ? [41, -77] : [42, -75],
                    spacing_m: 1000,
                    offset_cells: [0, 0],
                    nx: cells,
                    ny: cells,
                    greatest: 50,
                    provenance,
                }),
            ),
        );
    },
});
const domain = (name: string, newest: string, moment = 'REF', age_s = 60): Domain => ({
    domain: name,
    part_of: null,
    moments: [{ moment, units: 'dBZ', grids: 1, newest, age_s }],
});
const station = (name: string, newest: string): object => ({
    station: name,
    latitude_deg: 41,
    longitude_deg: -77,
    newest_volume: null,
    newest_grid: { time: newest, age_s: 60 },
    moments: ['REF'],
});
const wait = (): Promise<void> => new Promise((done) => setTimeout(done, 20));

async function drawn(
    domains: Domain[],
): Promise<{ names: string[]; data: InstanceType<typeof import('./start_data').StartData> }> {
    const { StartData } = await import('./start_data');
    const data = new StartData(() => undefined);
    await data.load(domains, null);
    const pictures = () =>
        data.pictures(domains, data.stations, ({ places }, one) =>
            isInside(
                places.map((place) => [place.longitudeDeg, place.latitudeDeg]),
                one.longitudeDeg,
                one.latitudeDeg,
            ),
        );
    pictures();
    await wait();
    return { names: pictures().map((seen) => seen.domain.domain), data };
}

test('a mosaic replaces only the radars that are in it (2026-11-28: other radars in its box were not drawn)', async () => {
    server.stations = [station('KBGM', at(10)), station('KCCX', at(10))];
    server.stationsOf = { south: ['KBGM'] };
    assert.deepEqual((await drawn([domain('KBGM', at(10)), domain('KCCX', at(10)), domain('south', at(5))])).names, [
        'KCCX',
        'south',
    ]);
});

test('a mosaic that is far behind one of its radars is not drawn (2026-11-28: it hid the newer picture of the radar)', async () => {
    server.stations = [station('KBGM', at(45)), station('KCCX', at(10))];
    server.stationsOf = { south: ['KBGM', 'KCCX'] };
    assert.deepEqual(
        (await drawn([domain('KBGM', at(45)), domain('KCCX', at(10)), domain('south', at(10))])).names.sort(),
        ['KBGM', 'KCCX'],
    );
});

test('a radar whose clock is ahead does not make a mosaic old', async () => {
    server.stations = [
        { ...station('KBGM', at(45)), newest_grid: { time: at(45), age_s: -2000 } },
        station('KCCX', at(10)),
    ];
    server.stationsOf = { south: ['KBGM', 'KCCX'] };
    assert.deepEqual((await drawn([domain('KBGM', at(45)), domain('KCCX', at(10)), domain('south', at(10))])).names, [
        'south',
    ]);
});

test('the count of radars that are not drawn leaves out radars without reflectivity', async () => {
    const names = Array.from({ length: 14 }, (_, i) => `K${String.fromCharCode(65 + i)}AA`);
    server.stations = names.map((name) => station(name, at(10)));
    const { data } = await drawn(names.map((name, i) => domain(name, at(10), i < 13 ? 'REF' : 'VEL')));
    assert.equal(data.unpictured, 1);
});

test('a remade grid and the age of a mosaic are updated (2026-11-28: both were kept while the time stayed the same)', async () => {
    server.stations = [station('KCCX', at(10))];
    server.stationsOf = { south: ['KBGM'] };
    const domains = [domain('KCCX', at(10)), domain('south', at(10))];
    const { data } = await drawn(domains);
    server.id = 'second';
    await data.load([domains[0]!, domain('south', at(10), 'REF', 90)], null);
    assert.deepEqual(
        [data.find(domains[0]!)?.facts?.id, data.mosaics[0]!.facts?.id, data.mosaics[0]!.domain.moments[0]!.age_s],
        ['second', 'second', 90],
    );
});

test('tiles of a remade grid are asked for again, and the old tiles stay until they come', async () => {
    const { Tiles } = await import('./tiles');
    let images: unknown[] = [];
    const pen = { drawImage: (image: unknown) => images.push(image) } as unknown as CanvasRenderingContext2D;
    const tiles = new Tiles(() => undefined);
    const draw = (id: string): number => {
        images = [];
        tiles.begin();
        tiles.draw(pen, { domain: 'south', time: at(10), id }, { zoom: 6, column: 18, row: 23, x: 0, y: 0, side: 256 });
        return images.length;
    };
    assert.deepEqual([draw('first'), tiles.lacks], [0, true]);
    await wait();
    assert.deepEqual([draw('first'), tiles.lacks], [1, false]);
    const [before] = images;
    assert.deepEqual([draw('second'), tiles.lacks, images[0] === before], [1, true, true]);
    await wait();
    assert.deepEqual([draw('second'), tiles.lacks, images[0] === before], [1, false, false]);
    assert.equal(server.tiles.length, 2);
    assert.ok(
        server.tiles.every((tile) => tile.endsWith('.png no-cache')),
        server.tiles.join(),
    );
});
