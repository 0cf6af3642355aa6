// Assigns slots of the atlas (places for bricks in a texture; atlas.ts) to columns of bricks. If slots run out, the
// least recently used columns lose their slots, but pinned columns never do.

import { ResidentColumn } from './page_table';

export const columnKey = (level: number, x: number, y: number): string => `${level}/${x}/${y}`;

export class SlotPool {
    private free: number[] = [];
    private held = new Map<string, ResidentColumn>(); // the least recently used first
    private pinned = new Set<string>();

    constructor(readonly count: number) {
        for (let slot = count - 1; slot >= 0; --slot) this.free.push(slot);
    }

    get columns(): Iterable<ResidentColumn> {
        return this.held.values();
    }
    get freeCount(): number {
        return this.free.length;
    }
    has(key: string): boolean {
        return this.held.has(key);
    }
    use(key: string): void {
        const column = this.held.get(key);
        if (!column) return;
        this.held.delete(key);
        this.held.set(key, column);
    }
    pin(key: string): void {
        this.pinned.add(key);
    }

    // Gives a slot to each brick of a column for which `hasValues` is true. If slots run out, takes slots from the
    // least recently used columns whose keys are neither pinned nor in `wanted`. Returns null if that is not enough.
    take(
        level: number,
        x: number,
        y: number,
        hasValues: readonly boolean[],
        wanted: ReadonlySet<string>,
    ): ResidentColumn | null {
        const key = columnKey(level, x, y);
        this.release(key);
        const needed = hasValues.filter(Boolean).length;
        for (const old of this.held.keys()) {
            if (this.free.length >= needed) break;
            if (!wanted.has(old) && !this.pinned.has(old)) this.release(old);
        }
        if (this.free.length < needed) return null;
        const slots = Int32Array.from(hasValues, (has) => (has ? this.free.pop()! : -1));
        const column = { level, x, y, slots };
        this.held.set(key, column);
        return column;
    }

    release(key: string): void {
        const column = this.held.get(key);
        if (!column) return;
        this.held.delete(key);
        for (const slot of column.slots) if (slot >= 0) this.free.push(slot);
    }
}
