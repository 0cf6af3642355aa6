// Which time is shown next. Playback never shows a time that is not loaded: it waits, and says so.

export interface PlayerState {
    times: string[]; // rising
    at: number; // index in times; -1: none
    isPlaying: boolean;
    follows: boolean; // the newest is shown as soon as it is there
}

export const stopped: PlayerState = { times: [], at: -1, isPlaying: false, follows: true };

// Takes a new list. The time that is shown stays; who follows goes to the end.
export function withTimes(player: PlayerState, times: string[]): PlayerState {
    const shown = player.times[player.at];
    if (times.length === 0) return { ...player, times, at: -1, isPlaying: false };
    if (player.follows || shown === undefined) return { ...player, times, at: times.length - 1 };
    const same = times.indexOf(shown);
    if (same >= 0) return { ...player, times, at: same };
    // It was evicted: the next one that is there.
    const later = times.findIndex(time => time > shown);
    return { ...player, times, at: later < 0 ? times.length - 1 : later };
}

export function at(player: PlayerState, index: number): PlayerState {
    if (player.times.length === 0) return player;
    const bounded = Math.min(player.times.length - 1, Math.max(0, index));
    return { ...player, at: bounded, follows: false };
}

export function stepped(player: PlayerState, by: number): PlayerState {
    return { ...at(player, player.at + by), isPlaying: false };
}

// The next time of a loop, or the same if it is not loaded yet.
export function advanced(player: PlayerState, isLoaded: (time: string) => boolean): { player: PlayerState; waitsFor: string | null } {
    if (!player.isPlaying || player.times.length < 2) return { player, waitsFor: null };
    const next = (player.at + 1) % player.times.length;
    const time = player.times[next]!;
    if (!isLoaded(time)) return { player, waitsFor: time };
    return { player: { ...player, at: next, follows: false }, waitsFor: null };
}

export function followed(player: PlayerState): PlayerState {
    return { ...player, follows: true, isPlaying: false, at: player.times.length - 1 };
}
