// Has the texts of the page, so that they can be translated. Texts of programs that the page loads later are in
// later_texts.ts.

import { isAhead } from '../time/timeline';
import { CellState, LeftOutEcho } from '../wire/packed_grid';

export function span(seconds: number): string {
    const [minutes, hours] = [seconds / 60, seconds / 3600];
    return minutes < 90 ? `${Math.max(0, Math.round(minutes))} min` : `${Math.round(hours)} h`;
}
// Returns a time in the time zone of the browser, with its date if the date differs from the date in UTC; empty in UTC
// itself.
export function localText(timeMs: number): string {
    const time = new Date(timeMs);
    if (time.getTimezoneOffset() === 0) return '';
    const date = time.getDate() === time.getUTCDate() ? {} : ({ month: 'short', day: 'numeric' } as const);
    return time.toLocaleString('en-US', {
        ...date,
        hour: '2-digit',
        minute: '2-digit',
        hourCycle: 'h23',
        timeZoneName: 'short',
    });
}
export const newsS = 48 * 3600; // for older data, a date says more than an age
// Tells the age of data, or the date of old data. `time` is in ISO form.
export function age(seconds: number, time: string): string {
    if (isAhead(seconds)) return 'in the future';
    return seconds < newsS ? `${span(seconds)} ago` : `${time.slice(0, 16).replace('T', ' ')} UTC`;
}

// Tells how long before or after an instant the volumes of a site were.
function ofVolumes(middlesS: number[]): string {
    const away = (seconds: number) =>
        Math.abs(seconds) < 90 ? `${Math.round(Math.abs(seconds))} s` : `${Math.round(Math.abs(seconds) / 60)} min`;
    const told = middlesS.map((seconds) => (seconds < 0 ? `${away(seconds)} earlier` : `${away(seconds)} later`));
    if (middlesS.length > 1) return `moved from volumes ${told.join(' and ')}`;
    return Math.abs(middlesS[0] ?? 0) < 1 ? 'not moved' : `not moved: observed ${told[0]}`;
}
const mostSitesTold = 3;
function sitesAt(sites: { site: string; middlesS: number[] }[]): string {
    const told = (some: typeof sites) => some.map(({ site, middlesS }) => `${site} ${ofVolumes(middlesS)}`).join('; ');
    if (sites.length <= mostSitesTold) return told(sites);
    const alone = sites.filter(({ middlesS }) => middlesS.length === 1);
    const notMoved = told(alone)
        .replace(/ not moved:?/g, '')
        .replace(/;/g, ',');
    const moved = sites.filter(({ middlesS }) => middlesS.length > 1);
    const farthest = Math.max(...moved.flatMap(({ middlesS }) => middlesS.map(Math.abs)));
    const all =
        moved.length > 0 ? `${moved.length} sites moved from volumes at most ${Math.ceil(farthest / 60)} min away` : '';
    return [all, alone.length > 0 ? `not moved: ${notMoved}` : ''].filter(Boolean).join('; ');
}

// Names the sites that are left out, grouped by the server's reason. A reason begins with "it" or "its".
function leftOut(sites: [string, string][]): string {
    const reasons = [...new Set(sites.map(([, reason]) => reason))].map((reason) => {
        const names = sites.filter((one) => one[1] === reason).map(([site]) => site);
        const told = names.length === 1 ? reason : reason.replace(/^it has /, 'they have ').replace(/^its /, 'their ');
        return names.join(', ') + (told && ` (${told})`);
    });
    return `not in the picture: ${reasons.join(', ')}`;
}

export const greatestOf = (halvings: number): string => `greatest of ${2 ** halvings} x ${2 ** halvings} cells`;

