import assert from 'node:assert/strict';
import test from 'node:test';

import { Turns } from './turns';

// Turns whose frames and pictures the test controls.
class Made {
    pictures = 0;
    private frame: (() => void) | null = null;
    private end: (() => void) | null = null;
    readonly turns: Turns = new Turns(
        () => {
            ++this.pictures;
            return new Promise((done) => (this.end = done));
        },
        (act) => (this.frame = act),
    );
    begin(isFine = false): void {
        const act = this.frame;
        this.frame = null;
        act?.();
        this.turns.isFine = isFine;
    }
    async finish(): Promise<void> {
        this.end?.();
        await new Promise((done) => setTimeout(done));
    }
}

test('a picture that is asked for while another is drawn follows it', async () => {
    const made = new Made();
    made.turns.ask();
    made.turns.ask();
    made.begin();
    assert.equal(made.pictures, 1);
    assert(!made.turns.isOutdated);
    made.turns.ask();
    assert(made.turns.isOutdated);
    await made.finish();
    made.begin();
    assert.equal(made.pictures, 2);
    await made.finish();
    assert(!made.turns.isBusy);
});

test('only a fine picture is given up', async () => {
    const made = new Made();
    const acts: string[] = [];
    made.turns.replace(() => acts.push('nothing is drawn'));
    made.turns.ask();
    made.begin();
    assert(!made.turns.stop());
    made.turns.replace(() => acts.push('replaced'));
    made.turns.replace(() => acts.push('after the picture'));
    assert.deepEqual(acts, ['nothing is drawn']);
    await made.finish();
    assert.deepEqual(acts, ['nothing is drawn', 'after the picture']);
    made.turns.ask();
    made.begin(true);
    made.turns.replace(() => acts.push('at once'));
    assert.equal(acts.length, 3);
    assert(made.turns.isStopped);
});
