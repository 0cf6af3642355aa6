// Fills the foot of the page: a slider over the times of the domain, buttons to play and to follow the newest, and the
// speed. Adds loops to the settings.

import { loopEnds } from '../../time/player';
import { App } from '../app';
import { button, element, labeled, make } from '../dom';
import { Keys } from '../keys';
import { texts } from '../texts';

const speeds = [1, 2, 4, 8, 15, 30];
const betweens = [0, 30, 60, 120];
const lasts = [0, 6, 12, 24, 48];

function putLoop({ player }: App): void {
    const { style } = element('track');
    loopEnds(player).forEach((index, i) =>
        style.setProperty(
            ['--loop-from', '--loop-to'][i] ?? '',
            String(Math.max(0, index) / Math.max(1, player.times.length - 1)),
        ),
    );
    element('loop-all').hidden = player.loop === null;
}

function putTimes(app: App): void {
    const { player } = app;
    const slider = element<HTMLInputElement>('times');
    slider.max = String(Math.max(0, player.times.length - 1));
    slider.value = String(Math.max(0, player.at));
    slider.setAttribute('aria-valuetext', player.times[player.at] ?? '');
    putLoop(app);
    element('play').textContent = player.isPlaying ? texts.pause : texts.play;
    element<HTMLSelectElement>('between').value = String(app.state.betweenS);
    element<HTMLSelectElement>('loop-last').value = String(app.timeline.last);
}

function select(
    id: string,
    name: string,
    options: [number, string][],
    chosen: number,
    take: (value: number) => void,
): HTMLSelectElement {
    const made = make('select', { id, 'aria-label': name });
    for (const [value, shown] of options) made.add(new Option(shown, String(value), false, value === chosen));
    made.addEventListener('change', () => take(Number(made.value)));
    return made;
}

function addPlaying(app: App): void {
    const { betweenS } = app.state;
    const steps = [...new Set([...betweens, betweenS])].sort((a, b) => a - b);
    const everys = steps.map((seconds): [number, string] => [
        seconds,
        seconds === 0 ? texts.betweenOff : texts.betweenEvery(seconds),
    ]);
    const rates = speeds.map((rate): [number, string] => [rate, texts.aSecond(rate)]);
    const { playback } = app;
    const counts = lasts.map((count): [number, string] => [count, count === 0 ? texts.lastAll : texts.lastOf(count)]);
    element('play').after(
        select('speed', texts.speed, rates, playback.framesASecond, (rate) => (playback.framesASecond = rate)),
    );
    element('playing').append(
        labeled(
            texts.last,
            select('loop-last', texts.last, counts, 0, (count) => playback.playLast(count)),
        ),
        labeled(
            texts.between,
            select('between', texts.between, everys, betweenS, (seconds) => void playback.setBetween(seconds)),
        ),
    );
    element('loops').append(
        button('loop-from', texts.loopFrom, () => app.playback.setLoop('from')),
        button('loop-to', texts.loopTo, () => app.playback.setLoop('to')),
        button('loop-all', texts.loopAll, () => app.playback.playLast(0)),
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
