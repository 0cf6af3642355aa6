// Shows at the corner of each pane its moments, what it draws, and its scale of colors. Marks the pointer in all panes.

import { derivedOf, isMoment, measuredOf, momentFacts, momentsInOrder, titleOf } from '../../wire/moments';
import { allPanes } from '../../scene/panes';
import { shownUnit } from '../../tables/units';
import { App } from '../app';
import { ColorBar, endsOf } from '../color_bar';
import { make, pixelRatio } from '../dom';
import { Drawing } from '../drawing';
import { cutText } from '../layer_maker';
import { panelTexts } from '../later_texts';
import { Pane } from '../pane';
import { texts } from '../texts';

const words = panelTexts.panes;

// Returns true for moments that have no button, because panes have no room for all.
const isListed = (moment: string): boolean =>
    isMoment(moment) && momentFacts(moment).isDerived && moment !== derivedOf(measuredOf(moment));

const wide = '(min-width: 1001px)'; // panes have room for buttons of moments; as in the style sheet

const roomPixels = [120, 30] as const; // beside and below a mark for its text

// The elements of a pane.
interface Head {
    box: HTMLElement;
    moments: HTMLElement;
    list: HTMLSelectElement;
    told: HTMLElement;
    bar: ColorBar;
    mark: HTMLElement;
}

export class PaneHeads {
    private all = make('div', { id: 'panes' });
    private heads: Head[] = [];

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(): void {
        this.drawing.labels.after(this.all);
        this.app.on(['view', 'shown', 'choices', 'units'], () => this.put());
        this.drawing.share.layerCame.push(() => this.put());
        this.drawing.pictureChanged.push(() => this.put());
        this.put();
    }

    private makeHead(index: number): Head {
        const moments = make('div', { class: 'moments', role: 'group', 'aria-label': words.moment(index + 1) });
        const list = make('select', { 'aria-label': words.moment(index + 1) });
        list.addEventListener('change', () => list.value && this.choose(index, list.value));
        const told = make('span', { class: 'pane-told' });
        const canvas = make('canvas', { class: 'pane-bar', 'aria-hidden': 'true' });
        const mark = make('div', { class: 'pane-mark', 'aria-hidden': 'true', hidden: '' }, make('span'));
        const head = make('div', { class: 'pane-head' }, moments, list, told);
        const box = make('div', { class: 'pane', role: 'group' }, head, canvas, mark);
        this.all.append(box);
        return { box, moments, list, told, bar: new ColorBar(canvas), mark };
    }

    // Makes a pane the active one, and shows another moment in it.
    private choose(index: number, moment: string): void {
        const { app, drawing } = this;
        const { state, pane } = { state: app.state, pane: drawing.pane };
        if (index === pane.index) return void app.choose(state.domain, moment);
        const all = allPanes(state).map((one, i) => (i === index ? { ...one, moment, least: null, colors: '' } : one));
        const shown = drawing.panes[index]?.shown;
        pane.keep(app.shown);
        if (shown) app.shown = shown;
        app.usePanes(all, index);
    }

    private put(): void {
        const { panes, places, picture } = this.drawing;
        const isOne = panes.length === 1;
        this.all.hidden = isOne;
        for (const { box } of this.heads.splice(isOne ? 0 : panes.length)) box.remove();
        if (isOne) return;
        const { offsetLeft, offsetTop } = picture;
        panes.forEach((pane, i) => {
            const head = (this.heads[i] ??= this.makeHead(i));
            const { style } = head.box;
            const ratio = pixelRatio();
            const { left, top, width, height } = places[i]!;
            style.left = `${offsetLeft + left / ratio}px`;
            style.top = `${offsetTop + top / ratio}px`;
            style.width = `${width / ratio}px`;
            style.height = `${height / ratio}px`;
            this.putHead(pane, head);
        });
    }

    private putHead(pane: Pane, { box, moments, list, told, bar }: Head): void {
        const { state, shown, shownTable: table, isActive, index } = pane;
        box.classList.toggle('active', isActive);
        box.setAttribute('aria-label', words.pane(index + 1, titleOf(state.moment)));
        box.setAttribute('aria-current', String(isActive));
        const all = momentsInOrder((this.app.domain?.moments ?? []).map(({ moment }) => moment))
            .filter(({ isThere }) => isThere)
            .map(({ moment }) => moment);
        const isWide = window.matchMedia(wide).matches;
        const key = [...all, state.moment, shown?.moment, isWide].join(' ');
        if (moments.dataset['of'] !== key) {
            moments.dataset['of'] = key;
            const hasFocus = moments.contains(document.activeElement);
            moments.replaceChildren(...all.filter((one) => !isListed(one)).map((one) => this.momentButton(pane, one)));
            if (hasFocus) moments.querySelector<HTMLElement>('[aria-pressed="true"]')?.focus();
            putList(list, all, state.moment, isWide);
        }
        const what = shown ? toldOf(pane) : pane.isAbsent ? words.nothing(titleOf(state.moment)) : texts.loading;
        told.textContent = what;
        box.dataset['title'] = [shown ? titleOf(shown.moment) : '', what].filter(Boolean).join('  ');
        if (table) bar.show(table, shownUnit(table.unit, state.units), state.least, endsOf(shown?.moment ?? ''));
    }

    private momentButton({ state, shown, index }: Pane, moment: string): HTMLButtonElement {
        const isDealiased = moment === derivedOf(measuredOf(moment));
        const made = make('button', { title: titleOf(moment) }, isDealiased ? texts.dealiased : moment);
        made.setAttribute('aria-pressed', String(moment === shown?.moment));
        made.setAttribute('aria-busy', String(moment === state.moment && moment !== shown?.moment));
        made.addEventListener('click', () => this.choose(index, moment));
        return made;
    }

    // -- the pointer

    // Marks a pixel of the panes in all panes but one, with a text for each.
    point([x, y]: [number, number], except: number, textOf: (pane: Pane) => string): void {
        this.heads.forEach(({ mark }, i) => {
            const pane = this.drawing.panes[i];
            mark.hidden = i === except || !pane;
            mark.style.transform = `translate(${x / pixelRatio()}px, ${y / pixelRatio()}px)`;
            const { width, height } = this.drawing.places[i] ?? { width: 0, height: 0 };
            mark.classList.toggle('above', y > height - roomPixels[1] * pixelRatio());
            mark.classList.toggle('left', x > width - roomPixels[0] * pixelRatio());
            mark.querySelector('span')!.textContent = pane && i !== except ? textOf(pane) : '';
        });
    }
    hidePointer(): void {
        for (const { mark } of this.heads) mark.hidden = true;
    }
}

// Fills the list with moments. Beside buttons, the list has only moments without a button.
function putList(list: HTMLSelectElement, all: readonly string[], chosen: string, isWide: boolean): void {
    const listed = all.filter((moment) => !isWide || isListed(moment));
    const options = listed.map(
        (moment) => new Option(`${moment} ${titleOf(moment)}`, moment, false, moment === chosen),
    );
    if (!listed.includes(chosen)) options.unshift(new Option(isWide ? words.derived : chosen, '', false, true));
    list.replaceChildren(...options);
    list.hidden = listed.length === 0;
}

// Tells what a pane shows besides its moment.
function toldOf({ layers, state }: Pane): string {
    const [cut, rows] = [layers.shownCut(), layers.sweepRows()];
    return state.isFlat && cut && rows ? cutText(cut, rows) : layers.told().join(' · ');
}
