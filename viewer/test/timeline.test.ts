import assert from 'node:assert/strict';
import test from 'node:test';

import { stepped } from '../src/time/player';
import { Timeline } from '../src/time/timeline';

const at = (time: string): string => `2026-11-28T${time}Z`;
function made(stored: string[], betweenS = 0, follows = false): Timeline {
    const timeline = new Timeline(follows, () => betweenS);
    timeline.take(stored.map(at));
    return timeline;
}

test('frames between volumes have their places, and those that there are not leave them', () => {
    const timeline = made(['10:00:30', '10:03:10'], 60);
    assert.deepEqual(timeline.player.times, ['10:00:30', '10:01:00', '10:02:00', '10:03:00', '10:03:10'].map(at));
    assert.deepEqual([at('10:00:30'), at('10:01:00')].map(time => timeline.isBetween(time)), [false, true]);
    assert.equal(timeline.leaveOut(at('10:02:00')), true);
    assert.deepEqual(timeline.player.times, ['10:00:30', '10:01:00', '10:03:00', '10:03:10'].map(at));
    timeline.forget();
    timeline.take(['10:00:30', '10:03:10'].map(at));
    assert.equal(timeline.player.times.length, 5, 'another moment may have them');
});

test('a volume is left out of a loop alone', () => {
    const timeline = made(['10:00:00', '10:05:00', '10:10:00']);
    assert.equal(timeline.leaveOut(at('10:05:00')), false);
    timeline.player = { ...stepped(timeline.player, -1), isPlaying: true };
    assert.equal(timeline.leaveOut(at('10:05:00')), true);
    assert.deepEqual(timeline.stored, ['10:00:00', '10:10:00'].map(at));
});
