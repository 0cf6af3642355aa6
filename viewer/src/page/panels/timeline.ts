// The foot of the page: every time of the domain, playing, and the live edge.

import { App } from '../app';
import { element, press } from '../dom';
import { texts } from '../texts';

function putTimes(app: App): void {
    const { player } = app;
    const slider = element<HTMLInputElement>('times');
    slider.max = String(Math.max(0, player.times.length - 1));
    slider.value = String(Math.max(0, player.at));
    slider.setAttribute('aria-valuetext', player.times[player.at] ?? '');
    element('play').textContent = player.isPlaying ? texts.pause : texts.play;
    press('follow', player.follows);
}

export function addTimeline(app: App): void {
    element('play').textContent = texts.play;
    element('follow').textContent = texts.latest;
    for (const [id, sign, text, by] of [
        ['earlier', '‹', texts.earlier, -1],
        ['later', '›', texts.later, 1],
    ] as const) {
        element(id).textContent = sign;
        element(id).setAttribute('aria-label', text);
        element(id).addEventListener('click', () => app.step(by));
    }
    element('times').setAttribute('aria-label', texts.time);
    element('times').addEventListener('input', event => app.goTo(Number((event.target as HTMLInputElement).value)));
    element('play').addEventListener('click', () => app.play());
    element('follow').addEventListener('click', () => app.follow());
    app.on('time', () => putTimes(app));
}
