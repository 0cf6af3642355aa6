// Checks that everybody can use the page: names of controls, keys, contrast, small and large windows, units.
import axe from 'axe-core';

import { expect, test as base } from './fixtures.mjs';

// Contrast of WCAG 2.1 AA.
const leastContrast = 4.5;
const controls = new Set(['button', 'combobox', 'slider', 'textbox', 'spinbutton', 'checkbox', 'radio', 'link', 'ColorWell', 'listbox', 'menuitem', 'searchbox', 'tab']);
// The panels: id of the button that opens a panel, and id of the panel.
const panels = [
  ['open', 'settings'],
  ['layers-open', 'layers'],
  ['edit-colors', 'editor'],
  ['scan-open', 'scan'],
];
const derived = ['derived', 'derived-list']; // opens over other panels, and closes at the next press
// Sizes of windows, and the least size of texts in each, in pixels.
const sizes = [[360, 640, 13], [800, 600, 13], [1920, 1080, 14], [3840, 2160, 24]];

const test = base.extend({
  viewport: { width: 800, height: 600 },
  contextOptions: { reducedMotion: 'reduce' },
  // The page with a picture from far away, which is drawn quickly.
  near: async ({ viewer, server: { station } }, use) => {
    await viewer.open(`domain=${station}&moment=REF&zoom=0.3&least=30`);
    await use(viewer);
  },
  // The map of the stations.
  map: async ({ page, near }, use) => {
    await near.press('to-map');
    await expect(near.byId('start')).toBeVisible();
    await expect(page.locator('#found button').first()).toBeVisible();
    await use(near);
  },
});

async function open(viewer, [opener, panel]) {
  const isShown = (id) => viewer.page.evaluate((id) => document.getElementById(id)?.checkVisibility() ?? false, id);
  if (await isShown(panel)) return;
  // Open the settings first, which have the button of the editor.
  if (panel === 'editor' && !(await isShown('settings'))) await open(viewer, panels[0]);
  await viewer.press(opener);
  if (panel === 'scan') await expect(viewer.byId('scan').locator('tbody tr').first()).toBeVisible();
  await viewer.until((id) => document.getElementById(id)?.checkVisibility(), panel);
  if (panel === derived[1]) return;
  await viewer.byId(derived[1]).evaluate((list) => (list.hidden = true));
  for (const [, other] of panels) if (other !== panel) expect(await isShown(other), `${panel} is open alone, without ${other}`).toBe(false);
}

// Checks that each control has a name for screen readers. Returns the number of controls.
async function expectNames(viewer) {
  const { nodes } = await (await viewer.protocol()).send('Accessibility.getFullAXTree');
  const all = nodes.filter(({ ignored, role }) => !ignored && controls.has(role?.value));
  const nameless = all.filter(({ name }) => !name?.value?.trim()).map(({ role }) => role.value);
  expect(nameless, 'controls without a name').toEqual([]);
  return all.length;
}

