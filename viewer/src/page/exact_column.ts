// Finds the exact codes of one column.

import { LoadedGrid } from '../atlas/loaded_grid';
import { packed } from '../wire/api';
import { PackedGrid, readPackedBricks, withBricks } from '../wire/packed_grid';

// Returns the grid with the exact codes of a column. Asks the server for those of a grid in parts.
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
