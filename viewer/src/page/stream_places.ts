// Shares the connections of a browser among its pages. A stream of events keeps one, a browser has six for a
// server, and pictures need some. So three pages at most hear events, and the others ask for lists now and then.

const mostPages = 3;
const othersTellWithinMs = 1000; // a page that draws answers late

type Message = { asks: string } | { told: string; by: string };

// Returns null if the browser keeps pages apart: each listens then.
function channel(): BroadcastChannel | null {
    try {
        return new BroadcastChannel('stormcellar events');
    } catch {
        return null;
    }
}

export class StreamPlaces {
    private readonly pages = channel(); // of this browser, at this server
    private state: 'without' | 'asking' | 'with' = 'without';
    private id = ''; // of the last question; if several pages ask at once, the smallest goes first
    private others = new Set<string>(); // that have a place, or go first

    constructor() {
        if (!this.pages) return;
        this.pages.onmessage = ({ data }: MessageEvent<Message>) => {
            if ('told' in data) {
                if (data.told === this.id) this.others.add(data.by);
            } else if (this.state === 'with' || (this.state === 'asking' && this.id < data.asks)) {
                this.pages?.postMessage({ told: data.asks, by: this.id });
            } else if (this.state === 'asking') {
                this.others.add(data.asks);
            }
        };
    }

    // Takes a place at once. If the other pages turn out to have all places, gives it back and calls `noPlace`.
    take(noPlace: () => void): void {
        const id = (this.id = String(Math.random()));
        this.state = 'asking';
        this.others.clear();
        this.pages?.postMessage({ asks: id });
        window.setTimeout(() => {
            if (this.id !== id || this.state !== 'asking') return;
            this.state = this.others.size < mostPages ? 'with' : 'without';
            if (this.state === 'without') noPlace();
        }, othersTellWithinMs);
    }
    leave(): void {
        this.state = 'without';
    }
}
