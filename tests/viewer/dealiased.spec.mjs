// Checks the dealiased velocity on hurricane Harvey: one click leads from VEL to VELD, readings tell velocity and
// ambiguous gates, and a page without grids of VELD still shows dealiased sweeps.
import { expect, report, test as base } from './fixtures.mjs';

const [width, height] = [900, 700];
const middle = [width / 2, height / 2];
const around = 2; // gates and radials to each side of a chosen gate that have the wanted content, too

// Reads the azimuths and gates of a packed sweep (docs/web/packed-grid.md).
function sweepOf(bytes) {
  const view = new DataView(bytes);
  const u32 = (at) => view.getUint32(at, true);
  const f32 = (at) => view.getFloat32(at, true);
  const big = (at) => Number(view.getBigUint64(at, true));
  const [radials, stride, codeBytes, first] = [u32(72), u32(76), u32(88), u32(92)];
  const code = (radial, gate) => {
    const at = big(112) + (radial * stride + gate) * codeBytes;
    return codeBytes === 1 ? view.getUint8(at) : view.getUint16(at, true);
  };
  return {
    radials,
    azimuthDeg: (radial) => f32(big(104) + 32 * radial + 8),
    gates: (radial) => u32(big(104) + 32 * radial + 24),
    rangeKm: (gate) => (view.getInt32(80, true) + gate * view.getInt32(84, true)) / 1000,
    code,
    // The value of a gate; NaN without one.
    value: (radial, gate) => (code(radial, gate) < first ? NaN : (code(radial, gate) - f32(100)) / f32(96)),
  };
}

const test = base.extend({
  viewport: { width, height },
  sweeps: async ({ server }, use) => {
    const { volumes } = await server.json(`stations/${server.station}/volumes`);
    const path = `stations/${server.station}/volumes/${volumes.at(-1).time}/sweeps`;
    const { sweeps } = await server.json(path);
    const { sweep } = sweeps.find(({ moments }) => moments.some(({ moment, chosen }) => moment === 'VELD' && chosen));
    const gates = async (moment) => {
      const answer = await fetch(`${server.address}/api/v1/${path}/${sweep}/${moment}`);
      return sweepOf(await answer.arrayBuffer());
    };
    await use({ measured: await gates('VEL'), dealiased: await gates('VELD') });
  },
  above: ({ server }, use) =>
    use(`domain=${server.station}&volume=0&elevation=0.5&azimuth=180&tilt=0&field-of-view=0&exaggeration=1&zoom=12`),
});

// Returns the view that has a gate in the middle of the picture. The gate and its neighbors satisfy `holds`.
function viewOf(sweep, [leastKm, mostKm], [leastDeg, mostDeg], holds) {
  for (let radial = around; radial < sweep.radials - around; ++radial) {
    const azimuth = sweep.azimuthDeg(radial);
    if (azimuth < leastDeg || azimuth > mostDeg) continue;
    for (let gate = around; gate < sweep.gates(radial) - around; ++gate) {
      const km = sweep.rangeKm(gate);
      if (km < leastKm || km > mostKm) continue;
      let isThere = true;
      for (let i = -around; i <= around; ++i)
        for (let k = -around; k <= around; ++k) isThere &&= holds(radial + i, gate + k);
      const [east, north] = [Math.sin, Math.cos].map((of) => km * of((azimuth * Math.PI) / 180));
      if (isThere) return { view: `look-at-km=${east.toFixed(3)},${north.toFixed(3)},0`, radial, gate };
    }
  }
  throw new Error('no such gate');
}

async function read(viewer) {
  await viewer.hover([2, height - 2]);
  await viewer.byId('hover').evaluate((one) => void (one.hidden = true));
  await viewer.hover(middle);
  const reading = () => {
    const hover = document.getElementById('hover');
    return !hover.hidden && [...hover.querySelectorAll('p')].map((one) => one.textContent).join('; ');
  };
  return viewer.until(reading);
}
const speedIn = (reading) => Number(/^(-?[\d.]+) m\/s/.exec(reading)?.[1]);

// Returns a view of the eyewall to the north-east of the radar. Air moves away so fast there that the measured velocity
// is folded to the other sign.
const eyewall = ({ measured, dealiased }) =>
  viewOf(dealiased, [25, 80], [40, 95], (r, g) => dealiased.value(r, g) >= 42 && measured.value(r, g) < -5);

