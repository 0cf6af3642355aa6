// Adds the button and the key that open the editor of colors. The first press loads the editor.

import { App } from '../app';
import { button, element } from '../dom';
import { Drawing } from '../drawing';
import { Keys } from '../keys';
import { laterProgram } from '../later_program';
import { TableEditing } from '../table_editing';
import { panelTexts } from '../later_texts';
import type { Editor } from './editor';

export function addEditor(app: App, drawing: Drawing, editing: TableEditing, keys: Keys): void {
    let loaded: Promise<Editor> | null = null;
    const load = async (): Promise<Editor> => {
        const program = await laterProgram<typeof import('./editor')>('editor');
        const editor = new program.Editor(app, drawing, editing);
        editor.begin(keys);
        return editor;
    };
    const use = (act: (editor: Editor) => void): void => {
        loaded ??= load();
        loaded.then(act).catch((error: unknown) => {
            loaded = null;
            app.fail(error);
        });
    };
    const open = button('edit-colors', panelTexts.editColors, () => use((editor) => editor.open()));
    open.setAttribute('aria-expanded', 'false');
    element('colors').closest('label')!.after(open);
    keys.add('e', () => use((editor) => (editor.isOpen ? editor.close() : editor.open())));
}
