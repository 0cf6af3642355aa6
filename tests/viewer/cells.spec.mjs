// Checks the storm cells: their tracks over the picture, and their table.
import { expect, test } from './fixtures.mjs';

test.use({ viewport: { width: 1000, height: 700 } });

test('cells are in a table that sorts, and a row leads to its cell', async ({ viewer, server: { other: station, address } }) => {
  const { features } = await (await fetch(`${address}/api/v1/cells?area=${station}`)).json();
  const found = features.filter(({ geometry }) => geometry.type === 'Point');
  await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=0.5&field-of-view=0`);
  const pixels = () => viewer.page.evaluate(() => {
    const canvas = document.getElementById('labels');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return data.filter((alpha, i) => i % 4 === 3 && alpha > 0).length;
  });
  const before = await pixels();
  await viewer.key('y');
  const rows = viewer.byId('cells').locator('tbody tr');
  await expect(rows.first()).toBeVisible();
  await viewer.drawn();
  expect(found.length, 'cells of the server').toBeGreaterThanOrEqual(await rows.count());
  await expect.poll(pixels, { message: 'pixels of tracks and letters' }).not.toBe(before);
  // A column sorts, the other way round at the second press.
  const column = async (index) => (await rows.locator(`td:nth-child(${index})`).allTextContents()).map(Number).filter((value) => !Number.isNaN(value));
  const rising = (values) => [...values].sort((a, b) => a - b);
  expect(await column(1), 'the strongest first').toEqual(rising(await column(1)).reverse());
  await viewer.byId('cells').getByRole('button', { name: 'VIL' }).click();
  expect(await column(3)).toEqual(rising(await column(3)).reverse());
  await viewer.byId('cells').getByRole('button', { name: 'VIL' }).click();
  expect(await column(3)).toEqual(rising(await column(3)));
  await expect(viewer.byId('cells').locator('th').nth(2)).toHaveAttribute('aria-sort', 'ascending');
  await viewer.keep('cells');
  // A click, or Enter, looks at the cell.
  await viewer.settled(() => rows.first().click());
  const first = await viewer.told('look-at-km');
  expect(first).not.toBeNull();
  await rows.last().focus();
  await viewer.settled(() => viewer.key('Enter'));
  expect(await viewer.told('look-at-km')).not.toBe(first);
});