test('one click unfolds the velocity, and another click folds it again', async ({ viewer, sweeps, above }) => {
  const { view, radial, gate } = eyewall(sweeps);
  await viewer.open(`${above}&moment=VEL&${view}`);
  await viewer.keep('dealiased-before');
  await expect(viewer.byId('title')).toContainText('Radial velocity');
  const before = await read(viewer);
  await viewer.settled(() => viewer.page.getByRole('button', { name: 'Dealiased', exact: true }).click());
  await expect(viewer.byId('title')).toContainText('Dealiased velocity');
  await expect(viewer.byId('legend')).toContainText('ambiguous');
  await viewer.keep('dealiased-after');
  const after = await read(viewer);
  report(`VEL ${before}, VELD ${after}`);
  expect(speedIn(before)).toBeLessThan(0);
  expect(speedIn(after)).toBeGreaterThanOrEqual(40);
  expect(speedIn(before)).toBeCloseTo(sweeps.measured.value(radial, gate), 1);
  expect(speedIn(after)).toBeCloseTo(sweeps.dealiased.value(radial, gate), 1);
  await viewer.catchCopies();
  expect(await viewer.copiedBy('command')).toMatch(/^stormcellar frame KCRP --moment VELD .*--product ppi /);
  await viewer.settled(() => viewer.press('moment-VEL'));
  await expect(viewer.byId('title')).toContainText('Radial velocity');
  expect(await read(viewer)).toBe(before);
});

test('an ambiguous gate is hatched in the color of range folded, and reads as ambiguous', async ({ viewer, server, sweeps, above }) => {
  const { dealiased } = sweeps;
  const { view } = viewOf(dealiased, [100, 300], [0, 360], (r, g) => dealiased.code(r, g) === 2);
  await viewer.open(`${above}&moment=VELD&${view}`);
  await viewer.keep('dealiased-ambiguous');
  expect(await read(viewer)).toMatch(/^ambiguous at [\d.]+ km; echo whose velocity cannot be dealiased/);
  const { tables, usual } = await server.json('tables');
  const folded = tables.find(({ name }) => name === usual.VELD).range_folded;
  const bytes = await viewer.pixels(width, height);
  const head = bytes.length - 3 * width * height;
  // The hatch has a line at every ninth pixel of a row.
  const line = [...bytes.subarray(head + 3 * (middle[1] * width + middle[0] - 5), head + 3 * (middle[1] * width + middle[0] + 5))];
  const isFolded = (i) => folded.slice(0, 3).every((one, c) => Math.abs(line[3 * i + c] - one) < 3);
  const lines = [...Array(9).keys()].filter(isFolded);
  expect(lines.length, `pixels ${line}`).toBe(1);
});

test.describe('a server without grids of VELD', () => {
  test.beforeEach(({ page }) =>
    page.route(/\/api\/v1\/domains/, async (route) => {
      const answer = await route.fetch();
      const { domains } = await answer.json();
      for (const domain of domains) domain.moments = domain.moments.filter(({ moment }) => moment !== 'VELD');
      await route.fulfill({ response: answer, json: { domains } });
    }),
  );

  test('tells why the dealiased velocity is not there, and has dealiased sweeps', async ({ viewer, sweeps, above }) => {
    const { view } = eyewall(sweeps);
    await viewer.open(`${above}&moment=VEL&${view}`);
    const choice = viewer.byId('moment-VELD');
    await expect(choice).toHaveAttribute('aria-disabled', 'true');
    await expect(choice).toHaveAttribute('title', /no grids of Dealiased velocity/);
    await choice.click({ force: true });
    await expect(viewer.byId('state')).toContainText('no grids of Dealiased velocity');
    await expect(viewer.byId('title')).toContainText('Radial velocity');
    const before = await read(viewer);
    await viewer.settled(() => viewer.press('sweep-dealiased'));
    await expect(viewer.byId('layers-told')).toContainText('dealiased');
    await expect(viewer.byId('title')).toContainText('Dealiased velocity');
    await expect(viewer.byId('legend')).toContainText('ambiguous');
    const after = await read(viewer);
    expect(speedIn(before)).toBeLessThan(0);
    expect(speedIn(after)).toBeGreaterThanOrEqual(40);
    await viewer.catchCopies();
    expect(await viewer.copiedBy('command')).toMatch(/^stormcellar frame KCRP --moment VELD .*--product ppi /);
  });
});
