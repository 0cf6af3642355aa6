// Checks that clear air has its own colors, also for a grid in parts.
import { expect, report, test } from './fixtures.mjs';
import { shadesOf } from './pixels.mjs';

test.use({ viewport: { width: 560, height: 420 } });

// 2026-11-28: with little memory, clear air was drawn with the colors of storms, which made it invisible.
for (const [memory, isInParts] of [[256, false], [8, true]]) {
  test(`clear air is drawn in its colors with ${memory} MiB`, async ({ viewer, server: { station } }) => {
    await viewer.open(`domain=${station}&moment=REF&memory=${memory}&volume=0&maximum=1`);
    await viewer.catchCopies();
    const command = await viewer.copiedBy('command');
    report(`${memory} MiB: ${command}`);
    expect(command).toContain('--colors smooth-clear-air');
    expect(viewer.asked('half=') > 0, 'the grid came in parts').toBe(isInParts);
    expect(shadesOf(await viewer.pixels()).size, 'colors').toBeGreaterThan(100);
  });
}
