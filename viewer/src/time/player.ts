// Chooses the time to show next. Playback never goes to a time that is not loaded; it waits, and names the time.

export interface PlayerState {
    times: string[]; // rising
    at: number; // index in times; -1: none
    isPlaying: boolean;
    follows: boolean; // a new time is shown as soon as it comes
    loop: Loop | null; // times to which playback keeps; null: all times
}

// Times from `from` to `to`, both included.
export interface Loop {
    from: string;
    to: string;
}

export const stopped: PlayerState = { times: [], at: -1, isPlaying: false, follows: true, loop: null };

// Takes a new list of times. A player that follows the newest goes to the index `newest`. Any other player keeps its
// time, or goes to the nearest time if its time is not in the list.
export function withTimes(player: PlayerState, times: string[], newest = times.length - 1): PlayerState {
    const shown = player.times[player.at];
    if (times.length === 0) return { ...player, times, at: -1, isPlaying: false };
    const { loop, follows } = player;
    const ofLoop = (all: string[]) =>
        loop && loop.from < loop.to ? all.filter((time) => time >= loop.from && time <= loop.to).length : 2;
    // Drop a loop only if it had times before. After a change of the moment, the newest times of the new moment come
    // first, so a loop over older times has none for a while.
    const isOver = ofLoop(times) < 2 && ofLoop(player.times) >= 2;
    return {
        ...player,
        times,
        at: follows || shown === undefined ? newest : nearestTime(times, shown),
        loop: isOver ? null : loop,
    };
}

// Returns the index of the time nearest to `wanted`; -1 without times.
export function nearestTime(times: string[], wanted: string): number {
    const away = (index: number) => Math.abs(Date.parse(times[index]!) - Date.parse(wanted));
    return times.reduce((best, _, i) => (best < 0 || away(i) < away(best) ? i : best), -1);
}

export function at(player: PlayerState, index: number): PlayerState {
    if (player.times.length === 0) return player;
    const bounded = Math.min(player.times.length - 1, Math.max(0, index));
    return { ...player, at: bounded, follows: false };
}

export function stepped(player: PlayerState, by: number): PlayerState {
    return { ...at(player, player.at + by), isPlaying: false };
}

// Returns the indexes of the ends of the loop; without a loop, of all times. The first is -1 if the loop has none.
export function loopEnds({ times, loop }: PlayerState): [number, number] {
    if (!loop) return [0, times.length - 1];
    const last = times.reduce((found, time, i) => (time <= loop.to ? i : found), -1);
    return [times.findIndex((time) => time >= loop.from), last];
}

// Returns the index that is played after `by` steps, where the beginning of the loop follows its end. Outside of the
// loop, returns its beginning. Returns null if the loop has fewer than two times.
export function nextOf(player: PlayerState, by = 1): number | null {
    const { at } = player;
    const [first, last] = loopEnds(player);
    const count = last - first + 1;
    if (first < 0 || count < 2) return null;
    if (at < first || at > last) return first;
    return first + ((at - first + by) % count);
}

// Goes to the next time if playback is on and the time is loaded. If the time is not loaded, `waitsFor` names it.
export function advanced(
    player: PlayerState,
    isLoaded: (time: string) => boolean,
): { player: PlayerState; waitsFor: string | null } {
    const next = player.isPlaying ? nextOf(player) : null;
    if (next === null) return { player, waitsFor: null };
    const time = player.times[next]!;
    if (!isLoaded(time)) return { player, waitsFor: time };
    return { player: { ...player, at: next, follows: false }, waitsFor: null };
}

const lastMs = 1500;

// Returns how long playback shows the current time at least. This is longer for the last time before playback begins
// again, so that the eye takes in how far the storms have come.
export const dwellMs = (player: PlayerState): number => ((nextOf(player) ?? Infinity) < player.at ? lastMs : 0);

// Moves one end of the loop to a time. If the ends would cross, moves both ends to this time. A loop over all times
// becomes null, so that later times are played, too.
export function looped(player: PlayerState, end: 'from' | 'to', index = player.at): PlayerState {
    const now = player.times[index];
    if (now === undefined) return player;
    const loop = { from: player.times[0]!, to: player.times[player.times.length - 1]!, ...player.loop, [end]: now };
    if (loop.from > loop.to) loop.from = loop.to = now;
    const isAll = loop.from <= player.times[0]! && loop.to >= player.times[player.times.length - 1]!;
    return { ...player, loop: isAll ? null : loop };
}

export function followed(player: PlayerState, newest = player.times.length - 1): PlayerState {
    return { ...player, follows: true, isPlaying: false, at: newest };
}
