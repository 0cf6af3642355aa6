// Keeps the state of the server: does it answer, its clock, and its silent stations.

export class ServerState {
    isCutOff = false; // it does not answer
    isBehind = false; // a request got no answer, so the page must ask for all again
    silentSince = new Map<string, number>(); // ms since 1970, of stations of which the server hears nothing
    private clockAheadMs = 0; // before that of the browser

    constructor(private changed: () => void) {}

    // Ages are told by the clock of the server: that of the browser may be wrong.
    get nowMs(): number {
        return Date.now() + this.clockAheadMs;
    }
    take(answers: boolean, serverMs = NaN): void {
        if (!Number.isNaN(serverMs)) this.clockAheadMs = serverMs - Date.now();
        if (this.isCutOff === !answers) return;
        this.isCutOff = !answers;
        this.changed();
    }
    // `silentS`: for how long; null: it spoke.
    takeSilence(station: string, silentS: number | null): void {
        if (silentS === null) this.silentSince.delete(station);
        else this.silentSince.set(station, this.nowMs - 1000 * silentS);
        this.changed();
    }
    // Takes all stations that are silent, with the seconds since they spoke; undefined: it stays as it was.
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
