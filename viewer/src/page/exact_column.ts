// The exact codes of one column, for readings.

import { LoadedGrid } from '../atlas/loaded_grid';
import { packed } from '../wire/api';
import { PackedGrid, readPackedBricks, withBricks } from '../wire/packed_grid';

// The grid with the exact codes of a column. Of a grid in parts they are asked for.
export async function gridForColumn({ grid, stream }: LoadedGrid, [x, y]: [number, number]): Promise<PackedGrid> {
    if (!stream) return grid;
    const [, columns, layers] = grid.bricks;
    const first = (Math.floor(x / grid.brickEdge) * columns + Math.floor(y / grid.brickEdge)) * layers;
    const query = { bricks: `${first}-${first + layers - 1}`, id: grid.id };
    return withBricks(
        grid,
        readPackedBricks(new Uint8Array(await packed(stream.domain, stream.moment, stream.time, query))),
    );
}
