// Helps panels to find and make elements of the document.

// What no picture needs is loaded so many milliseconds after a picture, so that the browser shows the picture first.
export const afterPictureMs = 50;

// eslint-disable-next-line @typescript-eslint/no-unnecessary-type-parameters -- callers name the kind of their element
export function element<T extends HTMLElement>(id: string): T {
    return document.getElementById(id) as T;
}

// Returns the size of texts relative to the usual size. The style sheet sets it by the font size of the root, which is
// usually 10 pixels, and larger on large screens or if the user has set a larger font.
export function textScale(): number {
    return parseFloat(getComputedStyle(document.documentElement).fontSize) / 10;
}

export function fontOf(pixels: number, weight: 'normal' | 'bold' = 'normal'): string {
    return `${weight} ${pixels}px "DejaVu Sans", system-ui, sans-serif`;
}

// Returns the number of pixels of the screen in a pixel of the page.
export function pixelRatio(): number {
    return window.devicePixelRatio || 1;
}

// Gives a canvas one pixel for each pixel of the screen that it covers. Returns a pen whose unit is
// textScale() pixels of the page, so that drawings grow with the texts.
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

// Makes Escape close a panel, and move the focus to the control that opened it.
export function leaveByEscape(panel: HTMLElement, openerId: string, close: () => void): void {
    panel.addEventListener('keydown', (event) => {
        if (event.key !== 'Escape') return;
        close();
        element(openerId).focus();
        event.stopPropagation();
    });
}

// Makes a button that shows a sign. Its name is for screen readers.
export function labeledButton(id: string, sign: string, name: string, action: () => void): HTMLButtonElement {
    const made = button(id, sign, action);
    made.setAttribute('aria-label', name);
    made.title = name;
    return made;
}

export function paragraph(text: string): HTMLParagraphElement {
    return make('p', {}, text);
}

// Fills a list with names, and chooses one of them.
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