export const texts = {
    title: 'stormcellar',
    loading: 'Loading',
    loadingOf: (domain: string, moment: string) => `${domain}  ${moment}  loading …`,
    noGrids: 'There are no grids yet. The page shows the first one as soon as it is there.',
    notFound: (domain: string, moment: string) =>
        `No ${moment} of ${domain} for this time. Choose another time or radar.`,
    notice: {
        noServer: 'The server does not answer. Trying again …',
        noGraphics: 'The graphics processor was lost: nothing is drawn. If it does not come back, reload the page.',
        reload: 'Reload',
        silent: (station: string, ageS: number) => `${station} is silent: nothing came for ${span(ageS)}.`,
        noDomain: (domain: string) => `No data for ${domain}. Choose another radar.`,
        otherDomain: (domain: string, shown: string) => `No data for ${domain}. This is ${shown}.`,
        otherMoment: (domain: string, moment: string, shown: string) => `${domain} has no ${moment}. This is ${shown}.`,
        noTime: (text: string) => `${text} is not a time. This is the newest volume.`,
        otherTime: (time: string) =>
            `No volume at ${new Date(time).toISOString().slice(0, 19).replace('T', ' ')} UTC. This is the nearest one.`,
    },
    failed: (what: string) => `This did not work: ${what}`,
    dealiased: 'Dealiased',
    derived: 'Derived',
    velocitySigns: 'negative toward the radar, positive away from it',
    velocityEnds: ['away ▲', 'toward ▼'],
    derivedTold: 'Moments computed from the measured ones',
    noDealiased: (moment: string) =>
        `The server has no grids of ${moment} here. The layer "Radar tilt" can show dealiased sweeps.`,
    time: 'Time',
    latest: 'Newest',
    health: {
        old: (name: string, age: string) => `${name}, ${age} old`,
        silent: (time: string) => `Feed silent for ${time}`,
        noServer: 'Server silent',
    },
    live: 'Live',
    settings: 'Settings',
    scan: 'Scan',
    play: 'Play',
    pause: 'Pause',
    earlier: 'Earlier volume',
    later: 'Later volume',
    speed: 'Frames a second',
    aSecond: (rate: number) => `${rate}/s`,
    last: 'Play',
    lastAll: 'all times',
    lastOf: (count: number) => `last ${count}`,
    loopFrom: 'Loop from here',
    loopTo: 'Loop to here',
    loopAll: 'Loop over all',
    between: 'Smooth motion',
    betweenOff: 'off',
    betweenEvery: (seconds: number) => `${seconds < 60 ? `${seconds} s` : `${seconds / 60} min`} (interpolated)`,
    isBetween: 'interpolated, not observed',
    waiting: (time: string) => `Loading ${time.slice(11, 19)} UTC`,
    // Titles of the server's tables by the beginnings of their names.
    tables: { 'smooth-clear-air': 'Clear air', 'smooth-': 'Smooth', 'nws-': 'NWS', 'safe-': 'Color-blind safe' },
    northUp: 'North up',
    resetView: 'Reset view',
    mode: {
        name: 'Map or volume',
        flat: '2D',
        solid: '3D',
        flatTold: 'Map of one tilt (2)',
        solidTold: 'Volume (3)',
        flatPicture: 'Map of the weather. Up and Down change the tilt; ? tells the keys.',
        picture: 'Weather in three dimensions. Arrow keys turn the view; ? tells the keys.',
    },
    notSeen: 'not seen',
    noEcho: 'no echo',
    rangeFolded: 'range folded',
    ambiguous: 'ambiguous',
    ambiguousTold: 'echo whose velocity cannot be dealiased for sure',
    legend: {
        name: 'What the shades mean',
        aloft: 'lowest beam above 3 km',
        heights: (times: number) => `heights\u00a0×\u00a0${times}`,
    },
    // Tells why a volume is not complete; `tilts` is null if the number of its tilts is unknown.
    partial: (isNew: boolean, tilts: { count: number; highestDeg: number } | null) => {
        if (isNew)
            return `Scan in progress${tilts ? `: ${tilts.count} tilts, up to ${tilts.highestDeg.toFixed(1)}°` : ''}`;
        return tilts ? `File ends after ${tilts.count} tilts` : 'File ends early';
    },
    held: (bytes: number, most: number) => `Memory: ${Math.round(bytes / 2 ** 20)} of ${most / 2 ** 20} MiB`,
    surfaceLeftOut: 'not shown: this grid is too large for the surface of another moment',
    detailOfLayers: (halvings: number) => (halvings > 0 ? `layers: ${greatestOf(halvings)}` : ''),
    detail: ({ coarsest, missing, isGone }: { coarsest: number; missing: number; isGone: boolean }) => {
        const cells = coarsest > 0 ? greatestOf(coarsest) : '';
        return missing > 0 ? `coarse: ${cells}; finer cells are ${isGone ? 'no longer there' : 'loading'}` : cells;
    },
    drawn: (ms: number, how: { name: string; dE: number }, fetches: number | null) =>
        `Drawn in ${ms} ms: ${how.name}, color error ${how.dE}${fetches === null ? '' : `, ${fetches.toFixed(1)} texels a pixel`}`,
    layers: {
        title: 'Layers',
        maximumTold: 'column maximum',
        rotationTold: (least: number) => `rotation: azimuthal shear of ${least / 1000}/s or more, 2 km deep or more`,
        turning: ['cyclonic', 'anticyclonic'],
        hidden: 'echo is hidden',
        hiddenOutside: (bottom: string, top: string) => `echo outside the box from ${bottom} to ${top} is hidden`,
        hiddenFolded: 'range-folded air is hidden',
        fainter: (opacity: number) => `opacity × ${opacity}`,
        hiddenBelow: (value: string) => `values below ${value} are hidden`,
        noEchoFrom: (value: string) => `no echo of ${value} or more`,
        planeTold: (height: string) => `plane at ${height}`,
        surfaceFrom: (moment: string, value: string) => `surface of ${moment} from ${value}`,
        surfaceBelow: (moment: string, value: string) => `surface of ${moment} to ${value}`,
        sweepAt: (station: string, cut: string) => `sweep of ${station}: ${cut}`,
        dealiasedSweepAt: (station: string, cut: string) => `sweep of ${station}, dealiased: ${cut}`,
        leftOut: (before: string, echo: LeftOutEcho | null) =>
            echo === null
                ? ''
                : `${before}weather only` +
                  (echo.share >= 0 ? `: ${Math.round(100 * echo.share)} % of the echo left out` : ''),
        sweepComes: (station: string) => `loading the sweep of ${station}`,
        sweepFailed: (station: string) => `the sweep of ${station} could not be loaded`,
        noSweep: (station: string) => `no sweep of ${station} for this time`,
        cut: (elevation: string, time: string, kind: string) => [`${elevation}°`, time, kind].filter(Boolean).join(' '),
        kinds: { surveillance: 'long range', doppler: 'Doppler' },
        beyond: 'beyond the grid',
        otherCells: 'not shown: its grid does not match',
        otherComes: 'loading',
        noOther: (moment: string) => `not shown: no ${moment} for this time`,
        otherFailed: (moment: string) => `not shown: ${moment} could not be loaded`,
        noVolume: (station: string) => `There is no raw volume of ${station} for this time.`,
    },
    start: {
        toMap: 'Map',
        region: 'Merged area',
        ofVolumes,
        sitesAt,
        leftOut,
        halved: (halvings: number) => `each cell is the ${greatestOf(halvings)}`,
        ownVelocities: 'each velocity is toward or away from its own radar',
        age,
    },
} as const;

// Returns the name of a state that has no value.
export function stateText(state: Exclude<CellState, CellState.value>): string {
    switch (state) {
        case CellState.notSeen:
            return texts.notSeen;
        case CellState.noEcho:
            return texts.noEcho;
        case CellState.rangeFolded:
            return texts.rangeFolded;
        case CellState.ambiguous:
            return texts.ambiguous;
    }
}
