// Checks the readings of the pointer: the pixel has the color of the value that the page tells.
import { expect, report, test as base } from './fixtures.mjs';
import { image } from './pixels.mjs';

const [width, height] = [700, 440];
const seen = [40, 44, 50]; // clear air, over which colors are blended (renderer/shades.ts)

// Returns the text beside the pointer. Runs in the page.
const readingOf = () => {
  const hover = document.getElementById('hover');
  return !hover.hidden && [...hover.querySelectorAll('p')].map((one) => one.textContent).join('; ');
};

const test = base.extend({
  viewport: { width, height },
  // The last station from above, without its volume.
  flat: async ({ server }, use) => {
    await use(`domain=${server.other}&moment=REF&volume=0&ground=0&azimuth=180&tilt=0&field-of-view=0&exaggeration=1&zoom=3`);
  },
  // Returns the color of a value, blended over clear air.
  colors: async ({ server }, use) => {
    const { tables, usual } = await server.json('tables');
    const { stops, range_folded: folded } = tables.find(({ name }) => name === usual.REF);
    const of = (value) => {
      let i = stops.length - 1;
      while (i > 0 && value < stops[i].from) --i;
      if (i === stops.length - 1 || value < stops[0].from) return stops[i].color;
      const share = (value - stops[i].from) / (stops[i + 1].from - stops[i].from);
      return stops[i].color.map((c, k) => c + share * (stops[i].until[k] - c));
    };
    await use({ of, folded });
  },
});

// Moves the pointer away and then to a place, and returns its reading there.
async function under(viewer, place) {
  await viewer.hover([2, height - 2]);
  await viewer.byId('hover').evaluate((one) => void (one.hidden = true));
  await viewer.hover(place);
  return viewer.until(readingOf);
}
// Yields places of the picture that are not below the page's controls.
function* places() {
  for (let x = 130; x < width - 110; x += 37) for (let y = 170; y < height - 110; y += 31) yield [x, y];
}
const isBright = (picture, place) => Math.max(...picture.at(...place)) >= 100; // neither clear nor not seen

test.describe('the pointer', { tag: '@full' }, () => {
  // 2026-11-28: the page said "echo that is not shown" over 58 dBZ.
  for (const [layer, words, pattern] of [
    ['elevation=0.5', 'a sweep', /^(-?[\d.]+) dBZ at [\d.]+ km; tilt 0\.\d°, beam [\d.]+ km wide, [\d.]+ km at \d+° from [A-Z]{4}; seen at \d\d:\d\d:\d\d UTC$/],
    ['height-km=3', 'a plane', /^(-?[\d.]+) dBZ at 3\.0 km; on the plane/],
    ['maximum=1', 'the column maximum', /^(-?[\d.]+) dBZ at [\d.]+ km; maximum of the column/],
  ]) {
    test(`reads ${words}`, async ({ viewer, flat, colors }) => {
      await viewer.open(`${flat}&${layer}`);
      const picture = image(await viewer.pixels());
      let [read, right] = [0, 0];
      for (const place of places()) {
        if (read === 12 || !isBright(picture, place)) continue;
        ++read;
        const told = await under(viewer, place);
        const color = told.startsWith('range folded') ? colors.folded : colors.of(Number(told.match(pattern)?.[1]));
        const pixel = picture.at(...place);
        const apart = Math.max(...pixel.map((c, k) => Math.abs(seen[k] + (color[3] / 255) * (color[k] - seen[k]) - c)));
        // Count differences, because a place at the edge of a gate or cell may be read from the next gate or cell.
        if (apart <= 12) ++right;
        else report(`at ${place} is ${pixel}, and it says ${told}`);
      }
      report(`${right} of ${read} readings of ${words} have the color of the pixel`);
      expect(read, 'readings').toBeGreaterThanOrEqual(6);
      expect(right, 'readings that have the color of the pixel').toBeGreaterThanOrEqual(0.8 * read);
      await viewer.keep(`readout-${layer.split('=')[0]}`);
    });
  }

  // 2026-11-28: the old reading stayed when another layer was turned on.
  test('reads another layer where it rests', async ({ viewer, flat }) => {
    await viewer.open(`${flat}&height-km=3`);
    const picture = image(await viewer.pixels());
    const place = [...places()].find((one) => isBright(picture, one));
    expect(await under(viewer, place)).toContain('on the plane');
    await viewer.key('c');
    await viewer.key('m');
    await expect(viewer.byId('hover')).toContainText('maximum of the column');
    await expect(viewer.byId('hover')).toBeVisible();
  });

  // 2026-11-28: over the core of a storm, the pointer read 6.5 dBZ of the anvil, which is invisible.
  test('reads the most visible cell of the volume', async ({ viewer, server: { other: station } }) => {
    await viewer.open(`domain=${station}&moment=REF&ground=0&tilt=60&zoom=3`);
    const picture = image(await viewer.pixels());
    let core = { score: -Infinity };
    for (let x = 120; x < width - 110; x += 2) {
      for (let y = 110; y < height - 110; y += 2) {
        const [red, green, blue] = picture.at(x, y);
        const score = red - green - blue;
        if (score > core.score) core = { x, y, score };
      }
    }
    const told = await under(viewer, [core.x, core.y]);
    expect(parseFloat(told), `over the reddest pixel the pointer reads ${told}`).toBeGreaterThanOrEqual(40);
    await viewer.click([core.x, core.y]);
    const reading = viewer.byId('reading');
    await expect(reading).toContainText('Maximum');
    const text = await reading.innerText();
    const [first, most] = [/(-?[\d.]+) dBZ at/, /Maximum (-?[\d.]+) dBZ/].map((pattern) => Number(text.match(pattern)?.[1]));
    expect(first, 'a click reads the same').toBe(parseFloat(told));
    expect(most, 'the maximum of the column').toBeGreaterThanOrEqual(first);
    const marked = await viewer.byId('labels').evaluate((labels, { x, y }) => {
      const { data } = labels.getContext('2d').getImageData(x - 4, y - 4, 9, 9);
      let white = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i] > 230 && data[i + 1] > 230 && data[i + 2] > 230) ++white;
      return white;
    }, core);
    expect(marked, 'white pixels at the place').toBeGreaterThan(10);
    await viewer.keep('readout-volume');
  });

  test('says that it is beyond the grid', async ({ viewer, server: { other: station } }) => {
    await viewer.open(`domain=${station}&moment=REF&tilt=0&field-of-view=0&zoom=0.4`);
    expect(await under(viewer, [150, 220])).toMatch(/^Outside the grid; \d+(\.\d+)? km at \d+° from [A-Z]{4}$/);
  });
});
