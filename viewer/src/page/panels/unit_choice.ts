// Adds the choice of units to the settings. The address and the browser keep the choice.

import { Quantity, knownUnits, quantities } from '../../tables/units';
import { App } from '../app';
import { element, labeled, make } from '../dom';
import { panelTexts } from '../later_texts';

function selectOf(app: App, quantity: Quantity): HTMLLabelElement {
    const select = make('select', { id: `units-${quantity}` });
    for (const { symbol, name } of knownUnits[quantity]) select.add(new Option(symbol, name));
    select.addEventListener('change', () => {
        app.useUnits({ ...app.state.units, [quantity]: knownUnits[quantity][select.selectedIndex]! });
    });
    return labeled(panelTexts.units[quantity], select);
}

export function addUnits(app: App): void {
    element('units').setAttribute('aria-label', panelTexts.units.all);
    element('units').append(...quantities.map((quantity) => selectOf(app, quantity)));
    const put = () => {
        for (const quantity of quantities)
            element<HTMLSelectElement>(`units-${quantity}`).value = app.state.units[quantity].name;
    };
    app.on('view', put);
    put();
}
