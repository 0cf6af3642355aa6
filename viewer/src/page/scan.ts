// Tells the cuts of a volume scan, and how far the scan is.

import { SweepRow, VolumeRow } from '../wire/api';
import { isMoment, momentFacts } from '../wire/moments';
import { isChosen, kindOf } from '../fields/sweep_choice';
import { panelTexts } from './later_texts';
import { texts } from './texts';

const risingS = 600; // a scan without a new cut for this time has ended

// Returns the name of a cut's waveform, and what it means. Without a known waveform, the name is the purpose of a half
// of a split cut.
export function waveformOf(row: SweepRow, rows: SweepRow[]): readonly [string, string] {
    const known = Object.entries(panelTexts.scan.waveforms).find(([name]) => name === row.waveform);
    if (known) return known[1];
    const kind = kindOf(row, rows);
    return [kind === '' ? '' : texts.layers.kinds[kind], ''];
}

// Returns the measured moments of a cut, without those that the server computes.
export function measuredOf({ moments }: SweepRow): string[] {
    return moments.map(({ moment }) => moment).filter((one) => !isMoment(one) || !momentFacts(one).isDerived);
}

// Returns the cells of a cut's row: angle, waveform, time, Nyquist velocity and measured moments. `speedText` adds a
// unit to m/s.
export function cutCells(row: SweepRow, rows: SweepRow[], speedText: (mps: number) => string): string[] {
    return [
        `${row.elevation_deg.toFixed(1)}°`,
        waveformOf(row, rows)[0],
        row.start?.slice(11, 19) ?? '',
        row.nyquist_mps === undefined ? '' : speedText(row.nyquist_mps),
        measuredOf(row).join(' '),
    ];
}

// Returns the least and the greatest Nyquist velocity of the cuts from which a moment is taken; null if none is known.
export function nyquistOf(rows: SweepRow[], moment: string): [number, number] | null {
    const having = rows.filter((row) => row.moments.some((one) => one.moment === moment));
    const chosen = having.filter((row) => isChosen(row, moment));
    const known = (chosen.length > 0 && rows.length > 1 ? chosen : having).flatMap(({ nyquist_mps: mps }) =>
        mps ? [mps] : [],
    );
    return known.length === 0 ? null : [Math.min(...known), Math.max(...known)];
}

export interface Progress {
    text: string;
    share: number | null; // part of the scan that is done; null if the number of its cuts is unknown
}

// Returns how far a scan is. `volumes` are the scan and the scan before it, oldest first. A scan usually has as many
// cuts as the last complete scan of the same pattern.
export function progressOf(rows: SweepRow[], volumes: VolumeRow[], nowMs: number): Progress {
    const words = panelTexts.scan;
    const own = volumes[volumes.length - 1];
    const pattern = own?.vcp ? words.pattern(own.vcp) : '';
    const highest = Math.max(0, ...rows.map((row) => row.elevation_deg)).toFixed(1);
    const told = (text: string, share: number | null) => ({ text: [pattern, text].filter(Boolean).join(' · '), share });
    if (own?.complete !== false) return told(words.complete(rows.length), 1);
    const last = Math.max(...rows.map((row) => Date.parse(row.end ?? row.start ?? '') || 0));
    if (nowMs - last > 1000 * risingS) return told(words.ended(rows.length, highest), null);
    const before = volumes.find((one) => one !== own && one.vcp === own.vcp && one.complete);
    return told(
        words.inProgress(rows.length, before?.sweeps ?? null, highest),
        before ? Math.min(1, rows.length / before.sweeps) : null,
    );
}
