// Sends requests to the thread that decodes grids (worker.ts), and returns a promise of each answer.

import { Answers, Numbered, WorkerAnswer, WorkerRequest } from './worker';

interface Waiting {
    done(answer: unknown): void;
    failed(error: Error): void;
}

export class Decoder {
    private worker = new Worker('worker.js');
    private waiting = new Map<number, Waiting>();
    private count = 0;

    constructor() {
        this.worker.onmessage = (event: MessageEvent<Numbered<WorkerAnswer & { error?: string }>>) => {
            const { number, error } = event.data;
            const waiting = this.waiting.get(number);
            this.waiting.delete(number);
            if (error === undefined) waiting?.done(event.data);
            else waiting?.failed(new Error(error));
        };
    }

    // Sends a request to the worker. The bytes of the request move to the worker, so the caller cannot use them
    // afterwards.
    ask<Kind extends WorkerRequest['kind']>(request: WorkerRequest & { kind: Kind }): Promise<Answers[Kind]> {
        const number = ++this.count;
        return new Promise<Answers[Kind]>((done, failed) => {
            this.waiting.set(number, { done: done as (answer: unknown) => void, failed });
            this.worker.postMessage({ number, ...request }, 'bytes' in request ? [request.bytes] : []);
        });
    }
}