// Returns the five lowest contrasts between texts and their background, over a black and over a white picture. Runs in
// the page.
function contrasts() {
  const linear = (c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const rgba = (text) => {
    const n = text.match(/[\d.]+/g).map(Number);
    return [n[0], n[1], n[2], n[3] ?? 1];
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((c, k) => a * c + (1 - a) * below[k]);
  const isText = (node) => [...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim()) || ['INPUT', 'SELECT'].includes(node.tagName);
  const isLeftOut = (node) => node.tagName === 'OPTION' || !node.checkVisibility() || node.matches(':disabled') || ['range', 'checkbox', 'color'].includes(node.type);
  const worst = [];
  const start = document.getElementById('start');
  for (const node of start?.checkVisibility() ? start.querySelectorAll('*') : document.querySelectorAll('main *')) {
    if (!isText(node) || isLeftOut(node)) continue;
    const layers = [];
    for (let at = node; at; at = at.parentElement) layers.unshift(rgba(getComputedStyle(at).backgroundColor));
    for (const picture of [[0, 0, 0], [255, 255, 255]]) {
      // Leave out the backgrounds of html, body and main, which are behind the picture.
      const back = layers.slice(3).reduce((below, layer) => over(layer, below), picture);
      const color = rgba(getComputedStyle(node, node.placeholder ? '::placeholder' : null).color);
      const [a, b] = [luminance(over(color, back)), luminance(back)].sort((x, y) => y - x);
      worst.push([(a + 0.05) / (b + 0.05), node.id || node.className || node.tagName, node.textContent.trim().slice(0, 20)]);
    }
  }
  return worst.sort((x, y) => x[0] - y[0]).slice(0, 5).map(([ratio, ...name]) => [Math.round(ratio * 100) / 100, ...name]);
}
async function expectContrast(viewer) {
  const worst = await viewer.page.evaluate(contrasts);
  expect(worst[0][0], JSON.stringify(worst)).toBeGreaterThanOrEqual(leastContrast);
}

// Returns texts about elements that are beyond the window, cut off, or covered by another panel. Runs in the page.
function misplaced() {
  const bad = [];
  const box = (node) => node.getBoundingClientRect();
  const shown = (node) => node && node.checkVisibility() && box(node).width > 0;
  // Check only the map of the stations if it is open, because it covers all panels.
  const start = document.getElementById('start');
  const root = shown(start) ? start : document.querySelector('main');
  for (const node of root.querySelectorAll('button, select, input, p, output')) {
    if (!shown(node)) continue;
    const { left, right } = box(node);
    if (left < -0.5 || right > innerWidth + 0.5) bad.push(`beyond the window: ${node.id || node.textContent}`);
    if (node.tagName === 'BUTTON' && node.scrollWidth > node.clientWidth + 1) bad.push(`cut: ${node.textContent}`);
  }
  const panels = [...root.querySelectorAll('header, footer, section, #places, #start-head, #start-card')].filter(shown);
  for (const one of panels) {
    const a = box(one);
    if (a.top < -0.5 || a.bottom > innerHeight + 0.5) bad.push(`beyond the window: ${one.id || one.tagName}`);
    for (const other of panels) {
      const b = box(other);
      const isApart = a.left >= b.right - 1 || b.left >= a.right - 1 || a.top >= b.bottom - 1 || b.top >= a.bottom - 1;
      if (one !== other && !one.contains(other) && !isApart) bad.push(`${one.id} covers ${other.id}`);
    }
  }
  if (document.documentElement.scrollWidth > innerWidth) bad.push('the page scrolls sideways');
  return bad;
}
// Waits until the panels are in place, because a panel makes room for the head one frame after the head has changed.
const expectInPlace = (viewer, what) => expect.poll(() => viewer.page.evaluate(misplaced), `${what}: what is not in its place`).toEqual([]);

// Returns what axe-core finds, which is the rule and the first elements of each finding.
async function findings(viewer) {
  await viewer.page.evaluate(axe.source);
  return viewer.page.evaluate(async () => {
    const { violations } = await window.axe.run(document, { rules: { 'target-size': { enabled: true } }, resultTypes: ['violations'] });
    return violations.map(({ id, nodes }) => [id, ...nodes.slice(0, 4).map(({ html, any }) => `${html.slice(0, 120)} ${any[0]?.message ?? ''}`)]);
  });
}

for (const [width, height] of [[390, 844], [1440, 900]])
  test(`axe-core finds nothing at ${width} x ${height}`, async ({ page, near: viewer }) => {
    await viewer.resize(width, height);
    const found = {};
    const look = async (what) => {
      const some = await findings(viewer);
      if (some.length > 0) found[what] = some;
    };
    await look('view');
    for (const panel of panels) {
      await open(viewer, panel);
      await look(panel[1]);
    }
    await viewer.key('Escape');
    await viewer.byId('picture').focus();
    await viewer.key('?');
    await expect(viewer.byId('reading').locator('.keys')).toBeVisible();
    await look('keys');
    await viewer.key('Escape');
    await viewer.press('mode-2d');
    await viewer.until(() => document.getElementById('tilts')?.checkVisibility());
    await look('2D');
    await viewer.press('to-map');
    await expect(page.locator('#found button').first()).toBeVisible();
    await look('map');
    expect(found).toEqual({});
  });

test('each control has a name, and texts have contrast', async ({ near: viewer }) => {
  for (const panel of [...panels, derived]) {
    await open(viewer, panel);
    expect(await expectNames(viewer), `controls with ${panel[1]}`).toBeGreaterThan(12);
    await expectContrast(viewer);
  }
});

test('everything is in its place in small and large windows', async ({ near: viewer }) => {
  // Show a tiny grid, because large pictures take long and this test is about panels.
  await viewer.turnTo(viewer.page.url().split('#')[1].replace(/zoom=[^&]*/, 'zoom=0.01&ground=0'));
  for (const [width, height, least] of sizes) {
    await viewer.resize(width, height);
    for (const panel of [...panels, derived]) {
      await open(viewer, panel);
      await expectInPlace(viewer, `${width} x ${height} with ${panel[1]}`);
      await viewer.keep(`access-${width}-${panel[1]}`);
    }
    const size = await viewer.byId('title').evaluate((title) => parseFloat(getComputedStyle(title).fontSize));
    expect(size, `pixels of texts at ${width} x ${height}`).toBeGreaterThanOrEqual(least);
  }
});

test('the map of the stations has names, contrast and everything in its place', async ({ map: viewer }) => {
  expect(await expectNames(viewer), 'controls').toBeGreaterThan(3);
  await expectContrast(viewer);
  // Leave out 3840 x 2160, which takes very long to paint without a graphics processor.
  for (const [width, height] of sizes.slice(0, 3)) {
    await viewer.resize(width, height);
    await expectInPlace(viewer, `${width} x ${height}`);
    await viewer.keep(`access-${width}-map`);
  }
  await viewer.resize(800, 600);
  await viewer.press('start-back');
  await expect(viewer.byId('start')).toBeHidden();
});

test('Tab reaches every control in the order of the page, and leaves the page again', async ({ page, near: viewer }) => {
  await open(viewer, panels[0]);
  await viewer.byId('picture').focus();
  const visited = [];
  const unmarked = [];
  for (let i = 0; i < 80; ++i) {
    const [id, outline] = await page.evaluate(() => {
      const at = document.activeElement;
      return [at.id || at.tagName, getComputedStyle(at).outlineStyle];
    });
    if (i > 0 && id === 'picture') break;
    visited.push(id);
    if (id !== 'BODY' && outline === 'none') unmarked.push(id);
    await viewer.key('Tab');
  }
  const wanted = await page.locator('main button, main select, main input').evaluateAll((all) =>
    all.filter((one) => one.checkVisibility() && !one.disabled && one.tabIndex >= 0).map((one) => one.id),
  );
  expect(visited.length, 'number of controls that Tab reaches').toBeLessThan(80);
  expect(wanted.filter((id) => !visited.includes(id)), 'controls that Tab does not reach').toEqual([]);
  expect(unmarked, 'controls without a mark while they have the focus').toEqual([]);
  expect(visited.filter((id) => wanted.includes(id)), 'the order in which Tab reaches the controls').toEqual(wanted);
});

test('keys work in the picture at first, and Escape closes a panel and returns the focus', async ({ page, near: viewer }) => {
  expect(await page.evaluate(() => matchMedia('(prefers-reduced-motion: reduce)').matches)).toBe(true);
  expect(await page.evaluate(() => document.getAnimations().length), 'number of animations').toBe(0);
  await page.evaluate(() => document.activeElement.blur());
  await viewer.changes('before anything has the keyboard, T looks from above', 'tilt', () => viewer.key('t'), (_, after) => after === 0);
  await open(viewer, panels[0]);
  await viewer.byId('colors').focus();
  for (const key of ['Tab', 'Escape']) await viewer.key(key);
  await expect(viewer.byId('open')).toBeFocused();
  await expect(viewer.byId('settings')).toBeHidden();
});

test('chosen units are shown and remembered', async ({ viewer, server: { station } }) => {
  await viewer.open(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=0.5&field-of-view=0&least=75`);
  await open(viewer, panels[0]);
  for (const [id, value] of [['units-height', 'kft'], ['units-distance', 'miles'], ['units-speed', 'knots']]) {
    await viewer.settled(() => viewer.give(id, value));
  }
  expect(await viewer.told('units')).toBe('knots,miles,kft');
  await viewer.press('open');
  await viewer.click([370, 280]);
  const reading = viewer.byId('reading');
  await expect(reading).toContainText(/\d kft/);
  await expect(reading).not.toContainText(/ km\b/);
  await viewer.open(`domain=${station}&moment=REF&zoom=0.3&least=75`);
  await expect(viewer.byId('units-height'), 'the browser remembers the units').toHaveValue('kft');
});
