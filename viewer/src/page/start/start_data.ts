// Keeps the data of the start map: where stations and domains are, and their newest grids.

import { circleOf, outlineOf } from '../../map/outline';
import { StationPlace, stationPlaces } from '../../map/places';
import { geodesic } from '../../earth/projection';
import { isAhead } from '../../time/timeline';
import { Domain, GridFacts, gridFacts, stations } from '../../wire/api';
import { Outline } from './painter';

const pictured = 'REF';
const mostPicturedStations = 12; // most stations that are drawn at a time
const mostBehindMs = 20 * 60 * 1000; // a mosaic is not drawn if a radar in it has a grid newer by more than this
const usualReachM = 230_000; // half of the width of a radar's own grid

export interface SeenDomain {
    domain: Domain;
    facts: GridFacts | null; // facts of its newest grid; null if they have not come
    outline: Outline | null; // border of the grid, or a circle for a station
}

// A domain that can be drawn, because the facts of its newest grid are known.
export interface PicturedDomain extends SeenDomain {
    facts: GridFacts;
    outline: Outline;
}
const isPictured = (seen: SeenDomain | null): seen is PicturedDomain => Boolean(seen?.facts && seen.outline);

export class StartData {
    unpictured = 0; // number of stations in the view whose echo is not drawn, because there are too many
    lacks = false; // facts of some domain in the picture have not come
    stations: StationPlace[] = [];
    mosaics: SeenDomain[] = []; // domains that are not stations
    reachM = usualReachM; // greatest reach of a station's grid
    private seen = new Map<string, SeenDomain>(); // by domain
    private asked = new Set<string>(); // domains and times for which find() has asked
    private drawn: Domain[] = []; // stations of the last picture

    constructor(private changed: () => void) {}

    // Loads the stations and the facts of all other domains. Also asks again for the stations that are drawn or
    // `chosen`, because a grid may have been made again under the same time.
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

    // Asks for the facts of a domain's newest grid. If the request fails, keeps the facts of the same grid if they are
    // known.
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

    // Returns what is known of a station; null if nothing is. Asks once for the facts of the station's newest grid,
    // unless they are known.
    find(domain: Domain): SeenDomain | null {
        const key = `${domain.domain} ${StartData.momentOf(domain)?.newest ?? ''}`;
        if (!this.known(domain) && !this.asked.has(key)) {
            this.asked.add(key);
            void this.see(domain, true).then(() => this.changed());
        }
        // The map draws the previous grid until the facts of the newest grid have come.
        return this.seen.get(domain.domain) ?? null;
    }

    // Returns the newest time of the moment that is drawn; null if the domain does not have the moment.
    static pictureTime(domain: Domain): string | null {
        return domain.moments.find((one) => one.moment === pictured)?.newest ?? null;
    }

    // Returns the domains to draw, in the order of drawing. First come stations that no mosaic shows, the oldest
    // picture first, then the mosaics that are up to date. The stations are the first mostPicturedStations of `visible`
    // that no mosaic shows. `visible` is sorted by distance.
    pictures(
        domains: Domain[],
        visible: StationPlace[],
        isWithin: (outline: Outline, station: StationPlace) => boolean,
    ): PicturedDomain[] {
        // Ignore radars whose clock is ahead, which would make every mosaic look old.
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
