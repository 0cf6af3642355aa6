// Shows the editor of colors and opacity: presets, points, threshold, undo and redo, files. The editor is a script of
// its own, which the page loads when the user first opens it (edit_colors.ts).

import { Draft, OpacityPoint, draftOf, perKmAt } from '../../tables/draft';
import {
    withColor,
    withColorAdded,
    withColorMoved,
    withColorRemoved,
    withOpacityAdded,
    withOpacityMoved,
    withOpacityRemoved,
} from '../../tables/draft_edits';
import { countCodes, histogramOf } from '../../atlas/histogram';
import { TableError, colorOfHex, hexOf, mostFileBytes } from '../../tables/table_file';
import { shownUnit } from '../../tables/units';
import { App, Shown } from '../app';
import { button, element, labeled, labeledButton, make, putOptions, saveFile } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { ColorTable } from '../../wire/color_tables';
import { ExportedFile, TableEditing } from '../table_editing';
import { tableTitle } from '../table_book';
import { editorTexts } from '../later_texts';
import { EditorPlot, Selection } from './editor_plot';
import { draftFrom, palOf } from './draft_files';

const words = editorTexts;
const otherPanels = [
    { id: 'settings', opener: 'open' },
    { id: 'layers', opener: 'layers-open' },
    { id: 'scan', opener: 'scan-open' },
];

export class Editor {
    private section: HTMLElement | null = null;
    private plot = new EditorPlot({
        select: (selection) => this.select(selection),
        move: (selection, value, perKm, doing) => this.move(selection, value, perKm, doing),
        add: (kind, value, perKm) => this.add(kind, value, perKm),
        remove: (selection) => this.remove(selection),
        rest: () => this.editing.rest(),
    });
    private selected: Selection = { kind: 'color', at: 0 };
    private counted: { shown: Shown; key: string; counts: Uint32Array; histogram: Uint32Array } | null = null;
    private says = make('p', { id: 'editor-says', role: 'status' });
    private opener: HTMLElement | null = null;

    constructor(
        private app: App,
        private drawing: Drawing,
        private editing: TableEditing,
    ) {}

    begin(keys: Keys): void {
        keys.add('Escape', () => this.close());
        this.app.on(['view', 'shown', 'choices', 'units'], () => this.put());
        // Close when another panel opens, because only one is open at a time.
        for (const other of otherPanels) element(other.opener).addEventListener('click', () => this.close(false));
        window.addEventListener('resize', () => this.put());
    }

    get isOpen(): boolean {
        return this.section !== null && !this.section.hidden;
    }

    open(): void {
        this.opener = document.activeElement as HTMLElement | null;
        for (const { id, opener } of otherPanels) if (!element(id).hidden) element(opener).click();
        this.section ??= this.make();
        this.section.hidden = false;
        element('edit-colors').setAttribute('aria-expanded', 'true');
        this.put();
        this.drawing.draw();
        element('editor-preset').focus();
    }
    close(takesKeyboard = true): void {
        if (!this.section || this.section.hidden) return;
        this.section.hidden = true;
        element('edit-colors').setAttribute('aria-expanded', 'false');
        const opener = this.opener?.offsetParent ? this.opener : element('picture');
        if (takesKeyboard) opener.focus();
        this.drawing.draw();
    }

    // -- the panel

    private make(): HTMLElement {
        const section = make(
            'section',
            { id: 'editor', 'aria-label': words.title },
            this.tools(),
            this.plot.box,
            this.pointRow(),
            this.says,
        );
        section.addEventListener('keydown', (event) => this.press(event));
        section.addEventListener('dragover', (event) => event.preventDefault());
        section.addEventListener('drop', (event) => {
            event.preventDefault();
            const file = event.dataTransfer?.files[0];
            if (file) void this.take(file);
        });
        element('reading').before(section);
        return section;
    }

    private tools(): HTMLElement {
        const preset = make('select', { id: 'editor-preset', 'aria-label': words.preset });
        preset.addEventListener('change', () => {
            if (preset.value) this.editing.choosePreset(preset.value);
        });
        const attributes = { id: 'editor-file', type: 'file', accept: '.pal,.toml', hidden: '' };
        const file = make('input', { ...attributes, 'aria-label': words.import });
        file.addEventListener('change', () => {
            if (file.files?.[0]) void this.take(file.files[0]);
            file.value = '';
        });
        return make(
            'div',
            { class: 'tools' },
            preset,
            labeledButton('editor-undo', '↶', words.undo, () => this.editing.undo()),
            labeledButton('editor-redo', '↷', words.redo, () => this.editing.redo()),
            button('editor-import', words.import, () => file.click()),
            file,
            button('editor-toml', words.toToml, () => this.save(this.editing.toml())),
            button('editor-pal', words.toPal, () => this.save(palOf(this.app, this.editing))),
            labeledButton('editor-close', '×', words.close, () => this.close()),
        );
    }

