// Finds the color and the opacity of a value in a table.

import { ColorTable, Rgba } from '../wire/color_tables';

// Returns the color of a value; null below the first stop.
export function colorOf(table: ColorTable, value: number): Rgba | null {
    const stops = table.stops;
    if (!(value >= stops[0]!.from)) return null;
    let i = stops.length - 1;
    while (i > 0 && value < stops[i]!.from) --i;
    const stop = stops[i]!;
    if (i === stops.length - 1) return stop.color;
    const share = (value - stop.from) / (stops[i + 1]!.from - stop.from);
    return stop.color.map((c, k) => c + share * (stop.until[k]! - c)) as Rgba;
}

// Returns the extinction of a value per meter of drawn space; 0 below the first color or the first point of opacity.
export function extinctionPerM(table: ColorTable, value: number, opacity: number): number {
    if (!colorOf(table, value)) return 0;
    const points = table.extinction;
    if (!(value >= points[0]!.value)) return 0;
    const last = points[points.length - 1]!;
    let perKm = last.per_km;
    for (let i = 1; i < points.length; ++i) {
        const [low, high] = [points[i - 1]!, points[i]!];
        if (value < high.value) {
            perKm = low.per_km + ((value - low.value) / (high.value - low.value)) * (high.per_km - low.per_km);
            break;
        }
    }
    return (perKm * opacity) / 1000;
}
