// Paints the rings of coasts and lakes into a mask, which has the share of water in each cell of the ground.

import { WaterMask } from '../renderer/water_texture';
import { Plane } from '../earth/projection';
import { make } from './dom';

const cellsAcross = 1024;
const farthest = 1e5; // columns and rows are limited to plus or minus this many cells

// Paints the ground within `halfXM` to the east and west of the middle, and within `halfYM` to the north and south.
export function waterMask(land: Plane[][], lakes: Plane[][], halfXM: number, halfYM: number): WaterMask {
    const cellM = (2 * Math.max(halfXM, halfYM)) / cellsAcross;
    const picture = make('canvas');
    picture.width = Math.ceil((2 * halfXM) / cellM);
    picture.height = Math.ceil((2 * halfYM) / cellM);
    const pen = picture.getContext('2d', { alpha: false, willReadFrequently: true })!;
    const bounded = (cells: number) => Math.min(farthest, Math.max(-farthest, cells));
    const paint = (rings: Plane[][], color: string) => {
        pen.beginPath();
        for (const ring of rings) {
            ring.forEach(([x, y], i) => {
                const [column, row] = [bounded((x + halfXM) / cellM), bounded((halfYM - y) / cellM)];
                if (i === 0) pen.moveTo(column, row);
                else pen.lineTo(column, row);
            });
            pen.closePath();
        }
        pen.fillStyle = color;
        pen.fill('nonzero');
    };
    // Paint sea, then land, then lakes. A cell in which two rings touch may keep a little of the color below. The
    // drawn map does not show this, because the renderer takes a place for water only if at least half of the mask
    // there is water.
    pen.fillStyle = 'white';
    pen.fillRect(0, 0, picture.width, picture.height);
    paint(land, 'black');
    paint(lakes, 'white');
    const { data } = pen.getImageData(0, 0, picture.width, picture.height);
    const shares = new Uint8Array(picture.width * picture.height);
    for (let i = 0; i < shares.length; ++i) shares[i] = data[4 * i]!;
    return { shares, width: picture.width, height: picture.height, halfXM, halfYM };
}