    private pointRow(): HTMLElement {
        const value = make('input', { id: 'point-value', type: 'number', step: 'any' });
        value.addEventListener('change', () =>
            this.move(this.selected, Number(value.value) / this.unit.perStored, this.perKmOfSelected(), null),
        );
        const color = make('input', { id: 'point-color', type: 'color' });
        color.addEventListener('input', () => {
            const rgba = colorOfHex(color.value);
            if (rgba && this.selected.kind === 'color')
                this.edit((draft) => withColor(draft, this.selected.at, rgba), `color ${this.selected.at}`);
        });
        color.addEventListener('change', () => this.editing.rest());
        const opacity = make('input', { id: 'point-opacity', type: 'number', min: '0', step: 'any' });
        opacity.addEventListener('change', () =>
            this.move(this.selected, this.valueOfSelected(), Number(opacity.value), null),
        );
        return make(
            'div',
            { class: 'point' },
            labeled(words.value, value),
            labeled(words.color, color),
            labeled(words.opacity, opacity),
            button('point-add', words.add, () => this.addAfter()),
            button('point-remove', words.remove, () => this.remove(this.selected)),
        );
    }

    private press(event: KeyboardEvent): void {
        const isUndo = (event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z';
        if (event.key === 'Escape') this.close();
        else if (isUndo && !event.shiftKey) this.editing.undo();
        else if (isUndo || ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'y')) this.editing.redo();
        else return;
        event.preventDefault();
    }

    // -- points

    private get unit() {
        return shownUnit(this.app.table?.unit ?? '', this.app.state.units);
    }
    // Returns the points of opacity that an edit would change.
    private opacities(): OpacityPoint[] {
        const { draft } = this.editing;
        const { table, book } = this.app;
        if (!draft || !table || !book) return [];
        // Make points of the table's opacity. Leave out the table's moment, because a draft of a moment with its usual
        // opacity has no points.
        return draft.opacity ?? draftOf({ ...table, moment: '' }, draft.moment, book.usual).opacity ?? [];
    }
    private valueOfSelected(): number {
        const { kind, at } = this.selected;
        if (kind === 'least') return this.least;
        return kind === 'color' ? (this.editing.draft?.colors[at]?.value ?? 0) : (this.opacities()[at]?.value ?? 0);
    }
    private perKmOfSelected(): number | null {
        return this.selected.kind === 'opacity' ? (this.opacities()[this.selected.at]?.perKm ?? 0) : null;
    }
    private get least(): number {
        return this.app.state.least ?? this.editing.draft?.barBegin ?? 0;
    }

    private edit(change: Parameters<TableEditing['edit']>[0], doing: string | null): void {
        this.drawing.move();
        this.editing.edit(change, doing);
    }
    private select(selection: Selection): void {
        this.selected = selection;
        this.put();
    }
    private move({ kind, at }: Selection, value: number, perKm: number | null, doing: string | null): void {
        if (!Number.isFinite(value)) return this.put();
        const opacity = this.opacities();
        if (kind === 'color') this.edit((draft) => withColorMoved(draft, at, value), doing);
        else if (kind === 'opacity')
            this.edit((draft) => withOpacityMoved(draft, opacity, at, value, perKm ?? opacity[at]!.perKm), doing);
        else this.hideBelow(value, doing);
    }
    private hideBelow(value: number, doing: string | null): void {
        const { draft } = this.editing;
        if (!draft) return;
        this.drawing.move();
        this.editing.hideBelow(value <= draft.barBegin ? null : Math.min(draft.end, value), doing);
    }
    private add(kind: 'color' | 'opacity', value: number, perKm: number): void {
        const opacity = this.opacities();
        let at = -1;
        this.edit((draft) => {
            const [next, place] =
                kind === 'color'
                    ? withColorAdded(draft, value)
                    : withOpacityAdded(draft, opacity, value, Number.isNaN(perKm) ? perKmAt(opacity, value) : perKm);
            at = place;
            return next;
        }, null);
        if (at >= 0) {
            this.select({ kind, at });
            this.plot.focus(this.selected);
        } else {
            this.say(words.noRoom);
        }
    }
    private addAfter(): void {
        const kind = this.selected.kind === 'opacity' ? 'opacity' : 'color';
        this.add(kind, this.plot.middleAfter(kind, this.selected.kind === kind ? this.selected.at : 0), NaN);
    }
    private remove({ kind, at }: Selection): void {
        const opacity = this.opacities();
        if (kind === 'least') return;
        const before = this.editing.draft;
        this.edit(
            (draft) => (kind === 'color' ? withColorRemoved(draft, at) : withOpacityRemoved(draft, opacity, at)),
            null,
        );
        if (this.editing.draft === before) return this.say(words.lastPoints);
        this.select({ kind, at: Math.max(0, at - 1) });
        this.plot.focus(this.selected);
    }

