// Reads a file of shapes. The text's first letter tells its format: GeoJSON begins with a brace, other files are
// placefiles (render/overlay/shape_file.h).

import { shapesOfGeojson } from './geojson_shapes';
import { shapesOfPlacefile } from './placefile_shapes';
import { Shapes } from './shapes';

// Throws an Error with the place of the damage.
export function shapesOfText(text: string): Shapes {
    const plain = text.replace(/^\uFEFF/, '');
    if (!plain.trimStart().startsWith('{')) return shapesOfPlacefile(plain);
    let value: unknown;
    try {
        value = JSON.parse(plain);
    } catch (error) {
        // Browsers add the place of the damage.
        throw new Error(`it is no valid JSON: ${error instanceof Error ? error.message : ''}`);
    }
    return shapesOfGeojson(value);
}
