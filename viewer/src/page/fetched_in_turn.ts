// Fetches items one at a time, and keeps the most recently used.
//
// The page uses this for sweeps. The server decodes a volume to list its sweeps, and keeps the decoded volume for the
// gates that the page asks for next. So sweeps come fastest if the page asks for them one at a time. This also keeps
// the server from being busy with one page.

interface Wanted<T> {
    value: T | null;
    error: unknown; // undefined: it has not failed
    failedAt: number;
    done: Promise<void>;
}

const againAfterMs = 10_000; // after a failure

export class FetchedInTurn<T> {
    private kept = new Map<string, Wanted<T>>(); // the least recently used first
    private waiting: { key: string; run: () => Promise<void> }[] = [];
    private isBusy = false;

    constructor(
        private mostBytes: number,
        private bytesOf: (value: T) => number,
        private now: () => number = () => performance.now(),
    ) {}

    // Returns an item; null if the item has failed or has not come yet.
    find(key: string): T | null {
        return this.known(key)?.value ?? null;
    }
    // Returns a kept item that passes a test, whatever its key; null if there is none.
    search(isWanted: (value: T) => boolean): T | null {
        for (const { value } of this.kept.values()) if (value !== null && isWanted(value)) return value;
        return null;
    }
    // Returns true if the item has come or failed.
    isSettled(key: string): boolean {
        const wanted = this.known(key);
        return wanted !== undefined && (wanted.value !== null || wanted.error !== undefined);
    }
    // Returns true if take() must fetch the item: it has not come, or failed long ago.
    isNeeded(key: string): boolean {
        return !this.isSettled(key) || this.isToRetry(key);
    }
    errorOf(key: string): unknown {
        return this.known(key)?.error;
    }

    private known(key: string): Wanted<T> | undefined {
        const wanted = this.kept.get(key);
        if (!wanted) return undefined;
        this.kept.delete(key);
        this.kept.set(key, wanted);
        return wanted;
    }
    private isToRetry(key: string): boolean {
        const wanted = this.known(key);
        return wanted?.error !== undefined && this.now() - wanted.failedAt > againAfterMs;
    }

    // Fetches an item if it is needed, and resolves when it has come or failed. Items that are not `isAhead` are
    // fetched first.
    take(key: string, fetch: () => Promise<T>, isAhead: boolean): Promise<void> {
        const known = this.known(key);
        if (known && !this.isToRetry(key)) {
            const at = this.waiting.findIndex((one) => one.key === key);
            if (at > 0 && !isAhead) this.waiting.unshift(...this.waiting.splice(at, 1));
            return known.done;
        }
        let settle = (): void => undefined;
        const wanted: Wanted<T> = {
            value: null,
            error: undefined,
            failedAt: 0,
            done: new Promise((done) => (settle = done)),
        };
        this.kept.set(key, wanted);
        const run = async () => {
            try {
                wanted.value = await fetch();
                this.drop(wanted);
            } catch (error) {
                wanted.error = error ?? new Error();
                wanted.failedAt = this.now();
            }
            settle();
        };
        if (isAhead) this.waiting.push({ key, run });
        else this.waiting.unshift({ key, run });
        void this.work();
        return wanted.done;
    }

    private async work(): Promise<void> {
        if (this.isBusy) return;
        this.isBusy = true;
        for (let next = this.waiting.shift(); next; next = this.waiting.shift()) await next.run();
        this.isBusy = false;
    }

    private drop(newest: Wanted<T>): void {
        const bytes = ({ value }: Wanted<T>) => (value === null ? 0 : this.bytesOf(value));
        let all = [...this.kept.values()].reduce((sum, one) => sum + bytes(one), 0);
        for (const [key, one] of [...this.kept]) {
            if (all <= this.mostBytes) break;
            if (one === newest || (one.value === null && one.error === undefined)) continue;
            all -= bytes(one);
            this.kept.delete(key);
        }
    }
}
