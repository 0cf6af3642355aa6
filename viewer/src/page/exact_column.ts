// Finds the exact codes of one column.

import { LoadedGrid } from '../atlas/loaded_grid';
import { packed } from '../wire/api';
import { PackedGrid, readPackedBricks, withBricks } from '../wire/packed_grid';

// Returns a grid with the exact codes of a column. For a grid in parts, asks the server for them.
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
