// Short words for what the panels do with the document.

// eslint-disable-next-line @typescript-eslint/no-unnecessary-type-parameters -- callers name the kind of their element
export function element<T extends HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

// Returns how much larger than usual texts are: on large screens, and where the user wants them so. The style
// sheet sets it as the size of the root's font, which is usually 10 pixels.
export function textScale(): number {
    return parseFloat(getComputedStyle(document.documentElement).fontSize) / 10;
}

export function fontOf(pixels: number, weight: 'normal' | 'bold' = 'normal'): string {
    return `${weight} ${pixels}px "DejaVu Sans", system-ui, sans-serif`;
}

export function button(id: string, text: string, action: () => void): HTMLButtonElement {
    const made = document.createElement('button');
    made.id = id;
    made.textContent = text;
    made.addEventListener('click', action);
    return made;
}

// Escape in a panel closes it, and the keyboard is where the panel was opened.
export function leaveByEscape(panel: HTMLElement, openerId: string, close: () => void): void {
    panel.addEventListener('keydown', (event) => {
        if (event.key !== 'Escape') return;
        close();
        element(openerId).focus();
        event.stopPropagation();
    });
}

// A button that shows a sign; its name is a text.
export function labeledButton(id: string, sign: string, name: string, action: () => void): HTMLButtonElement {
    const made = button(id, sign, action);
    made.setAttribute('aria-label', name);
    made.title = name;
    return made;
}

export function paragraph(text: string): HTMLParagraphElement {
    const made = document.createElement('p');
    made.textContent = text;
    return made;
}

// Fills a list with names, of which one is chosen.
export function putOptions(
    select: HTMLSelectElement,
    names: string[],
    chosen: string | undefined,
    textOf = (name: string) => name,
): void {
    select.replaceChildren(
        ...names.map((name) => {
            const option = document.createElement('option');
            option.value = name;
            option.textContent = textOf(name);
            option.selected = name === chosen;
            return option;
        }),
    );
}

export function saveFile(name: string, text: string): void {
    const link = document.createElement('a');
    link.download = name;
    link.href = URL.createObjectURL(new Blob([text], { type: 'text/plain' }));
    link.click();
    window.setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function press(id: string, isPressed: boolean): void {
    element(id).setAttribute('aria-pressed', String(isPressed));
}
