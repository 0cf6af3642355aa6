// Parses the stream of events (docs/web/events.md). The page does not use an EventSource, which reports neither
// heartbeats nor the reason of a refusal.

export interface ServerEvent {
    kind: string; // empty for a heartbeat, and for the opening of the stream
    id: string; // empty without an id
    data: string;
}

function eventOf(frame: string): ServerEvent {
    const event: ServerEvent = { kind: '', id: '', data: '' };
    for (const line of frame.split('\n')) {
        const [, name, value = ''] = /^(id|event|data): ?(.*)$/.exec(line) ?? [];
        if (name === 'id') event.id = value;
        if (name === 'event') event.kind = value;
        if (name === 'data') event.data += value;
    }
    return event;
}

// Makes events of text that comes in pieces, and keeps the beginning of an event until the rest comes.
export class EventText {
    private rest = '';

    take(piece: string): ServerEvent[] {
        const frames = (this.rest + piece).split('\n\n');
        this.rest = frames.pop()!;
        return frames.map(eventOf);
    }
}
