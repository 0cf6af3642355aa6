// Limits the streams of events of all pages in a browser. A browser has six connections to a server, a stream of events
// occupies one, and pictures need some. So at most three pages have a stream, and other pages ask for lists now and
// then.

const mostPages = 3;
const othersTellWithinMs = 1000; // long enough for pages that are busy drawing

type Message = { asks: string } | { told: string; by: string };

// Returns the channel between pages; null if the browser has none. Each page then has a stream.
function channel(): BroadcastChannel | null {
    try {
        return new BroadcastChannel('stormcellar events');
    } catch {
        return null;
    }
}

export class StreamPlaces {
    private readonly pages = channel(); // to the other pages of this server in this browser
    private state: 'without' | 'asking' | 'with' = 'without';
    private id = ''; // id of the last question; if several pages ask at once, the smallest id goes first
    private others = new Set<string>(); // ids of pages that have a place or go first

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

    // Takes a place at once. If other pages then answer that they have all places, gives the place back and calls
    // `noPlace`.
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
