// Draws one picture at a time. A picture that is asked for while another is drawn follows it.

export class Turns {
    isAsked = false; // a picture begins with the next frame of the browser
    isBusy = false; // a picture is asked for, or is being drawn
    isFine = false; // the picture that is being drawn takes long, and may be given up
    isStopped = false; // the picture that is being drawn is given up
    isOutdated = false; // a later picture must follow the one that is being drawn
    private late: (() => void) | null = null; // waits until no picture is being drawn

    // `draw` draws a picture, sets isFine, and checks isStopped between the parts of the picture.
    constructor(
        private draw: () => Promise<void>,
        private nextFrame: (act: () => void) => void = (act) => void requestAnimationFrame(act),
    ) {}

    // Asks for a picture.
    ask(): void {
        this.isOutdated = true;
        if (this.isBusy) return;
        this.isBusy = this.isAsked = true;
        this.nextFrame(() => void this.take());
    }

    private begin(): void {
        this.isAsked = this.isOutdated = this.isStopped = this.isFine = false;
    }
    private async take(): Promise<void> {
        this.begin();
        try {
            await this.draw();
        } finally {
            this.isBusy = false;
            this.late?.();
            this.late = null;
            if (this.isOutdated) this.ask();
        }
    }

    // Gives up a fine picture that is being drawn. Returns true if there was one.
    stop(): boolean {
        this.isStopped ||= this.isBusy && !this.isAsked && this.isFine;
        return this.isStopped;
    }
    // Calls `act` once no picture is being drawn that uses what `act` changes. A later call replaces an action that
    // still waits.
    replace(act: () => void): void {
        this.late = null;
        if (!this.isBusy || this.isAsked || this.stop()) act();
        else this.late = act;
    }
}
