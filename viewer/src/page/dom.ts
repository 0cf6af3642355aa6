// Helpers of the panels for the document.

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

// Returns how many pixels of the picture a pixel of the page is wide.
export function pixelRatio(): number {
    return window.devicePixelRatio || 1;
}

// Makes a canvas as fine as the screen shows it. Returns a pen whose pixels are larger where texts are.
export function penOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
    const ratio = pixelRatio();
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    const pen = canvas.getContext('2d')!;
    pen.scale(ratio * textScale(), ratio * textScale());
    return pen;
}

// Makes an element with these attributes and children.
export function make<Kind extends keyof HTMLElementTagNameMap>(
    kind: Kind,
    attributes: Record<string, string> = {},
    ...children: (Node | string)[]
): HTMLElementTagNameMap[Kind] {
    const made = document.createElement(kind);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
}

// Puts a name before a control.
export function labeled(name: string, ...control: HTMLElement[]): HTMLLabelElement {
    return make('label', {}, make('span', {}, name), ...control);
}

export function button(id: string, text: string, action: () => void): HTMLButtonElement {
    const made = make('button', { id }, text);
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
    return make('p', {}, text);
}

// Fills a list with names, of which one is chosen.
export function putOptions(
    select: HTMLSelectElement,
    names: string[],
    chosen: string | undefined,
    textOf = (name: string) => name,
): void {
    select.replaceChildren(...names.map((name) => new Option(textOf(name), name, false, name === chosen)));
}

export function saveFile(name: string, text: string): void {
    const href = URL.createObjectURL(new Blob([text], { type: 'text/plain' }));
    make('a', { download: name, href }).click();
    window.setTimeout(() => URL.revokeObjectURL(href), 10_000);
}

export function press(id: string, isPressed: boolean): void {
    element(id).setAttribute('aria-pressed', String(isPressed));
}