    // -- files

    private say(text: string, isWrong = false): void {
        this.says.textContent = text;
        this.says.classList.toggle('wrong', isWrong);
    }
    private async take(file: File): Promise<void> {
        try {
            if (file.size > mostFileBytes) throw new TableError(words.tooLarge(file.name));
            const { draft, said } = draftFrom(this.app, await file.text(), file.name);
            this.editing.takeDraft(draft);
            this.say(said);
        } catch (error) {
            this.say(error instanceof Error ? error.message : String(error), true);
        }
    }
    private save(file: ExportedFile | undefined): void {
        if (!file) return;
        const { name, text, isWhole } = file;
        saveFile(name, text);
        this.say(isWhole ? words.saved(name) : words.savedInPart(name), !isWhole);
    }

    // -- state of the panel

    private put(): void {
        const { app, editing } = this;
        const { draft } = editing;
        const { table } = app;
        if (!this.isOpen || !draft || !table) return;
        const opacity = this.opacities();
        const count = { color: draft.colors.length, opacity: opacity.length, least: 1 }[this.selected.kind];
        this.selected = { ...this.selected, at: Math.max(0, Math.min(count - 1, this.selected.at)) };
        this.putTools(draft, table);
        this.putPoint(draft, opacity);
        const content = { draft, opacity, table, least: this.least, unit: this.unit, selected: this.selected };
        this.plot.show({ ...content, histogram: null });
        const histogram = this.histogram();
        if (histogram) this.plot.show({ ...content, histogram });
    }

    private histogram(): Uint32Array | null {
        const { shown } = this.app;
        if (shown?.moment !== this.app.state.moment) return null;
        const range = this.plot.range();
        const key = `${range.join()} ${this.plot.columns}`;
        if (this.counted?.shown !== shown || this.counted.key !== key) {
            const { grid, atlas } = shown.loaded;
            const counts = this.counted?.shown === shown ? this.counted.counts : countCodes(grid, atlas);
            this.counted = { shown, key, counts, histogram: histogramOf(grid, counts, range, this.plot.columns) };
        }
        return this.counted.histogram;
    }

    private putTools(draft: Draft, table: ColorTable): void {
        const { app, editing } = this;
        const preset = element<HTMLSelectElement>('editor-preset');
        const names = (app.book?.presets(app.state.moment) ?? []).map((one) => one.name);
        if (editing.isEdited) names.unshift('');
        putOptions(preset, names, editing.isEdited ? '' : table.name, (name) =>
            name ? tableTitle(name) : words.edited(draft.name),
        );
        element<HTMLButtonElement>('editor-undo').disabled = !editing.canUndo;
        element<HTMLButtonElement>('editor-redo').disabled = !editing.canRedo;
    }

    private putPoint(draft: Draft, opacity: OpacityPoint[]): void {
        const { kind, at } = this.selected;
        const value = element<HTMLInputElement>('point-value');
        value.value = String(Number((this.valueOfSelected() * this.unit.perStored).toFixed(3)));
        const color = element<HTMLInputElement>('point-color');
        color.closest('label')!.hidden = kind !== 'color';
        if (kind === 'color') color.value = hexOf(draft.colors[at]!.color).slice(0, 7);
        const perKm = element<HTMLInputElement>('point-opacity');
        perKm.closest('label')!.hidden = kind !== 'opacity';
        if (kind === 'opacity') perKm.value = String(opacity[at]!.perKm);
        element<HTMLButtonElement>('point-remove').disabled = kind === 'least';
    }
}
