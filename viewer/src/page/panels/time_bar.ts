// Fills the foot of the page: a slider over the times of the domain, and buttons to play and to follow the newest. Adds
// speed and loops to the settings.

import { App } from '../app';
import { button, element, labeled, make } from '../dom';
import { Keys } from '../keys';
import { texts } from '../texts';

const speeds = [1, 2, 4, 8, 15, 30];
const betweens = [0, 30, 60, 120];

function putLoop(app: App, slider: HTMLInputElement): void {
    const { times, loop } = app.player;
    const shareOf = (wanted: string) => {
        const index = times.findIndex((time) => time >= wanted);
        return (100 * (index < 0 ? times.length - 1 : index)) / Math.max(1, times.length - 1);
    };
    slider.style.setProperty('--loop-from', loop ? `${shareOf(loop.from)}%` : '0%');
    slider.style.setProperty('--loop-to', loop ? `${shareOf(loop.to)}%` : '100%');
    element('loop-all').hidden = loop === null;
}

function putTimes(app: App): void {
    const { player } = app;
    const slider = element<HTMLInputElement>('times');
    slider.max = String(Math.max(0, player.times.length - 1));
    slider.value = String(Math.max(0, player.at));
    slider.setAttribute('aria-valuetext', player.times[player.at] ?? '');
    putLoop(app, slider);
    element('play').textContent = player.isPlaying ? texts.pause : texts.play;
    element<HTMLSelectElement>('between').value = String(app.state.betweenS);
}

function select(
    id: string,
    name: string,
    options: [number, string][],
    chosen: number,
    take: (value: number) => void,
): HTMLLabelElement {
    const made = make('select', { id });
    for (const [value, shown] of options) made.add(new Option(shown, String(value), false, value === chosen));
    made.addEventListener('change', () => take(Number(made.value)));
    return labeled(name, made);
}

function addPlaying(app: App): void {
    const rates = speeds.map((rate): [number, string] => [rate, String(rate)]);
    const { betweenS } = app.state;
    const steps = [...new Set([...betweens, betweenS])].sort((a, b) => a - b);
    const everys = steps.map((seconds): [number, string] => [
        seconds,
        seconds === 0 ? texts.betweenOff : texts.betweenEvery(seconds),
    ]);
    element('playing').append(
        select('speed', texts.speed, rates, app.playback.framesASecond, (rate) => (app.playback.framesASecond = rate)),
        select('between', texts.between, everys, betweenS, (seconds) => void app.playback.setBetween(seconds)),
    );
    element('loops').append(
        button('loop-from', texts.loopFrom, () => app.playback.setLoop('from')),
        button('loop-to', texts.loopTo, () => app.playback.setLoop('to')),
        button('loop-all', texts.loopAll, () => app.playback.setLoop(null)),
    );
}

export function addTimeline(app: App, keys: Keys): void {
    element('play').textContent = texts.play;
    for (const [id, sign, text, by] of [
        ['earlier', '‹', texts.earlier, -1],
        ['later', '›', texts.later, 1],
    ] as const) {
        element(id).textContent = sign;
        element(id).setAttribute('aria-label', text);
        element(id).addEventListener('click', () => app.playback.step(by));
    }
    element('times').setAttribute('aria-label', texts.time);
    element('times').addEventListener('input', (event) =>
        app.playback.goTo(Number((event.target as HTMLInputElement).value)),
    );
    element('play').addEventListener('click', () => app.playback.play());
    element('follow').addEventListener('click', () => app.playback.follow());
    addPlaying(app);
    keys.add('<', () => app.playback.setLoop('from'));
    keys.add('>', () => app.playback.setLoop('to'));
    app.on('time', () => putTimes(app));
}
