// Keeps the color tables of the page: tables of the server, and the user's drafts. Moments such as VEL
// and VELD share tables and draft.

import { colorFiles } from '../facts';
import { ViewState } from '../scene/view_state';
import { ColorTable } from '../wire/color_tables';
import { Draft, draftOf, tableOf } from '../tables/draft';
import { UsualOpacity, usualOpacity } from '../tables/usual_opacity';
import { Tables } from '../wire/api';
import { tablesOf } from '../wire/moments';
import { texts } from './texts';

// Returns the title of a table of the server, or the name of another table.
export const tableTitle = (name: string): string =>
    Object.entries(texts.tables).find(([begin]) => name.startsWith(begin))?.[1] ?? name;

export class TableBook {
    readonly usual: UsualOpacity;
    isClearAir = false; // reflectivity gets the colors for clear air, as in `stormcellar frame`
    private made = new WeakMap<Draft, ColorTable>();

    constructor(private tables: Tables) {
        this.usual = usualOpacity(tables.tables, tables.usual);
    }

    // Returns the tables of a moment, except tables of products in another unit.
    presets(moment: string): ColorTable[] {
        const own = this.tables.tables.filter((table) => table.moment === tablesOf(moment));
        const unit = own.find((table) => table.name === this.tables.usual[moment])?.unit;
        return own.filter((table) => table.unit === unit);
    }
    // Returns the server's usual table of a moment, which its tiles have.
    usualOf(moment: string): ColorTable | undefined {
        return this.presets(moment).find((table) => table.name === this.tables.usual[moment]);
    }
    preset(moment: string, name: string): ColorTable | undefined {
        const presets = this.presets(moment);
        const usual = name === '' && moment === 'REF' && this.isClearAir ? colorFiles.clearAir : name;
        return presets.find((table) => table.name === usual) ?? this.usualOf(moment);
    }

    // Returns the table of a moment in a view. The same draft always gives the same object.
    of(state: ViewState, moment: string): ColorTable | undefined {
        const draft = state.drafts.find((one) => one.moment === tablesOf(moment));
        if (!draft) return this.preset(moment, state.colors);
        const made = this.made.get(draft) ?? tableOf(draft, this.usual);
        this.made.set(draft, made);
        return made;
    }
    // Returns the draft of a moment, or a draft made of its table.
    draftOf(state: ViewState, moment: string): Draft | undefined {
        const draft = state.drafts.find((one) => one.moment === tablesOf(moment));
        const preset = this.preset(moment, state.colors);
        return draft ?? (preset && { ...draftOf(preset, tablesOf(moment), this.usual), name: `my-${preset.name}` });
    }
}
