// Simplifies lines by leaving out corners that change little. Measures how different colors look.

import { Rgba } from '../wire/color_tables';

// Chooses the points to keep from a line of `count` points (Douglas and Peucker), and returns their indexes.
// `errorAt(first, last, i)` returns the error of leaving out point i between the kept points `first` and `last`. The
// error of each left out point is at most `most`.
export function cornersToKeep(
    count: number,
    most: number,
    errorAt: (first: number, last: number, i: number) => number,
): number[] {
    const kept = new Set([0, count - 1]);
    const open: [number, number][] = [[0, count - 1]];
    for (let range = open.pop(); range; range = open.pop()) {
        const [first, last] = range;
        let [worst, at] = [most, -1];
        for (let i = first + 1; i < last; ++i) {
            const error = errorAt(first, last, i);
            if (error > worst) [worst, at] = [error, i];
        }
        if (at < 0) continue;
        kept.add(at);
        open.push([first, at], [at, last]);
    }
    return [...kept].sort((a, b) => a - b);
}

const linearOf = (level: number): number =>
    level <= 10.31475 ? level / 3294.6 : ((level / 255 + 0.055) / 1.055) ** 2.4;

// Returns the color in OKLab, in which equal distances look about equal (render/color/ok_lab.h).
export function okLabOf([r, g, b]: Readonly<Rgba>): [number, number, number] {
    const [red, green, blue] = [linearOf(r), linearOf(g), linearOf(b)];
    const l = Math.cbrt(0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue);
    const m = Math.cbrt(0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue);
    const s = Math.cbrt(0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue);
    return [
        0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
    ];
}

// Returns how different two colors look. A difference of 0.02 is just visible side by side.
export function colorDistance(one: Readonly<Rgba>, other: Readonly<Rgba>): number {
    const [a, b] = [okLabOf(one), okLabOf(other)];
    return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

export function mixed(one: Rgba, other: Rgba, share: number): Rgba {
    return one.map((c, k) => c + share * (other[k]! - c)) as Rgba;
}
