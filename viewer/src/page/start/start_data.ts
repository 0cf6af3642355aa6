// Keeps what the start map knows of stations and domains: where they are, and what each sees now.

import { circleOf, outlineOf } from '../../map/outline';
import { StationPlace, stationPlaces } from '../../map/places';
import { geodesic } from '../../earth/projection';
import { isAhead } from '../../time/timeline';
import { Domain, GridFacts, gridFacts, stations } from '../../wire/api';
import { Outline } from './painter';

const pictured = 'REF';
const mostPicturedStations = 12; // at a time, where no mosaic shows what they see
const mostBehindMs = 20 * 60 * 1000; // a mosaic that is further behind a radar within it is not what is seen now
const usualReachM = 230_000; // of a radar's own grid

export interface SeenDomain {
    domain: Domain;
    facts: GridFacts | null; // of its newest grid; null until they are known
    outline: Outline | null; // its border; of a station, a circle
}

// A domain whose newest grid is known.
export interface PicturedDomain extends SeenDomain {
    facts: GridFacts;
    outline: Outline;
}
const isPictured = (seen: SeenDomain | null): seen is PicturedDomain => Boolean(seen?.facts && seen.outline);

export class StartData {
    unpictured = 0; // stations of the view whose echo is not drawn, because there are too many
    lacks = false; // what some domain of the picture is has not come yet
    stations: StationPlace[] = [];
    mosaics: SeenDomain[] = [];
    reachM = usualReachM; // of the station whose grid is the largest
    private seen = new Map<string, SeenDomain>(); // by domain
    private asked = new Set<string>(); // domains with the times of their grids
    private drawn: Domain[] = []; // stations of the last picture

    constructor(private changed: () => void) {}

    // A grid that is made again keeps its time, so asks again for all that is drawn or `chosen`.
    async load(domains: Domain[], chosen: string | null): Promise<void> {
        this.stations = stationPlaces(await stations());
        const known = new Set(this.stations.map((one) => one.icao));
        const others = domains.filter((domain) => !known.has(domain.domain));
        const again = domains.filter(
            ({ domain }) => known.has(domain) && (domain === chosen || this.drawn.some((one) => one.domain === domain)),
        );
        const kept = new Set([...others, ...again].map(({ domain }) => domain));
        for (const domain of this.seen.keys()) if (!kept.has(domain)) this.seen.delete(domain);
        this.asked.clear();
        const [mosaics] = await Promise.all([
            Promise.all(others.map((domain) => this.see(domain, false))),
            ...again.map((domain) => this.see(domain, true)),
        ]);
        this.mosaics = mosaics;
        this.changed();
    }

    private static momentOf(domain: Domain): { moment: string; newest: string } | undefined {
        return domain.moments.find((one) => one.moment === pictured) ?? domain.moments[0];
    }

    // Asks for the facts of a domain's newest grid.
    private async see(domain: Domain, isStation: boolean): Promise<SeenDomain> {
        const moment = StartData.momentOf(domain);
        const facts = moment
            ? await gridFacts(domain.domain, moment.moment, moment.newest).catch(
                  () => this.known(domain)?.facts ?? null,
              )
            : null;
        const places = facts && (isStation ? circleOf(facts) : outlineOf(facts));
        if (places && isStation)
            this.reachM = Math.max(
                this.reachM,
                geodesic({ latitudeDeg: facts.center[0], longitudeDeg: facts.center[1] }, places[0]!).distanceM,
            );
        const seen: SeenDomain = { domain, facts, outline: places && { domain: domain.domain, places } };
        this.seen.set(domain.domain, seen);
        return seen;
    }
    private known(domain: Domain): SeenDomain | undefined {
        const known = this.seen.get(domain.domain);
        return known && StartData.momentOf(known.domain)?.newest === StartData.momentOf(domain)?.newest
            ? known
            : undefined;
    }

    // Returns what is known of a station, and asks for its newest grid if that is not known.
    find(domain: Domain): SeenDomain | null {
        const key = `${domain.domain} ${StartData.momentOf(domain)?.newest ?? ''}`;
        if (!this.known(domain) && !this.asked.has(key)) {
            this.asked.add(key);
            void this.see(domain, true).then(() => this.changed());
        }
        // The map draws the grid before until the newest one is known.
        return this.seen.get(domain.domain) ?? null;
    }

    // Returns the newest time of what can be pictured; null if there is none.
    static pictureTime(domain: Domain): string | null {
        return domain.moments.find((one) => one.moment === pictured)?.newest ?? null;
    }

    // Returns what is drawn, the lowest first: the nearest of the `visible` stations that no mosaic shows, the oldest
    // picture first, and then the mosaics that show what is seen now.
    pictures(
        domains: Domain[],
        visible: StationPlace[],
        isWithin: (outline: Outline, station: StationPlace) => boolean,
    ): PicturedDomain[] {
        // A radar whose clock is wrong makes no mosaic old.
        const newestMs = (outline: Outline) =>
            Math.max(
                ...this.stations
                    .filter((one) => !isAhead(one.ageS ?? 0) && isWithin(outline, one))
                    .map((one) => Date.parse(one.newestGrid ?? '') || 0),
                0,
            );
        const mosaics = this.mosaics
            .filter(isPictured)
            .filter(
                ({ domain, outline }) =>
                    Date.parse(StartData.pictureTime(domain) ?? '') >= newestMs(outline) - mostBehindMs,
            );
        const isShown = (one: StationPlace) =>
            mosaics.some(
                ({ facts, outline }) => facts.provenance.stations.includes(one.icao) && isWithin(outline, one),
            );
        const own = visible.flatMap((station) => {
            const domain = domains.find((one) => one.domain === station.icao);
            return domain && StartData.pictureTime(domain) !== null && !isShown(station)
                ? [{ domain, ageS: station.ageS ?? 0 }]
                : [];
        });
        this.unpictured = Math.max(0, own.length - mostPicturedStations);
        this.drawn = own
            .slice(0, mostPicturedStations)
            .sort((a, b) => b.ageS - a.ageS)
            .map(({ domain }) => domain);
        const stationsSeen = this.drawn.map((domain) => this.find(domain)).filter(isPictured);
        this.lacks = stationsSeen.length < this.drawn.length || this.mosaics.some(({ facts }) => !facts);
        return [...stationsSeen, ...mosaics];
    }
}
