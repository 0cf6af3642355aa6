// Keeps the values before and after changes, for undo and redo.

const mostSteps = 200;

export class History<T> {
    private past: T[] = [];
    private future: T[] = [];
    private doing: string | null = null;

    // Call before a change, with the value that will change. Consecutive changes with the same label `doing`, such
    // as those of a drag, are one step.
    note(before: T, doing: string | null = null): void {
        if (doing !== null && doing === this.doing) return;
        this.doing = doing;
        this.past.push(before);
        if (this.past.length > mostSteps) this.past.shift();
        this.future = [];
    }
    // Makes the next change a step of its own.
    rest(): void {
        this.doing = null;
    }

    get canUndo(): boolean {
        return this.past.length > 0;
    }
    get canRedo(): boolean {
        return this.future.length > 0;
    }
    undo(now: T): T {
        return this.go(now, this.past, this.future);
    }
    redo(now: T): T {
        return this.go(now, this.future, this.past);
    }
    private go(now: T, from: T[], to: T[]): T {
        this.rest();
        const next = from.pop();
        if (next === undefined) return now;
        to.push(now);
        return next;
    }
}
