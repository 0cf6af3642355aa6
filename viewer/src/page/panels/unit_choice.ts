// In which units the page writes: chosen in the settings, kept in the address and by the browser.

import { Quantity, knownUnits, quantities } from '../../tables/units';
import { App } from '../app';
import { element } from '../dom';
import { texts } from '../texts';

function selectOf(app: App, quantity: Quantity): HTMLLabelElement {
    const label = document.createElement('label');
    const name = document.createElement('span');
    name.textContent = texts.units[quantity];
    const select = document.createElement('select');
    select.id = `units-${quantity}`;
    for (const { symbol, name: value } of knownUnits[quantity]) select.add(new Option(symbol, value));
    select.addEventListener('change', () => {
        app.useUnits({ ...app.state.units, [quantity]: knownUnits[quantity][select.selectedIndex]! });
    });
    label.append(name, select);
    return label;
}

export function addUnits(app: App): void {
    element('units').setAttribute('aria-label', texts.units.all);
    element('units').append(...quantities.map((quantity) => selectOf(app, quantity)));
    app.on('view', () => {
        for (const quantity of quantities)
            element<HTMLSelectElement>(`units-${quantity}`).value = app.state.units[quantity].name;
    });
}
