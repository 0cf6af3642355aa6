// Shows still pictures that the server draws, because the browser has no WebGL 2. The user chooses radar, moment, kind
// and time.

import { Domain, domains, stillPicture, times } from '../../wire/api';
import { titleOf } from '../../wire/moments';
import { Layers, flatLayers, productOf, usualLayers } from '../../scene/layers';
import { stateOf } from '../../scene/view_state';
import { button, element, labeledButton, make, pixelRatio, press, putOptions } from '../dom';
import { panelTexts } from '../later_texts';
import { texts } from '../texts';

const words = panelTexts.stills;
const againAfterMs = 30_000;
const mostTimes = 500;
const mostSidePx = 2048;
const [leastWidthPx, leastHeightPx] = [400, 300];
type Kind = keyof typeof words.kinds;
// The layers of each kind of picture, as the page would draw them.
const layersOf: Record<Kind, Layers> = {
    volume: usualLayers,
    tilt: flatLayers(usualLayers),
    maximum: { ...usualLayers, hasVolume: false, hasMaximum: true },
};

class StillPage {
    private picture = make('img', { id: 'still', alt: '' });
    private domains: Domain[] = [];
    private domain = '';
    private moment = '';
    private time = 'latest';
    private kind: Kind = 'volume';
    private times: string[] = [];
    private shown = ''; // address of the picture that is shown or comes
    private turn = 0;

    async begin(): Promise<void> {
        this.build();
        const { domain, moment, time, isFlat } = stateOf(location.hash);
        Object.assign(this, { domain, moment, time, kind: isFlat ? 'tilt' : 'volume' });
        window.addEventListener('resize', () => this.draw());
        window.addEventListener('hashchange', () => {
            const next = stateOf(location.hash);
            void this.choose(next.domain, next.moment, next.time);
        });
        window.setInterval(
            () => this.time === 'latest' && void this.choose(this.domain, this.moment, 'latest'),
            againAfterMs,
        );
        await this.choose(domain, moment, time);
    }

    private build(): void {
        document.body.classList.add('stills');
        document.title = texts.title;
        element('picture').replaceWith(this.picture);
        const kinds = make('select', { id: 'still-kind', 'aria-label': words.kind });
        putOptions(kinds, Object.keys(words.kinds), this.kind, (name) => words.kinds[name as Kind]);
        kinds.addEventListener('change', () => {
            this.kind = kinds.value as Kind;
            this.draw();
        });
        element('open').replaceWith(kinds);
        for (const [id, sign, name, by] of [
            ['earlier', '‹', texts.earlier, -1],
            ['later', '›', texts.later, 1],
        ] as const)
            element(id).replaceWith(labeledButton(id, sign, name, () => this.step(by)));
        element('follow').replaceWith(
            button('follow', texts.latest, () => void this.choose(this.domain, this.moment, 'latest')),
        );
        element('domain').addEventListener('change', ({ target }) => {
            void this.choose((target as HTMLSelectElement).value, this.moment, 'latest');
        });
        const head = element('head');
        new ResizeObserver(() =>
            document.documentElement.style.setProperty('--head', `${head.offsetHeight}px`),
        ).observe(head);
        element('notice').textContent = words.without;
        this.picture.addEventListener('load', () => this.say(''));
        document.addEventListener('keydown', ({ key, target }) => {
            if (target instanceof HTMLSelectElement) return;
            const by = { ArrowLeft: -1, ',': -1, ArrowRight: 1, '.': 1 }[key];
            if (by !== undefined) this.step(by as 1 | -1);
        });
    }
    private say(text: string): void {
        element('state').textContent = text;
        document.documentElement.dataset['state'] = text;
    }

