// Shows the overlays in the panel of layers, and takes files that the user drops on the page or chooses.

import { App } from '../app';
import { button, element, labeled, labeledButton, make } from '../dom';
import { Drawing } from '../drawing';
import { layerTexts } from '../later_texts';
import { OverlayLayers, OverlayRow } from './overlay_layers';

const words = layerTexts.overlays;

interface RowElements {
    box: HTMLInputElement;
    text: HTMLElement;
    all: HTMLElement;
    row: OverlayRow;
}

export class OverlayRows {
    private layers = new OverlayLayers(this.app, this.drawing);
    private rows = new Map<string, RowElements>(); // by kind and name
    private count = 0; // of rows, which numbers their elements
    private list = make('div', { class: 'overlays' });
    private says = make('p', { id: 'overlay-says', role: 'status' });
    private told = make('p', { id: 'overlays-told', hidden: '' });
    private chooser = make('input', { type: 'file', multiple: '', hidden: '', 'aria-label': words.add });

    constructor(
        private app: App,
        private drawing: Drawing,
    ) {}

    begin(): void {
        const add = button('overlay-add', words.add, () => this.chooser.click());
        add.title = words.addTip;
        element('layers').append(
            make(
                'div',
                { id: 'overlays', role: 'group', 'aria-label': words.title },
                this.list,
                add,
                this.chooser,
                this.says,
            ),
        );
        element('layers-told').after(this.told);
        this.chooser.addEventListener('change', () => {
            void this.add([...(this.chooser.files ?? [])]);
            this.chooser.value = ''; // so that the same file can be chosen again
        });
        element('layers-open').addEventListener('click', () => element('layers').hidden || void this.layers.askNames());
        if (!element('layers').hidden) void this.layers.askNames();
        this.takeDrops();
        this.layers.changed = () => this.put();
        this.layers.begin();
    }

    private takeDrops(): void {
        const { classList } = document.body;
        const take = (event: DragEvent): boolean => {
            if (!event.dataTransfer?.types.includes('Files')) return false;
            event.preventDefault(); // or the browser would leave the page and show the file
            return true;
        };
        document.addEventListener('dragover', (event) => classList.toggle('dropping', take(event)));
        document.addEventListener('dragleave', ({ relatedTarget }) => {
            if (relatedTarget === null) classList.remove('dropping'); // the pointer left the window
        });
        document.addEventListener('drop', (event) => {
            classList.remove('dropping');
            if (take(event)) void this.add([...(event.dataTransfer?.files ?? [])]);
        });
    }

    // Adds files. Opens the panel if the picture shows nothing of them.
    private async add(files: readonly File[]): Promise<void> {
        const areShown = await this.layers.add(files);
        if (this.app.isOnMap) this.app.miss(this.layers.problem);
        else if (!areShown && element('layers').hidden) element('layers-open').click();
        if (!areShown) this.says.scrollIntoView({ block: 'nearest' });
    }

    private put(): void {
        const before = new Map(this.rows);
        this.rows.clear();
        const wanted = this.layers.rows;
        for (const row of wanted) {
            const key = `${row.remove ? 'file' : 'server'} ${row.name}`;
            const elements = before.get(key) ?? this.makeRow(row);
            before.delete(key);
            this.rows.set(key, elements);
            elements.row = row;
            elements.box.checked = row.isOn;
            if (elements.text.textContent !== row.text) elements.text.textContent = row.text;
        }
        for (const { all } of before.values()) {
            if (all.contains(document.activeElement)) element('overlay-add').focus();
            all.remove();
        }
        [...this.rows.values()].forEach(({ all }, i) => {
            if (this.list.children[i] !== all) this.list.insertBefore(all, this.list.children[i] ?? null);
        });
        if (this.says.textContent !== this.layers.problem) this.says.textContent = this.layers.problem;
        this.told.textContent = wanted
            .filter(({ isOn }) => isOn)
            .map(({ text }) => text)
            .join(' · ');
        this.told.hidden = this.told.textContent === '';
    }

    private makeRow(row: OverlayRow): RowElements {
        const id = `overlay-${++this.count}`;
        const box = make('input', { id, type: 'checkbox' });
        const label = labeled(row.text, box);
        label.className = 'toggle';
        const all = make('div', {}, label);
        const made: RowElements = { box, text: label.querySelector('span')!, all, row };
        box.addEventListener('change', () => made.row.toggle());
        if (row.remove)
            all.append(labeledButton(`${id}-remove`, '×', words.remove(row.name), () => made.row.remove?.()));
        return made;
    }
}
