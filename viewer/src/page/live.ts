// Listens to the server's news of grids, and notices if the server does not answer.

import { ApiError, askEvents, silences, timeOf } from '../wire/api';
import { EventText, ServerEvent } from '../wire/events';
import { App } from './app';
import { StreamPlaces } from './stream_places';

interface News {
    domain?: string;
    moment?: string;
    grid?: string; // time of the grid
    station?: string;
    silent_s?: number;
    oldest?: string | null; // time of the oldest grid that is left after an eviction
}

const kindsOfGrids = ['sweep_gridded', 'volume_complete', 'mosaic', 'grid_evicted'];
const againAfterMs = 3000;
const refusedAgainAfterMs = 30_000;
const mostQuietMs = 40_000; // the server sends a heartbeat every 15 s

const pause = (ms: number): Promise<void> => new Promise((done) => window.setTimeout(done, ms));
const noAnswer = (): never => {
    throw new TypeError('no answer');
};

export class Live {
    private last = ''; // the id of the last event
    private isBehind = false; // news may be lost, so the page must ask for all lists
    private isCatchingUp = false; // doWithout() is asking for all lists
    private readonly places = new StreamPlaces();

    // News waits until `begun` resolves.
    constructor(
        private app: App,
        private begun: Promise<void>,
    ) {}

    async hear(): Promise<never> {
        for (;;) await pause((await this.listen()) ? againAfterMs : refusedAgainAfterMs);
    }

    // Listens until the stream ends. Returns false if the server answers but the page gets no stream; the page then
    // tries again later than after a broken stream.
    private async listen(): Promise<boolean> {
        const abort = new AbortController();
        let timer = 0;
        const wait = () => {
            window.clearTimeout(timer);
            timer = window.setTimeout(() => abort.abort(), mostQuietMs);
        };
        wait();
        let hasPlace = true as boolean;
        this.places.take(() => {
            hasPlace = false;
            abort.abort();
        });
        try {
            const answer = await askEvents(this.last, abort.signal);
            const wasCutOff = this.app.server.isCutOff;
            // The server or a proxy may refuse the stream but answer other requests.
            if (!answer.body || !answer.headers.get('Content-Type')?.includes('event-stream')) {
                this.places.leave();
                await this.doWithout();
                return false;
            }
            this.app.server.take(true, timeOf(answer));
            this.connected(wasCutOff);
            const [reader, decoder, text] = [answer.body.getReader(), new TextDecoder(), new EventText()];
            for (let part = await reader.read(); !part.done; part = await reader.read()) {
                wait();
                for (const event of text.take(decoder.decode(part.value, { stream: true }))) this.take(event);
                this.catchUp();
            }
        } catch (error) {
            if (!hasPlace && (await this.hasDoneWithout())) return false;
            if (error instanceof ApiError) {
                this.refused(error);
                return false;
            }
            // Without the id of an event, the server cannot tell what was missed.
            this.isBehind = this.isBehind || this.last === '';
            this.app.server.take(false);
        } finally {
            window.clearTimeout(timer);
            this.places.leave();
        }
        return true;
    }

    private connected(wasCutOff: boolean): void {
        // Requests got no answer while the server was cut off. Lists that are older than the first stream may lack
        // grids that came in between.
        this.isBehind = this.isBehind || wasCutOff || (this.last === '' && this.app.hasLists);
        void this.begun.then(() => this.askSilences()).catch(() => undefined);
    }
    // Asks which stations are silent, because events report only later changes.
    private async askSilences(): Promise<void> {
        const { silent, names, serverMs } = await silences();
        this.app.server.names = new Map(names);
        this.app.server.take(true, serverMs);
        this.app.server.takeSilences(silent);
    }
    // Asks for all lists. They tell the same news as the stream, but later. Throws a TypeError if the list of silent
    // stations does not come within mostQuietMs. Does not wait for pictures, which may take longer.
    private async doWithout(): Promise<void> {
        await Promise.race([this.askSilences(), pause(mostQuietMs).then(noAnswer)]);
        if (this.isCatchingUp) return;
        this.isCatchingUp = true;
        this.do(() => this.app.news.catchUp().finally(() => (this.isCatchingUp = false)));
    }

    private async hasDoneWithout(): Promise<boolean> {
        try {
            await this.doWithout();
            return true;
        } catch (error) {
            if (error instanceof ApiError) this.refused(error);
            return error instanceof ApiError;
        }
    }

    // Shows an error that the server answered.
    private refused(error: ApiError): void {
        this.app.server.take(true);
        this.app.fail(error);
    }

    private do(act: () => Promise<void>): void {
        void this.begun.then(act).catch((error: unknown) => {
            this.isBehind = true;
            this.app.fail(error);
        });
    }
    private catchUp(): void {
        if (!this.isBehind && !this.app.server.isBehind) return;
        this.isBehind = this.app.server.isBehind = false;
        this.do(async () => {
            await this.app.news.catchUp();
            await this.askSilences();
        });
    }
    private take({ kind, id, data }: ServerEvent): void {
        if (id !== '') this.last = id;
        if (kind === '') return;
        const { domain, moment, grid, station, silent_s, oldest } = JSON.parse(data) as News;
        if (kind === 'reset') this.isBehind = true;
        else if (kind === 'station_silent') this.app.server.takeSilence(station ?? '', silent_s ?? 0);
        else if (kind === 'station_spoke') this.app.server.takeSilence(station ?? '', null);
        else if (kindsOfGrids.includes(kind)) this.do(() => this.app.news.takeNews(domain, moment, grid, oldest ?? ''));
        else if (kind !== 'volume_begun') this.app.fail(new Error(`${kind}: no such event`));
    }
}
