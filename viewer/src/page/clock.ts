// Tells times of day in UTC, or in the time zone of the browser if the user has chosen so. The browser keeps the choice
// from one visit to the next, if it permits storage.

const key = 'stormcellar-clock';

export class Clock {
    isLocal = false;
    private formats = new Map<string, Intl.DateTimeFormat>();

    constructor() {
        try {
            this.isLocal = localStorage.getItem(key) === 'local';
        } catch {
            // Do without storage if the browser forbids it.
        }
    }

    toggle(): void {
        this.isLocal = !this.isLocal;
        this.formats.clear();
        try {
            localStorage.setItem(key, this.isLocal ? 'local' : 'utc');
        } catch {
            // Do without storage if the browser forbids it.
        }
    }
    // Returns the name of the time zone at an instant, as "UTC" or "CDT".
    zone(timeMs: number): string {
        const parts = this.format('zone', { timeZoneName: 'short' }).formatToParts(timeMs);
        return parts.find(({ type }) => type === 'timeZoneName')?.value ?? '';
    }
    minute(timeMs: number): string {
        return this.format('minute', { hour: '2-digit', minute: '2-digit', hourCycle: 'h23' }).format(timeMs);
    }
    second(timeMs: number): string {
        const parts = { hour: '2-digit', minute: '2-digit', second: '2-digit', hourCycle: 'h23' } as const;
        return this.format('second', parts).format(timeMs);
    }
    day(timeMs: number): string {
        return this.format('day', { month: 'short', day: 'numeric' }).format(timeMs);
    }
    private format(name: string, parts: Intl.DateTimeFormatOptions): Intl.DateTimeFormat {
        let format = this.formats.get(name);
        if (!format) {
            format = new Intl.DateTimeFormat('en-US', { ...parts, ...(this.isLocal ? {} : { timeZone: 'UTC' }) });
            this.formats.set(name, format);
        }
        return format;
    }
}
