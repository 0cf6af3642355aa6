// The stream of events (docs/web/events.md), read by hand: an EventSource tells neither of heartbeats nor why it was
// refused.

export interface ServerEvent {
    kind: string; // empty: a heartbeat, or the opening
    id: string; // empty: none
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

// Makes events of text that comes in pieces.
export class EventText {
    private rest = '';

    take(piece: string): ServerEvent[] {
        const frames = (this.rest + piece).split('\n\n');
        this.rest = frames.pop()!;
        return frames.map(eventOf);
    }
}
