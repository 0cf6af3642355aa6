// What the start map knows of the server: stations, domains, what each sees now, and where it lies.

import { circleOf, outlineOf } from '../../map/outline';
import { StationPlace, stationPlaces } from '../../map/places';
import { Domain, GridFacts, gridFacts, stations } from '../../wire/api';
import { Outline } from './painter';

const pictured = 'REF';
const mostPicturedStations = 12; // at a time, where no mosaic shows what they see

export interface SeenDomain {
    domain: Domain;
    facts: GridFacts | null; // of its newest grid; null until they are known
    outline: Outline | null; // its border; of a station, a circle
}

export class StartData {
    unpictured = 0; // stations of the view whose echo is not drawn, because there are too many
    stations: StationPlace[] = [];
    mosaics: SeenDomain[] = [];
    private seen = new Map<string, SeenDomain>(); // by domain and time
    private asked = new Set<string>();

    constructor(private changed: () => void) {}

    async load(domains: Domain[]): Promise<void> {
        this.stations = stationPlaces(await stations());
        const known = new Set(this.stations.map(one => one.icao));
        const others = domains.filter(domain => !known.has(domain.domain));
        this.mosaics = await Promise.all(others.map(domain => this.see(domain, false)));
        this.changed();
    }

    private static momentOf(domain: Domain): { moment: string; newest: string } | undefined {
        return domain.moments.find(one => one.moment === pictured) ?? domain.moments[0];
    }

    // What a domain's newest grid is; asked once for each grid.
    private async see(domain: Domain, isStation: boolean): Promise<SeenDomain> {
        const moment = StartData.momentOf(domain);
        const key = `${domain.domain} ${moment?.newest ?? ''}`;
        const known = this.seen.get(key);
        if (known) return known;
        const facts = moment ? await gridFacts(domain.domain, moment.moment, moment.newest).catch(() => null) : null;
        const places = facts && (isStation ? circleOf(facts) : outlineOf(facts));
        const seen: SeenDomain = { domain, facts, outline: places && { domain: domain.domain, places } };
        this.seen.set(key, seen);
        return seen;
    }

    // The same of a station, if it is known; else it is asked for.
    find(domain: Domain): SeenDomain | null {
        const moment = StartData.momentOf(domain);
        const key = `${domain.domain} ${moment?.newest ?? ''}`;
        const known = this.seen.get(key);
        if (known) return known;
        if (moment && !this.asked.has(key)) {
            this.asked.add(key);
            void this.see(domain, true).then(() => this.changed());
        }
        return null;
    }

    // The newest time of what can be pictured.
    static pictureTime(domain: Domain): string | null {
        return domain.moments.find(one => one.moment === pictured)?.newest ?? null;
    }

    // Of stations, the first so many that are not within what a mosaic shows; the oldest first, as they are drawn.
    pictures(domains: Domain[], visible: StationPlace[], isCovered: (station: StationPlace) => boolean, isSeen: (station: StationPlace) => boolean): SeenDomain[] {
        const open = visible.filter(one => one.hasGrids && !isCovered(one));
        this.unpictured = open.slice(mostPicturedStations).filter(isSeen).length;
        const own = open
            .slice(0, mostPicturedStations)
            .sort((a, b) => (b.ageS ?? 0) - (a.ageS ?? 0))
            .map(station => domains.find(domain => domain.domain === station.icao))
            .filter((domain): domain is Domain => domain !== undefined && StartData.pictureTime(domain) !== null)
            .map(domain => this.find(domain))
            .filter((seen): seen is SeenDomain => seen !== null);
        return [...own, ...this.mosaics.filter(({ domain }) => StartData.pictureTime(domain) !== null)];
    }
}
