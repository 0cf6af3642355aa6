// Shows the list beside the start map: domains, and the stations that a search finds.

import { Found, StationPlace } from '../../map/places';
import { nameOfKnown } from '../../wire/api';
import { element, make } from '../dom';
import { mapTexts } from '../later_texts';
import { texts } from '../texts';

export interface ListedPlace {
    domain: string;
    name: string;
    note: string;
    isThere: boolean; // the domain has grids
}

// Tells the age of the newest data of a station; null if it has none.
export function agedText({ ageS, newest }: StationPlace): string | null {
    return ageS === null || newest === null ? null : texts.start.age(ageS, newest);
}

export function listedStation({ station, near, distanceM }: Found): ListedPlace {
    const age = agedText(station) ?? mapTexts.nothing;
    return {
        domain: station.icao,
        name: station.name,
        note: near === null ? age : `${mapTexts.from(Math.round(distanceM / 1000), near)} · ${age}`,
        isThere: station.hasGrids,
    };
}

export interface ListActions {
    point(domain: string | null): void;
    open(domain: string): void;
    search(text: string): void;
}

export class PlaceList {
    private readonly list = element<HTMLUListElement>('found');
    readonly field = element<HTMLInputElement>('search');

    constructor(private actions: ListActions) {
        this.field.placeholder = mapTexts.search;
        this.field.setAttribute('aria-label', mapTexts.search);
        this.field.addEventListener('input', () => actions.search(this.field.value));
        element('places').addEventListener('keydown', (event) => this.press(event));
    }

    put(places: ListedPlace[]): void {
        const focused =
            document.activeElement instanceof HTMLElement ? document.activeElement.dataset['domain'] : undefined;
        this.list.replaceChildren(...places.map((place) => this.row(place)));
        if (places.length === 0) void this.tellNone(this.field.value.trim().toUpperCase());
        this.buttons.find((one) => one.dataset['domain'] === focused)?.focus();
    }

    // Tells that nothing was found, and whether the word is the name of a radar without data.
    private async tellNone(word: string): Promise<void> {
        const line = make('li', {}, mapTexts.noneFound);
        this.list.append(line);
        if (!/^[A-Z][A-Z0-9]{3}$/.test(word)) return;
        const name = await nameOfKnown(word).catch(() => null);
        if (name !== null) line.textContent = mapTexts.noDataOfKnown(word, name);
    }

    mark(domain: string | null): void {
        for (const one of this.buttons) one.classList.toggle('marked', one.dataset['domain'] === domain);
    }

    private row(place: ListedPlace): HTMLLIElement {
        const button = make(
            'button',
            { 'data-domain': place.domain },
            make('b', {}, place.domain),
            make('span', {}, place.name),
            make('small', {}, place.note),
        );
        button.disabled = !place.isThere;
        button.addEventListener('click', () => this.actions.open(place.domain));
        button.addEventListener('focus', () => this.actions.point(place.domain));
        button.addEventListener('pointerenter', () => this.actions.point(place.domain));
        return make('li', {}, button);
    }

    private get buttons(): HTMLButtonElement[] {
        return [...this.list.querySelectorAll('button')];
    }

    // Handles keys: arrows go through the list, and Enter in the field opens the first place.
    private press(event: KeyboardEvent): void {
        const usable = this.buttons.filter((one) => !one.disabled);
        const at = usable.indexOf(document.activeElement as HTMLButtonElement);
        if (event.key === 'ArrowDown') (usable[at + 1] ?? usable[at])?.focus();
        else if (event.key === 'ArrowUp') (at > 0 ? usable[at - 1]! : this.field).focus();
        else if (event.key === 'Enter' && at < 0 && usable[0]) this.actions.open(usable[0].dataset['domain']!);
        else return;
        event.preventDefault();
    }
}
