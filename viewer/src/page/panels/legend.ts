// Explains the shades of the ground and of layers, and how much higher the picture is than the earth.

import { sweepMoment, veilsFolded } from '../../scene/layers';
import { shades } from '../../renderer/shades';
import { isMoment, momentFacts } from '../../wire/moments';
import { App } from '../app';
import { element, make } from '../dom';
import { texts } from '../texts';

const css = (rgb: readonly number[]): string => `rgb(${rgb.slice(0, 3).join(' ')})`;

interface Row {
    text: string;
    color: readonly number[] | null;
    lines?: readonly number[]; // the swatch is hatched in this color
}

// Returns the rows for the shades of the shown picture.
function rowsOf({ state, shown, shownTable: table }: App): Row[] {
    const { layers, hasGround, exaggeration, isFlat } = state;
    const rows: Row[] = [];
    if (hasGround && !layers.hasHaze) rows.push({ text: texts.legend.aloft, color: shades.seenAloft });
    if (hasGround && !layers.hasHaze) rows.push({ text: texts.notSeen, color: shades.notSeen, lines: shades.hatch });
    if (layers.hasHaze) rows.push({ text: texts.notSeen, color: shades.haze });
    const showsFolded =
        veilsFolded(layers, shown?.moment ?? '') ||
        layers.hasMaximum ||
        layers.planeM !== null ||
        layers.section !== null ||
        layers.sweepDeg !== null;
    if (showsFolded && table) rows.push({ text: texts.rangeFolded, color: table.range_folded });
    const isOfGrid = layers.hasMaximum || layers.planeM !== null || layers.section !== null;
    const ofSweep = layers.sweepDeg === null ? '' : sweepMoment(layers, shown?.moment ?? '');
    const moments = [isOfGrid ? (shown?.moment ?? '') : '', ofSweep];
    if (table && moments.some((one) => isMoment(one) && momentFacts(one).isDerived))
        rows.push({ text: texts.ambiguous, color: shades.seen, lines: table.range_folded });
    if (layers.hasRotation) texts.layers.turning.forEach((text, i) => rows.push({ text, color: shades.turning[i]! }));
    if (exaggeration !== 1 && !isFlat) rows.push({ text: texts.legend.heights(exaggeration), color: null });
    return rows;
}

function item({ text, color, lines }: Row): HTMLLIElement {
    if (!color) return make('li', {}, text);
    const swatch = make('span', lines ? { class: 'hatched' } : {});
    swatch.style.backgroundColor = css(color);
    if (lines) swatch.style.color = css(lines);
    return make('li', {}, swatch, text);
}

export function addLegend(app: App): void {
    const box = element('legend');
    box.setAttribute('aria-label', texts.legend.name);
    const put = () => {
        const rows = rowsOf(app);
        box.replaceChildren(...rows.map(item));
        box.classList.toggle(
            'exaggerated',
            rows.some(({ color }) => !color),
        );
        box.hidden = !app.shown;
    };
    app.on(['view', 'shown'], put);
}
