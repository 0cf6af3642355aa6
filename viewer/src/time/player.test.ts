import assert from 'node:assert/strict';
import test from 'node:test';

import {
    advanced,
    at,
    dwellMs,
    followed,
    loopEnds,
    looped,
    nearestTime,
    nextOf,
    stepped,
    stopped,
    withTimes,
} from './player';

const times = ['a', 'b', 'c', 'd'];

test('a player that follows shows the newest time as soon as it comes', () => {
    const player = withTimes(stopped, times);
    assert.equal(player.at, 3);
    assert.equal(withTimes(player, [...times, 'e']).at, 4);
});

test('a player that does not follow keeps its time when newer times come and older times go', () => {
    const player = at(withTimes(stopped, times), 1);
    assert.equal(player.follows, false);
    const later = withTimes(player, ['b', 'c', 'd', 'e']);
    assert.equal(later.times[later.at], 'b');
    assert.equal(withTimes(later, ['c', 'd']).at, 0, 'b was evicted, so the next time is shown');
});

test('without times, no time is shown', () => assert.equal(withTimes(at(withTimes(stopped, times), 1), []).at, -1));

test('playback waits for a time that is not loaded, and names it', () => {
    const player = { ...at(withTimes(stopped, times), 0), isPlaying: true };
    const waiting = advanced(player, () => false);
    assert.deepEqual([waiting.player.at, waiting.waitsFor], [0, 'b']);
    assert.equal(advanced(player, (time) => time === 'b').player.at, 1);
});

test('playback begins again after the last time, and a step ends playback', () => {
    const player = { ...at(withTimes(stopped, times), 3), isPlaying: true };
    assert.equal(advanced(player, () => true).player.at, 0);
    assert.equal(stepped(player, -1).isPlaying, false);
    assert.equal(stepped(player, 5).at, 3);
    assert.equal(followed(at(player, 0)).at, 3);
});

test('playback stays in its loop, and enters the loop from outside', () => {
    const player = { ...looped(at(withTimes(stopped, times), 1), 'from'), isPlaying: true };
    const closed = { ...looped(at(player, 2), 'to'), isPlaying: true };
    assert.deepEqual(closed.loop, { from: 'b', to: 'c' });
    assert.equal(advanced(closed, () => true).player.at, 1);
    assert.equal(advanced({ ...closed, at: 3 }, () => true).player.at, 1);
    assert.equal(nextOf(closed, 2), 2);
});

test('the last time of a loop stays longer, and any end of a loop can be set', () => {
    const player = looped(withTimes(stopped, times), 'to', 2);
    assert.deepEqual([player.loop, loopEnds(player)], [{ from: 'a', to: 'c' }, [0, 2]]);
    assert.deepEqual(
        [0, 1, 2].map((at) => dwellMs({ ...player, at })),
        [0, 0, 1500],
    );
    assert.equal(dwellMs({ ...player, at: 0, loop: { from: 'a', to: 'a' } }), 0, 'nothing is played');
    assert.equal(looped(player, 'to', 3).loop, null, 'a loop of all times counts as no loop');
});

test('a loop over older times is kept until they have come, and is dropped when they are evicted', () => {
    const player = looped(at(looped(at(withTimes(stopped, times), 0), 'from'), 1), 'to');
    assert.deepEqual(player.loop, { from: 'a', to: 'b' });
    const another = withTimes(withTimes(player, []), times.slice(2));
    assert.deepEqual(another.loop, player.loop);
    assert.equal(withTimes(withTimes(another, times), times.slice(2)).loop, null);
});

test('an end of a loop pushes the other end along, and a loop of one time does not play', () => {
    const player = looped(at(withTimes(stopped, times), 2), 'to');
    const later = looped(at(player, 3), 'from');
    assert.deepEqual(later.loop, { from: 'd', to: 'd' });
    assert.equal(nextOf(later), null);
});

test('a link to a missing time shows the nearest time (2026-11-28: it showed the next time as the nearest)', () => {
    const all = ['2010-09-11T01:10:00Z', '2010-09-11T01:20:00Z', '2010-09-11T01:35:00Z'];
    for (const [wanted, index] of [
        ['01:25', 1],
        ['01:28', 2],
        ['00:00', 0],
        ['09:00', 2],
        ['01:20', 1],
    ] as const)
        assert.equal(nearestTime(all, `2010-09-11T${wanted}:00Z`), index, wanted);
    assert.equal(nearestTime([], all[0]!), -1);
});
