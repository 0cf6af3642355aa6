// Defines the colors of the dark theme of pictures, and a few colors that only the page has, such as those of rotation.

import { dark } from '../facts';

const css = (color: readonly number[]) => `rgb(${color.slice(0, 3).join(' ')} / ${(color[3] ?? 255) / 255})`;

export const shades = {
    ...dark,
    turning: [
        [140, 122, 255],
        [214, 240, 190],
    ], // rotation, counterclockwise and clockwise
    lake: [138, 158, 182, 200],
    axis: 'rgba(120, 130, 146, 0.35)',
    histogram: 'rgba(166, 177, 192, 0.30)',
    text: css(dark.text),
    quietText: css(dark.quietText),
    halo: css(dark.halo),
} as const;
