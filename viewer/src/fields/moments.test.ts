import assert from 'node:assert/strict';
import test from 'node:test';

import { mixingOf } from './status_rule';
import { usualLayers, veilsFolded } from '../scene/layers';
import { isMoment, momentFacts } from '../wire/moments';
import { usual } from '../testing/made_tables';

test('a moment that the page does not know is an error', () => {
    for (const name of ['XXX', 'ref', 'constructor', '__proto__']) {
        assert.equal(isMoment(name), false);
        assert.throws(() => momentFacts(name), new RegExp(`${name}: no such moment`));
        assert.throws(() => mixingOf(name), /no such moment/);
        assert.throws(() => veilsFolded(usualLayers, name), /no such moment/);
        assert.throws(() => usual.of(name, 0), /no opacity is known/);
    }
    assert.equal(momentFacts('RHO').unit, '1');
    assert.equal(mixingOf('VEL'), 'heaviest');
});
