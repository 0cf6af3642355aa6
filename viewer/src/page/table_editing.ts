// Applies the user's edits of colors (presets, drafts, threshold, files), with undo and redo.

import { Draft, fileOf } from '../tables/draft';
import { History } from '../tables/history';
import { writeToml } from '../tables/toml_writer';
import { tablesOf } from '../wire/moments';
import { App } from './app';

interface Colors {
    colors: string;
    drafts: Draft[];
    least: number | null;
}

export interface ExportedFile {
    name: string;
    text: string;
    isWhole: boolean; // the file expresses all of the table
}

// Returns the FNV-1a hash of 32 bits, as text.
function checksum(text: string): string {
    let sum = 0x811c9dc5;
    for (const letter of text) sum = Math.imul(sum ^ letter.codePointAt(0)!, 0x01000193);
    return (sum >>> 0).toString(16).padStart(8, '0');
}

export class TableEditing {
    private history = new History<Colors>();
    private known: { key: string; draft: Draft | undefined } = { key: '', draft: undefined };

    constructor(private app: App) {}

    // Returns the moment whose tables the chosen moment has.
    private get moment(): string {
        return tablesOf(this.app.state.moment);
    }
    // Returns the draft of the chosen moment, or a draft made of its table.
    get draft(): Draft | undefined {
        const { state, book } = this.app;
        const draft = state.drafts.find((one) => one.moment === this.moment);
        if (draft) return draft;
        const key = `${this.moment} ${state.colors} ${book?.isClearAir}`;
        if (this.known.key !== key || !this.known.draft) this.known = { key, draft: book?.draftOf(state, this.moment) };
        return this.known.draft;
    }
    get isEdited(): boolean {
        return this.app.state.drafts.some((one) => one.moment === this.moment);
    }
    get canUndo(): boolean {
        return this.history.canUndo;
    }
    get canRedo(): boolean {
        return this.history.canRedo;
    }

    private get now(): Colors {
        const { colors, drafts, least } = this.app.state;
        return { colors, drafts, least };
    }
    private become(next: Partial<Colors>): void {
        Object.assign(this.app.state, next);
        this.app.changed();
    }

    // Changes the draft. Consecutive changes with the same `doing`, such as those of a drag, are undone together.
    edit(change: (draft: Draft) => Draft, doing: string | null = null): void {
        const { draft } = this;
        const next = draft && change(draft);
        if (!draft || !next || next === draft) return;
        this.history.note(this.now, doing);
        this.become({ drafts: this.with(next) });
    }
    private with(draft: Draft): Draft[] {
        return [...this.app.state.drafts.filter((one) => one.moment !== draft.moment), draft];
    }
    rest(): void {
        this.history.rest();
    }
    hideBelow(least: number | null, doing: string | null = null): void {
        this.history.note(this.now, doing);
        this.become({ least: least === null ? null : Number(least.toFixed(4)) });
    }
    choosePreset(name: string): void {
        this.history.note(this.now);
        this.become({ colors: name, drafts: this.app.state.drafts.filter((one) => one.moment !== this.moment) });
    }
    undo(): void {
        this.become(this.history.undo(this.now));
    }
    redo(): void {
        this.become(this.history.redo(this.now));
    }

    // -- files

    takeDraft(draft: Draft): void {
        this.history.note(this.now);
        this.become({ drafts: this.with(draft) });
    }

    // Returns a file with the shown table, without values below the threshold.
    toml(): ExportedFile | undefined {
        const { draft } = this;
        return (
            draft && { name: `${draft.name}.toml`, text: writeToml(fileOf(draft, this.app.state.least)), isWhole: true }
        );
    }
    // Returns the file of the shown table under a name that depends on its content. If two different files had one
    // name, the browser would rename the second file, and a command would read the first.
    tomlForCommand(): ExportedFile | undefined {
        const file = this.toml();
        return file && { ...file, name: file.name.replace(/\.toml$/, `-${checksum(file.text)}.toml`) };
    }
}
