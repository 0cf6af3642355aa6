// Checks the list of the cuts of a scan.
import { expect, test } from './fixtures.mjs';

const near = (station) => `domain=${station}&moment=REF&zoom=0.3&least=30`;

for (const [width, height] of [[390, 800], [560, 420], [1000, 700], [1440, 900]])
  test(`the cuts of the scan are listed at ${width} x ${height}`, async ({ viewer, server }) => {
    const { station } = server;
    await viewer.resize(width, height);
    await viewer.open(near(station));
    const { path } = await server.grid(station);
    const { sweeps } = await server.json(`stations/${station}/volumes/${path.split('/').pop()}/sweeps`);
    await viewer.byId('scan-open').click();
    const scan = viewer.byId('scan');
    await expect(scan.locator('tbody tr')).toHaveCount(sweeps.length);
    await expect(scan).toContainText(`complete, ${sweeps.length} cuts`);
    const first = scan.locator('tbody tr').first();
    await expect(first).toContainText(`${sweeps[0].elevation_deg.toFixed(1)}°`);
    await expect(first).toContainText(sweeps[0].start.slice(11, 19));
    await expect(first).toContainText(`${Number(sweeps[0].nyquist_mps.toFixed(1))} m/s`);
    await expect(first).toContainText('REF');
    // Words for the waveforms, with the abbreviations as tooltips.
    expect(sweeps[0].waveform, 'the first cut sees far').toBe('CS');
    await expect(first.locator('td').nth(1)).toHaveText('surveillance');
    await expect(first.locator('td').nth(1)).toHaveAttribute('title', /\(CS\)/);
    const words = await scan.locator('tbody td:nth-child(2)').allTextContents();
    expect(words.every((word) => /^(surveillance|Doppler|Doppler only|batch|staggered)$/.test(word)), words.join()).toBe(true);
    await expect(first, 'only measured moments').not.toContainText('RATE');
    const box = await scan.boundingBox();
    const head = await viewer.byId('head').boundingBox();
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(width);
    expect(box.x >= head.x + head.width || box.y >= head.y + head.height, 'the list is beside or below the head').toBe(true);
    await viewer.keep(`scan-${width}`);
    // Other panels and Escape close the list.
    await viewer.byId('layers-open').click();
    await expect(scan).toBeHidden();
    await viewer.byId('scan-open').click();
    await expect(viewer.byId('layers')).toBeHidden();
    await viewer.key('Escape');
    await expect(scan).toBeHidden();
  });

test('a scan in progress tells how far it is', async ({ page, viewer, server: { station } }) => {
  await page.route(/volumes\?to=/, async (route) => {
    const response = await route.fetch();
    const { volumes } = await response.json();
    const one = volumes.at(-1);
    await route.fulfill({ response, json: { volumes: [{ ...one, sweeps: 2 * one.sweeps }, { ...one, complete: false }] } });
  });
  const last = { end: '' };
  await page.route(/\/sweeps$/, async (route) => {
    const response = await route.fetch();
    const { sweeps } = await response.json();
    last.end = new Date().toISOString();
    sweeps.at(-1).end = last.end;
    last.count = sweeps.length;
    await route.fulfill({ response, json: { sweeps } });
  });
  await viewer.open(near(station));
  await viewer.byId('scan-open').click();
  const scan = viewer.byId('scan');
  await expect(scan).toContainText(/scan in progress: (\d+) of \d+ cuts, up to [\d.]+°/);
  expect(await scan.locator('progress').evaluate((one) => one.value)).toBeCloseTo(0.5, 5);
});
