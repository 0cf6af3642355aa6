// Adds a button for each moment of the domain. Moments that the server computes from several moments or sweeps are in a
// list of their own, because the head of the page has no room for all moments.

import { derivedOf, isMoment, isVelocity, measuredOf, momentFacts, momentsInOrder, titleOf } from '../../wire/moments';
import { App } from '../app';
import { button, element, leaveByEscape, make, press } from '../dom';
import { texts } from '../texts';

interface Choice {
    moment: string;
    isThere: boolean;
}

const choicesOf = ({ domain }: App): Choice[] => momentsInOrder((domain?.moments ?? []).map(({ moment }) => moment));

// Returns true for moments whose buttons are in the list. The dealiased velocity is beside VEL, so that one click
// compares them.
const isListed = (moment: string): boolean =>
    isMoment(moment) && momentFacts(moment).isDerived && moment !== derivedOf(measuredOf(moment));

// Shows the list below its button, but within the page.
function openList(isOpen: boolean): void {
    const [list, opener] = [element('derived-list'), element('derived')];
    list.hidden = !isOpen;
    const most = window.innerWidth - list.offsetWidth - 2 * element('head').offsetLeft;
    list.style.left = `${Math.max(0, Math.min(opener.offsetLeft, most))}px`;
    opener.setAttribute('aria-expanded', String(isOpen));
}

// Names a moment, and tells what the signs of velocities mean.
const told = (moment: string): string =>
    isVelocity(moment) ? `${titleOf(moment)}: ${texts.velocitySigns}` : titleOf(moment);

function momentButton(app: App, { moment, isThere }: Choice): HTMLButtonElement {
    const isDealiased = moment === derivedOf(measuredOf(moment));
    const made = button(`moment-${moment}`, isDealiased ? texts.dealiased : moment, () => {
        openList(false);
        if (isThere) void app.choose(app.state.domain, moment);
        else app.say(texts.noDealiased(titleOf(moment)));
    });
    made.title = isThere ? told(moment) : texts.noDealiased(titleOf(moment));
    made.setAttribute('aria-disabled', String(!isThere));
    if (isListed(moment)) made.append(make('span', {}, titleOf(moment)));
    return made;
}

function putChoices(app: App): void {
    const choices = choicesOf(app);
    const buttonsOf = (inList: boolean) =>
        choices.filter(({ moment }) => isListed(moment) === inList).map((choice) => momentButton(app, choice));
    const listed = buttonsOf(true);
    element('moments').replaceChildren(...buttonsOf(false));
    element('derived-list').replaceChildren(...listed);
    element('derived').hidden = listed.length === 0;
    if (listed.length === 0) openList(false);
    putMoment(app);
}

// Highlights the button of the drawn moment, and marks the button of a chosen moment as busy until the moment is drawn.
function putMoment(app: App): void {
    const { state, shown } = app;
    const drawn = shown?.domain === state.domain ? shown.moment : '';
    const isBusy = (moment: string) => moment === state.moment && moment !== drawn;
    for (const { moment } of choicesOf(app)) {
        press(`moment-${moment}`, moment === drawn);
        element(`moment-${moment}`).setAttribute('aria-busy', String(isBusy(moment)));
    }
    // Name the drawn moment on the button of the list, which is otherwise closed.
    const named = [state.moment, drawn].find(isListed) ?? '';
    element('derived').replaceChildren(named || texts.derived, make('span', { 'aria-hidden': 'true' }, ' ▾'));
    press('derived', named !== '' && named === drawn);
    element('derived').setAttribute('aria-busy', String(named !== '' && isBusy(named)));
}

export function addMoments(app: App): void {
    const list = make('div', { id: 'derived-list', role: 'group', 'aria-label': texts.derivedTold, hidden: '' });
    const open = button('derived', texts.derived, () => openList(list.hidden));
    open.title = texts.derivedTold;
    open.setAttribute('aria-controls', list.id);
    open.setAttribute('aria-expanded', 'false');
    open.hidden = true;
    element('moments').after(make('div', { id: 'derived-choice' }, open, list));
    leaveByEscape(list, open.id, () => openList(false));
    leaveByEscape(open, open.id, () => openList(false));
    document.addEventListener('pointerdown', ({ target }) => {
        if (!(target instanceof Node && list.parentElement?.contains(target))) openList(false);
    });
    app.on('choices', () => putChoices(app));
    app.on('shown', () => putMoment(app));
}
