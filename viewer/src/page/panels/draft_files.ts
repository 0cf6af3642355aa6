// Reads drafts from files of color tables, and writes them as .pal files. The page loads this with the editor.

import { Draft, draftOf, tableForPal } from '../../tables/draft';
import { readPal, writePal } from '../../tables/pal_file';
import { TableError, mostFileBytes, tableOfFile } from '../../tables/table_file';
import { readToml } from '../../tables/toml_file';
import { tablesOf } from '../../wire/moments';
import { App } from '../app';
import { ExportedFile, TableEditing } from '../table_editing';
import { editorTexts } from '../later_texts';

// Returns the draft of a file, and a sentence for the user. Throws a TableError for a bad file.
export function draftFrom({ state, book }: App, text: string, fileName: string): { draft: Draft; said: string } {
    const ending = /\.(pal|toml)$/i.exec(fileName)?.[1]?.toLowerCase();
    if (!ending || !book) throw new TableError(editorTexts.otherEnding(fileName));
    if (text.length > mostFileBytes) throw new TableError(editorTexts.tooLarge(fileName));
    const table =
        ending === 'pal' ? readPal(text, fileName, book.usual) : tableOfFile(readToml(text, fileName), book.usual);
    const moment = tablesOf(table.moment || state.moment);
    const unit = book.preset(moment, '')?.unit ?? table.unit;
    if (table.unit && table.unit !== unit) throw new TableError(editorTexts.otherUnit(fileName, table.unit, unit));
    const draft = {
        ...draftOf({ ...table, name: table.name || fileName.replace(/\.[^.]*$/, '') }, moment, book.usual),
        unit,
    };
    return {
        draft,
        said:
            moment === tablesOf(state.moment)
                ? editorTexts.taken(fileName, draft.colors.length)
                : editorTexts.otherMoment(fileName, moment),
    };
}

// Returns a .pal file with the shown table, without values below the threshold, as far as a .pal file can express it.
export function palOf({ state, book }: App, { draft }: TableEditing): ExportedFile | undefined {
    if (!draft || !book) return undefined;
    const { table, isWhole } = tableForPal(draft, book.usual, state.least);
    return { name: `${draft.name}.pal`, text: writePal(table), isWhole };
}
