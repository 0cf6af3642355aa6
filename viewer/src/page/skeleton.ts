// Draws the lines of the map, and rings about the radar, until the first picture of a domain is there. The facts of the
// grid tell its place long before its cells have come.

import { ViewGeometry } from '../camera/geometry';
import { Place, halfWidthsM, planeOf } from '../earth/projection';
import { usualGrid } from '../facts';
import { placeOfFacts } from '../map/outline';
import { shades } from '../renderer/shades';
import { MapLines, ringLines, shownKinds } from '../scene/ground_lines';
import { gridFacts, isRegion } from '../wire/api';
import { titleOf } from '../wire/moments';
import { GridPlace } from '../wire/packed_grid';
import { App } from './app';
import { element, pixelRatio } from './dom';
import { texts } from './texts';

const { levels, betweenLevelsM } = usualGrid;
const heights = { bottomM: betweenLevelsM / 2, topM: (levels + 0.5) * betweenLevelsM };

function strokeLines(pen: CanvasRenderingContext2D, geometry: ViewGeometry, lines: MapLines[]): void {
    const shown = shownKinds(geometry, 1);
    for (const { kind, segments } of lines) {
        if (!shown.has(kind)) continue;
        const [red, green, blue, alpha] = shades[kind] as readonly number[];
        pen.strokeStyle = `rgb(${red} ${green} ${blue} / ${(alpha ?? 255) / 255})`;
        pen.beginPath();
        for (let i = 0; i < segments.length; i += 4) {
            const [from, to] = [i, i + 2].map((at) => geometry.project([segments[at]!, segments[at + 1]!, 0]));
            if (!from || !to) continue;
            pen.moveTo(...from);
            pen.lineTo(...to);
        }
        pen.stroke();
    }
}

// `ask` returns the lines of the map about a grid; null if they cannot be loaded.
export function addSkeleton(
    app: App,
    labels: HTMLCanvasElement,
    pen: CanvasRenderingContext2D,
    ask: (domain: string, place: GridPlace) => Promise<MapLines[] | null>,
): void {
    const draw = (place: GridPlace, lines: MapLines[], site: (Place & { icao: string }) | null) => {
        const [halfXM, halfYM] = halfWidthsM(place);
        const ratio = pixelRatio();
        [labels.width, labels.height] = [labels.clientWidth * ratio, labels.clientHeight * ratio];
        const { camera, exaggeration, units } = app.state;
        const box = { halfXM, halfYM, ...heights };
        const geometry = new ViewGeometry(box, camera, exaggeration, labels.width, labels.height);
        const sites = site ? [{ ...site, altitudeM: 0 }] : [];
        pen.lineWidth = ratio;
        strokeLines(pen, geometry, [...lines, ...ringLines(sites, planeOf(place), halfXM, halfYM, units).lines]);
        document.documentElement.dataset['skeleton'] = app.state.domain;
    };
    app.on('choices', () => {
        const { domain, moment } = app.state;
        const isOver = () => app.shown !== null || app.state.domain !== domain;
        if (app.shown || domain === '') return;
        element('title').textContent = texts.loadingOf(domain, titleOf(moment));
        if (isRegion(domain)) return;
        const show = async () => {
            // The server may have no grid of the wanted time. All grids of a domain are at the same place.
            const facts = await gridFacts(domain, moment, 'latest');
            const place = placeOfFacts(facts);
            const lines = await ask(domain, place);
            const [latitudeDeg, longitudeDeg] = facts.center;
            const isAlone = facts.provenance.stations.length === 1;
            if (lines && !isOver()) draw(place, lines, isAlone ? { icao: domain, latitudeDeg, longitudeDeg } : null);
        };
        // Without an answer, the page waits for the grid without a map.
        show().catch(() => undefined);
    });
}