    // Shows a moment of a domain at a time. If the server lacks one of the three, shows another that it has.
    private async choose(domain: string, moment: string, time: string): Promise<void> {
        const turn = ++this.turn;
        try {
            this.domains = (await domains()).filter((one) => one.part_of === null && one.moments.length > 0);
            const own = this.domains.find((one) => one.domain === domain) ?? this.domains[0];
            if (turn !== this.turn) return;
            if (!own) return this.say(texts.noGrids);
            const names = own.moments.map((one) => one.moment);
            const chosen = names.includes(moment) ? moment : (names[0] ?? '');
            const found = (await times(own.domain, chosen, mostTimes)).times;
            if (turn !== this.turn) return;
            Object.assign(this, { domain: own.domain, moment: chosen, time, times: found });
            const missed = domain !== '' && own.domain !== domain ? texts.notice.otherDomain(domain, own.domain) : '';
            element('notice').textContent = [words.without, missed].filter(Boolean).join(' ');
            this.putChoices(names);
            this.draw();
        } catch (error) {
            if (turn === this.turn) this.fail(error);
        }
    }
    private fail(error: unknown): void {
        const isSilent = error instanceof TypeError;
        this.say(
            isSilent ? texts.notice.noServer : texts.failed(error instanceof Error ? error.message : String(error)),
        );
    }

    private putChoices(names: string[]): void {
        const all = this.domains.map((one) => one.domain);
        putOptions(element<HTMLSelectElement>('domain'), all, this.domain);
        element('moments').replaceChildren(
            ...names.map((name) => {
                const made = button(`moment-${name}`, name, () => void this.choose(this.domain, name, this.time));
                made.title = titleOf(name);
                made.setAttribute('aria-pressed', String(name === this.moment));
                return made;
            }),
        );
    }
    // Returns the index of the shown time, which is the newest one at or before the wanted time.
    private get at(): number {
        if (this.time === 'latest') return this.times.length - 1;
        const later = this.times.findIndex((one) => Date.parse(one) > Date.parse(this.time));
        return Math.max(0, later < 0 ? this.times.length - 1 : later - 1);
    }
    private step(by: 1 | -1): void {
        const next = this.times[this.at + by];
        if (next === undefined) return;
        this.time = next;
        this.draw();
    }

    private draw(): void {
        const time = this.times[this.at];
        if (time === undefined) return this.say(texts.notFound(this.domain, this.moment));
        const query = new URLSearchParams(location.hash.slice(1));
        for (const [name, value] of Object.entries({ domain: this.domain, moment: this.moment, time: this.time }))
            query.set(name, value);
        history.replaceState(null, '', `#${query}`);
        press('follow', this.time === 'latest');
        for (const [id, by] of [
            ['earlier', -1],
            ['later', 1],
        ] as const)
            element<HTMLButtonElement>(id).disabled = this.times[this.at + by] === undefined;
        const told = `${time.slice(0, 19).replace('T', ' ')} UTC`;
        element('title').textContent = [this.domain, told, titleOf(this.moment)].join('  ');
        document.title = `${this.domain} ${this.moment} ${told} · ${texts.title}`;
        const [clientWidth, clientHeight] = [this.picture.clientWidth || 1, this.picture.clientHeight || 1];
        // The server puts labels into larger pictures only.
        const scale = Math.max(pixelRatio(), leastWidthPx / clientWidth, leastHeightPx / clientHeight);
        const [width, height] = [clientWidth, clientHeight].map((side) =>
            Math.min(mostSidePx, Math.ceil(side * scale)),
        ) as [number, number];
        void this.load(
            stillPicture(this.domain, this.moment, time, productOf(layersOf[this.kind]) ?? [], width, height),
        );
    }
    private async load({ path, fetch }: ReturnType<typeof stillPicture>): Promise<void> {
        if (this.shown === path) return;
        this.shown = path;
        this.say(texts.loading);
        try {
            const picture = URL.createObjectURL(await fetch());
            if (this.shown !== path) return;
            URL.revokeObjectURL(this.picture.src);
            this.picture.src = picture;
            this.picture.alt = `${element('title').textContent}: ${words.kinds[this.kind]}`;
            document.documentElement.dataset['drawn'] = `${this.domain}/${this.moment}/${this.times[this.at]}`;
        } catch (error) {
            if (this.shown !== path) return;
            this.shown = '';
            this.fail(error);
        }
    }
}

export function showStills(): void {
    void new StillPage().begin();
}
