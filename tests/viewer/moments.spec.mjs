// Checks the choice of moments: buttons of measured moments, and the list of derived ones.
import { expect, test } from './fixtures.mjs';

const sizes = [[390, 800], [560, 420], [1000, 700], [1440, 900], [3840, 2160]];

test('mouse and keys choose derived moments from a list that names them', async ({ viewer, server: { station } }) => {
  await viewer.resize(1000, 700);
  await viewer.open(`domain=${station}&moment=REF&least=70`);
  const [open, list] = [viewer.byId('derived'), viewer.byId('derived-list')];
  await expect(viewer.byId('moments')).not.toContainText('KDP');
  await expect(viewer.byId('moments')).toContainText('Dealiased');
  await expect(list).toBeHidden();
  await open.click();
  await expect(list).toContainText('KDPSpecific differential phase');
  await viewer.settled(() => viewer.byId('moment-KDP').click());
  await expect(list).toBeHidden();
  await expect(viewer.byId('title')).toContainText('Specific differential phase');
  await expect(open).toHaveText(/^KDP/);
  await expect(open).toHaveAttribute('aria-pressed', 'true');
  // Choose by keys, too.
  await open.focus();
  await viewer.key('Enter');
  await viewer.key('Tab');
  await expect(list.locator('button').first()).toBeFocused();
  await viewer.key('Escape');
  await expect(list).toBeHidden();
  await expect(open).toBeFocused();
  await viewer.key('Enter');
  await viewer.click([700, 500]);
  await expect(list, 'a press elsewhere closes the list').toBeHidden();
});

for (const [width, height] of sizes)
  test(`the head leaves room for the picture at ${width} x ${height}`, async ({ viewer, server: { station } }) => {
    await viewer.resize(width, height);
    await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=2&field-of-view=0&least=70`);
    await viewer.settled(() => viewer.key('x'));
    const [head, plot] = await viewer.page.evaluate(() =>
      ['head', 'section-plot'].map((id) => document.getElementById(id).getBoundingClientRect().toJSON()),
    );
    expect(head.bottom, 'the head ends above the plot of the section').toBeLessThanOrEqual(plot.top);
    expect(head.height, 'height of the head').toBeLessThan(0.45 * height);
    await viewer.byId('derived').click();
    const list = await viewer.byId('derived-list').boundingBox();
    expect(list.x).toBeGreaterThanOrEqual(0);
    expect(list.x + list.width).toBeLessThanOrEqual(width);
    expect(list.y + list.height).toBeLessThanOrEqual(height);
    await viewer.keep(`moments-${width}`);
  });
