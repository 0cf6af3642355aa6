// Checks what the page draws in Firefox, which has a renderer of its own.
import { expect, expectLikeSlicer, test } from './fixtures.mjs';
import { shadesOf } from './pixels.mjs';
import { viewOf } from './slicer.mjs';

test.use({ viewport: { width: 400, height: 266 } });

test('the first picture in Firefox', async ({ page, viewer, server: { station } }) => {
  await viewer.open(`domain=${station}`);
  expect(shadesOf(await viewer.pixels()).size, 'colors').toBeGreaterThan(200);
  await expect(page).toHaveTitle(new RegExp(station));
});

for (const field of [0, 40]) {
  test(`the volume in Firefox, field of view ${field}`, async ({ viewer, server: { station, slicer } }) => {
    const scene = { station, moment: 'REF', azimuth: 180, tilt: 55, zoom: 2, field, exaggeration: 3, opacity: 1, at: [0, 0, 4] };
    await viewer.open(viewOf(scene));
    expectLikeSlicer(`Firefox, field of view ${field}`, await slicer.compare(scene, await viewer.pixels(), { name: `firefox-${field}` }));
  });
}
