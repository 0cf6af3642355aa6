// Makes a picture to save: what the page shows, with title, colors and legend, but without controls.

import { shades } from '../renderer/shades';
import { element, fontOf, make, textScale } from './dom';
import { haloed } from './labels';

const told = ['title', 'station-told', 'sites-told', 'layers-told', 'overlays-told'];
const toldOfPanes = told.filter((id) => id !== 'layers-told'); // each pane tells its own
const lineHeight = 20;
const swatch = 10;

// Returns the lines of text in the page without the age of the data, which would be wrong later.
function shownLines(ids: readonly string[]): string[] {
    const lines = ids.map((id) => element(id)).filter((one) => !one.hidden);
    return lines
        .map((one) =>
            [...one.childNodes]
                .filter((node) => !(node instanceof HTMLSpanElement))
                .map((node) => node.textContent)
                .join(''),
        )
        .filter(Boolean);
}

// Wraps a line of text into rows of at most a width.
function rowsOf(pen: CanvasRenderingContext2D, line: string, width: number): string[] {
    const rows: string[] = [];
    for (const word of line.split(' ')) {
        const row = rows.length > 0 ? `${rows[rows.length - 1]} ${word}` : '';
        if (row !== '' && pen.measureText(row).width <= width) rows[rows.length - 1] = row;
        else rows.push(word);
    }
    return rows;
}

// Draws the rows of the legend from `top` on, at the right edge.
function drawLegend(pen: CanvasRenderingContext2D, right: number, top: number): void {
    pen.font = fontOf(11);
    [...element('legend').children].forEach((row, i) => {
        const shown = row.querySelector('span');
        const color = shown?.style.backgroundColor;
        const text = row.textContent ?? '';
        const y = top + i * (swatch + 6);
        const left = right - pen.measureText(text).width;
        haloed(pen, text, left, y + swatch / 2, shades.text);
        if (!color) return;
        pen.fillStyle = color;
        pen.fillRect(left - swatch - 5, y, swatch, swatch);
        pen.strokeStyle = shades.quietText;
        pen.lineWidth = 1;
        const from = left - swatch - 5;
        pen.strokeRect(from, y, swatch, swatch);
        if (!shown.classList.contains('hatched')) return;
        pen.strokeStyle = shown.style.color;
        pen.beginPath();
        for (const share of [0.35, 0.7, 1]) {
            pen.moveTo(from, y + share * swatch);
            pen.lineTo(from + share * swatch, y);
        }
        pen.stroke();
    });
}

// Draws the picture as large as the page shows it. A coarser picture is enlarged below the labels, as on the page.
export function snapshotOf(picture: HTMLCanvasElement, labels: HTMLCanvasElement): HTMLCanvasElement {
    const all = make('canvas');
    all.width = labels.width;
    all.height = labels.height;
    const pen = all.getContext('2d')!;
    pen.drawImage(picture, 0, 0, all.width, all.height);
    pen.drawImage(labels, 0, 0);
    const ratio = all.width / labels.clientWidth;
    const bar = element<HTMLCanvasElement>('bar');
    const place = bar.getBoundingClientRect();
    pen.drawImage(bar, place.left * ratio, place.top * ratio, place.width * ratio, place.height * ratio);
    const scale = ratio * textScale();
    pen.scale(scale, scale);
    pen.textBaseline = 'middle';
    pen.font = fontOf(14, 'bold');
    const [first, ...more] = shownLines(told);
    let y = 18;
    const put = (line: string) => {
        for (const row of rowsOf(pen, line, (place.left * ratio) / scale - 28)) {
            haloed(pen, row, 14, y, shades.text);
            y += lineHeight;
        }
    };
    put(first ?? '');
    pen.font = fontOf(12);
    more.forEach(put);
    drawLegend(pen, all.width / scale - 12, (place.bottom * ratio) / scale + 8);
    return all;
}

// Draws panes below their common title, each with its own title and colors. The elements of `heads` are the panes.
export function snapshotOfPanes(
    picture: HTMLCanvasElement,
    labels: HTMLCanvasElement,
    heads: readonly HTMLElement[],
): HTMLCanvasElement {
    const all = make('canvas');
    const pen = all.getContext('2d')!;
    const corner = labels.getBoundingClientRect();
    const ratio = labels.width / corner.width;
    const scale = ratio * textScale();
    pen.font = fontOf(14, 'bold');
    const rows = shownLines(toldOfPanes).flatMap((line) => rowsOf(pen, line, labels.width / scale - 28));
    const top = Math.round((rows.length * lineHeight + 14) * scale);
    all.width = labels.width;
    all.height = labels.height + top;
    pen.fillStyle = `rgb(${shades.page.slice(0, 3).join(' ')})`;
    pen.fillRect(0, 0, all.width, all.height);
    pen.drawImage(picture, 0, top, labels.width, labels.height);
    pen.drawImage(labels, 0, top);
    const placeOf = (one: Element) => {
        const { left, top: above, width, height } = one.getBoundingClientRect();
        return [
            (left - corner.left) * ratio,
            top + (above - corner.top) * ratio,
            width * ratio,
            height * ratio,
        ] as const;
    };
    for (const head of heads) for (const bar of head.querySelectorAll('canvas')) pen.drawImage(bar, ...placeOf(bar));
    pen.scale(scale, scale);
    pen.textBaseline = 'middle';
    rows.forEach((row, i) => {
        pen.font = fontOf(i === 0 ? 14 : 12, i === 0 ? 'bold' : 'normal');
        haloed(pen, row, 14, 18 + i * lineHeight, shades.text);
    });
    pen.font = fontOf(13, 'bold');
    for (const head of heads) {
        const [left, above] = placeOf(head);
        haloed(pen, head.dataset['title'] ?? '', left / scale + 10, above / scale + 16, shades.text);
    }
    return all;
}
