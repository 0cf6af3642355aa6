// Adds handles below the slider of times, which drag the ends of the loop.

import { loopEnds } from '../../time/player';
import { App } from '../app';
import { element, make } from '../dom';
import { panelTexts } from '../later_texts';

const thumb = 16; // width of the slider's thumb, whose middle goes from edge to edge, in pixels

export function addLoopEnds(app: App): void {
    const slider = element<HTMLInputElement>('times');
    const ends = (['from', 'to'] as const).map((end) => {
        const handle = make('div', {
            id: `loop-drag-${end}`,
            class: 'loop-end',
            role: 'slider',
            tabindex: '0',
            'aria-label': panelTexts.loopEnds[end],
            'aria-valuemin': '0',
        });
        handle.title = panelTexts.loopEnds[end];
        const set = (index: number) =>
            app.playback.setLoop(end, Math.min(app.player.times.length - 1, Math.max(0, index)));
        const indexAt = (x: number): number => {
            const { left, width } = slider.getBoundingClientRect();
            return Math.round(((x - left - thumb / 2) / (width - thumb)) * (app.player.times.length - 1));
        };
        handle.addEventListener('pointerdown', (event) => handle.setPointerCapture(event.pointerId));
        handle.addEventListener('pointermove', (event) => {
            if (handle.hasPointerCapture(event.pointerId)) set(indexAt(event.clientX));
        });
        handle.addEventListener('keydown', (event) => {
            const by = { ArrowLeft: -1, ArrowRight: 1, Home: -Infinity, End: Infinity }[event.key];
            if (by === undefined) return;
            set(Number(handle.getAttribute('aria-valuenow')) + by);
            event.preventDefault();
        });
        return handle;
    });
    slider.after(...ends);
    const put = () => {
        const { times } = app.player;
        const indexes = loopEnds(app.player);
        ends.forEach((handle, i) => {
            const index = Math.max(0, indexes[i] ?? 0);
            handle.hidden = times.length < 2;
            handle.setAttribute('aria-valuemax', String(times.length - 1));
            handle.setAttribute('aria-valuenow', String(index));
            handle.setAttribute('aria-valuetext', times[index] ?? '');
        });
    };
    app.on('time', put);
    put();
}
