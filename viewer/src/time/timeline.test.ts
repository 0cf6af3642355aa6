import assert from 'node:assert/strict';
import test from 'node:test';

import { looped, nextOf, stepped } from './player';
import { Timeline } from './timeline';

const at = (time: string): string => `2026-11-28T${time}Z`;
function made(stored: string[], betweenS = 0, follows = false, believed = '23:59:59'): Timeline {
    const timeline = new Timeline(
        follows,
        () => betweenS,
        () => Date.parse(at(believed)),
    );
    timeline.take(stored.map(at));
    return timeline;
}

test('the timeline has times of frames between volumes, and leaves out missing frames', () => {
    const timeline = made(['10:00:30', '10:03:10'], 60);
    assert.deepEqual(timeline.player.times, ['10:00:30', '10:01:00', '10:02:00', '10:03:00', '10:03:10'].map(at));
    assert.deepEqual(
        [at('10:00:30'), at('10:01:00')].map((time) => timeline.isBetween(time)),
        [false, true],
    );
    assert.equal(timeline.leaveOut(at('10:02:00')), true);
    assert.deepEqual(timeline.player.times, ['10:00:30', '10:01:00', '10:03:00', '10:03:10'].map(at));
    timeline.forget();
    timeline.take(['10:00:30', '10:03:10'].map(at));
    assert.equal(timeline.player.times.length, 5, 'another moment may have them');
});

test('a volume is left out only during playback', () => {
    const timeline = made(['10:00:00', '10:05:00', '10:10:00']);
    assert.equal(timeline.leaveOut(at('10:05:00')), false);
    timeline.player = { ...stepped(timeline.player, -1), isPlaying: true };
    assert.equal(timeline.leaveOut(at('10:05:00')), true);
    assert.deepEqual(timeline.stored, ['10:00:00', '10:10:00'].map(at));
});

test('a link finds a volume by the second that the page tells (2026-11-28: the page said "no volume of" that time)', () => {
    const timeline = made(['10:00:00', '10:05:06.742']);
    assert.equal(timeline.find(at('10:05:06')), true);
    assert.equal(timeline.now, at('10:05:06.742'));
    assert.equal(timeline.find(at('10:05:08')), false);
    assert.equal(timeline.now, at('10:05:06.742'));
});

test('the nearest time replaces an evicted time (2026-11-28: the next time did, and was called the nearest)', () => {
    const timeline = made(['10:00:00', '10:00:50', '10:05:00']);
    timeline.find(at('10:00:50'));
    timeline.take(['10:00:00', '10:05:00'].map(at));
    assert.equal(timeline.now, at('10:00:00'));
});

test('a volume with a wrong time in the future is not followed (2026-11-28: it stayed the newest forever)', () => {
    const timeline = made(['10:00:00', '10:05:00', '12:00:00'], 0, true, '10:15:00');
    assert.deepEqual([timeline.now, timeline.newest], [at('10:05:00'), at('10:05:00')]);
    timeline.player = stepped(timeline.player, 1);
    assert.equal(timeline.now, at('12:00:00'), 'who wants it sees it');
    timeline.follow();
    assert.equal(timeline.now, at('10:05:00'));
    timeline.take(['10:00:00', '10:05:00', '10:10:00', '12:00:00'].map(at));
    assert.equal(timeline.now, at('10:10:00'));
    assert.equal(made(['12:00:00'], 0, true, '10:15:00').now, at('12:00:00'), 'it is all that there is');
});

test('a loop of the last volumes moves on with newer volumes', () => {
    const timeline = made(['10:00:00', '10:05:00', '10:10:00', '10:15:00', '23:59:59.5'], 60);
    timeline.playLast(2);
    assert.deepEqual(timeline.player.loop, { from: at('10:10:00'), to: at('10:15:00') });
    timeline.take(['10:05:00', '10:10:00', '10:15:00', '10:20:00'].map(at));
    assert.deepEqual(timeline.player.loop, { from: at('10:15:00'), to: at('10:20:00') });
    timeline.playLast(12);
    assert.equal(timeline.player.loop?.from, at('10:05:00'), 'there are fewer');
    timeline.playLast(0);
    assert.equal(timeline.player.loop, null);
});

test('a loop without times is dropped (2026-11-28: playback stood still, and the page said that it plays)', () => {
    const timeline = made(['10:00:00', '10:05:00', '10:10:00', '10:15:00']);
    timeline.find(at('10:05:00'));
    timeline.player = { ...looped({ ...looped(timeline.player, 'to'), at: 0 }, 'from'), isPlaying: true };
    timeline.take(['10:05:00', '10:10:00', '10:15:00'].map(at));
    assert.equal(timeline.player.loop, null);
    assert.equal(nextOf(timeline.player), 1);
    const half = { ...looped(timeline.player, 'from'), loop: { from: at('10:10:00'), to: at('10:10:00') } };
    timeline.player = half;
    timeline.take(['10:10:00', '10:15:00'].map(at));
    assert.deepEqual(timeline.player.loop, half.loop, 'its other end is not chosen yet');
});
