// Keeps the state of the server: its clock, its silent stations, and whether it answers.

export class ServerState {
    isCutOff = false; // the server does not answer
    isBehind = false; // a request got no answer, so the page must ask for all lists again
    silentSince = new Map<string, number>(); // silent stations, with the time of their last data in ms since 1970
    names = new Map<string, string>(); // name and state of stations, as "Norman, OK"
    private clockAheadMs = 0; // server's clock minus browser's clock

    constructor(private changed: () => void) {}

    // Returns the time by the server's clock. Ages are relative to this, because the browser's clock may be wrong.
    get nowMs(): number {
        return Date.now() + this.clockAheadMs;
    }
    take(answers: boolean, serverMs = NaN): void {
        if (!Number.isNaN(serverMs)) this.clockAheadMs = serverMs - Date.now();
        if (this.isCutOff === !answers) return;
        this.isCutOff = !answers;
        this.changed();
    }
    // Takes news of a station. `silentS` is the seconds since its last data, or null if it sends again.
    takeSilence(station: string, silentS: number | null): void {
        if (silentS === null) this.silentSince.delete(station);
        else this.silentSince.set(station, this.nowMs - 1000 * silentS);
        this.changed();
    }
    // Takes the list of all silent stations, each with the seconds since its last data. A station with undefined
    // instead of seconds keeps its state.
    takeSilences(all: [string, number | undefined][]): void {
        const before = this.silentSince;
        this.silentSince = new Map();
        for (const [station, silentS] of all) {
            const since = silentS === undefined ? before.get(station) : this.nowMs - 1000 * silentS;
            if (since !== undefined) this.silentSince.set(station, since);
        }
        this.changed();
    }
}
