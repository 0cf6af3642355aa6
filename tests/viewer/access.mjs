// Checks that everybody can use the page: names of controls, keys, contrast, small and large windows, and units
// (scripts/check-viewer).
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { CheckedPage, check } from './checked_page.mjs';
import { Browser } from './devtools.mjs';

const [address, station, pictures] = process.argv.slice(2);
// Contrast of WCAG 2.1 AA.
const leastContrast = 4.5;
const controls = new Set(['button', 'combobox', 'slider', 'textbox', 'spinbutton', 'checkbox', 'radio', 'link', 'ColorWell', 'listbox', 'menuitem', 'searchbox', 'tab']);

const browser = await Browser.start();
const page = await browser.page(800, 600);
const viewer = new CheckedPage(page, address);
const evaluate = (text) => page.evaluate(text);
await page.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-reduced-motion', value: 'reduce' }] });
// From far away pictures take little time.
await viewer.open(`domain=${station}&moment=REF&zoom=0.3&least=30`);

// The panels, each as it is opened by a button, and what it is.
const panels = [
  ['open', 'settings'],
  ['layers-open', 'layers'],
  ['edit-colors', 'editor'],
];
async function open([opener, panel]) {
  if (await evaluate(`document.getElementById('${panel}')?.checkVisibility()`)) return;
  // The button of the editor is in the settings.
  if (panel === 'editor' && !(await evaluate("document.getElementById('settings').checkVisibility()"))) await open(panels[0]);
  await evaluate(`document.getElementById('${opener}').click()`);
  await page.until(`document.getElementById('${panel}').checkVisibility()`);
  const others = panels.map(([, id]) => id).filter((id) => id !== panel);
  check(`${panel} is open alone`, await evaluate(`${JSON.stringify(others)}.every((id) => !document.getElementById(id)?.checkVisibility())`));
}

// ---- Names
await page.send('Accessibility.enable');
async function nameless() {
  const { nodes } = await page.send('Accessibility.getFullAXTree');
  const found = nodes.filter(({ ignored, role, name }) => !ignored && controls.has(role?.value) && !name?.value?.trim());
  const count = nodes.filter(({ ignored, role }) => !ignored && controls.has(role?.value)).length;
  return { found: found.map(({ role }) => role.value), count };
}
for (const panel of panels) {
  await open(panel);
  const { found, count } = await nameless();
  check(`with ${panel[1]} each of ${count} controls has a name`, found.length === 0 && count > 12, found.join(' '));
}

// ---- Contrast of texts with what is behind them, where that is the darkest and the lightest that a picture has
const contrasts = `(() => {
  const linear = (c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const rgba = (text) => { const n = text.match(/[\\d.]+/g).map(Number); return [n[0], n[1], n[2], n[3] ?? 1]; };
  const over = ([r, g, b, a], below) => [r, g, b].map((c, k) => a * c + (1 - a) * below[k]);
  const worst = [];
  const start = document.getElementById('start');
  const nodes = start?.checkVisibility() ? start.querySelectorAll('*') : document.querySelectorAll('main *');
  for (const node of nodes) {
    const isText = [...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim()) || ['INPUT', 'SELECT'].includes(node.tagName);
    if (!isText || node.tagName === 'OPTION' || !node.checkVisibility() || node.matches(':disabled') || node.type === 'range' || node.type === 'checkbox' || node.type === 'color') continue;
    const layers = [];
    for (let at = node; at; at = at.parentElement) layers.unshift(rgba(getComputedStyle(at).backgroundColor));
    for (const picture of [[0, 0, 0], [255, 255, 255]]) {
      // The page's own ground is behind the picture.
      const back = layers.slice(3).reduce((below, layer) => over(layer, below), picture);
      const [a, b] = [luminance(over(rgba(getComputedStyle(node, node.placeholder ? '::placeholder' : null).color), back)), luminance(back)].sort((x, y) => y - x);
      worst.push([(a + 0.05) / (b + 0.05), node.id || node.className || node.tagName, node.textContent.trim().slice(0, 20)]);
    }
  }
  return worst.sort((x, y) => x[0] - y[0]).slice(0, 5).map(([ratio, ...name]) => [Math.round(ratio * 100) / 100, ...name]);
})()`;
for (const panel of panels) {
  await open(panel);
  const worst = await evaluate(contrasts);
  check(`with ${panel[1]} texts have a contrast of ${worst[0][0]} or more`, worst[0][0] >= leastContrast, JSON.stringify(worst));
}

// ---- Sizes: what is shown lies in the window, texts are not cut, panels do not cover each other
const layout = `(() => {
  const bad = [];
  const box = (node) => node.getBoundingClientRect();
  const shown = (node) => node && node.checkVisibility() && box(node).width > 0;
  // The map of the stations lies over all others.
  const start = document.getElementById('start');
  const root = shown(start) ? start : document.querySelector('main');
  for (const node of root.querySelectorAll('button, select, input, p, output')) {
    if (!shown(node)) continue;
    const { left, right } = box(node);
    if (left < -0.5 || right > innerWidth + 0.5) bad.push('beyond the window: ' + (node.id || node.textContent));
    if (node.tagName === 'BUTTON' && node.scrollWidth > node.clientWidth + 1) bad.push('cut: ' + node.textContent);
  }
  const panels = [...root.querySelectorAll('header, footer, section, #places, #start-head, #start-card')].filter(shown);
  for (const one of panels) {
    const a = box(one);
    if (a.top < -0.5 || a.bottom > innerHeight + 0.5) bad.push('beyond the window: ' + (one.id || one.tagName));
    for (const other of panels) {
      const b = box(other);
      if (one !== other && !one.contains(other) && a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1) bad.push(one.id + ' covers ' + other.id);
    }
  }
  if (document.documentElement.scrollWidth > innerWidth) bad.push('the page scrolls sideways');
  return bad;
})()`;
// Returns what stays misplaced. A panel makes room for the head one frame after its text has changed.
const misplaced = async () => {
  let bad = await evaluate(layout);
  for (let turn = 0; turn < 50 && bad.length > 0; ++turn) {
    await new Promise((done) => setTimeout(done, 100));
    bad = await evaluate(layout);
  }
  return bad;
};
const sizes = [[360, 640, 13], [800, 600, 13], [1920, 1080, 14], [3840, 2160, 24]];
const textSize = () => evaluate("parseFloat(getComputedStyle(document.getElementById('title')).fontSize)");
if (pictures) mkdirSync(pictures, { recursive: true });
for (const [width, height, least] of sizes) {
  // Large pictures take long: what is looked at here are panels.
  await evaluate(`location.hash = location.hash.replace(/zoom=[^&]*/, 'zoom=0.01&ground=0'); undefined`);
  await page.resize(width, height);
  for (const panel of panels) {
    await open(panel);
    const bad = await misplaced();
    check(`${width} x ${height} with ${panel[1]}: everything is in its place`, bad.length === 0, bad.join('; '));
    if (pictures) writeFileSync(join(pictures, `access-${width}-${panel[1]}.png`), await page.screenshot());
  }
  check(`texts are ${await textSize()} pixels at ${width} x ${height}`, (await textSize()) >= least);
}
await viewer.settled(() => page.resize(800, 600));

// ---- The map of the stations
await evaluate("document.getElementById('to-map').click()");
await page.until("document.getElementById('start').checkVisibility() && document.querySelector('#found button')");
const onMap = await nameless();
check(`on the map each of ${onMap.count} controls has a name`, onMap.found.length === 0 && onMap.count > 3, onMap.found.join(' '));
const worst = await evaluate(contrasts);
check(`on the map texts have a contrast of ${worst[0][0]} or more`, worst[0][0] >= leastContrast, JSON.stringify(worst));
// Painting it at 3840 x 2160 takes very long without a graphics processor.
for (const [width, height] of sizes.slice(0, 3)) {
  await page.resize(width, height);
  const bad = await misplaced();
  check(`the map at ${width} x ${height}: everything is in its place`, bad.length === 0, bad.join('; '));
  if (pictures) writeFileSync(join(pictures, `access-${width}-map.png`), await page.screenshot());
}
await page.resize(800, 600);
await evaluate("document.getElementById('start-back').click()");
await page.until("!document.getElementById('start').checkVisibility()");

// ---- Keys: Tab comes to every control that is shown, and leaves it again
await open(panels[0]);
await evaluate("document.activeElement.blur(); document.getElementById('picture').focus()");
const order = [];
for (let i = 0; i < 80; ++i) {
  const at = await evaluate("(document.activeElement.id || document.activeElement.tagName) + '|' + (getComputedStyle(document.activeElement).outlineStyle)");
  if (i > 0 && at.startsWith('picture|')) break;
  order.push(at);
  await page.key('Tab', { windowsVirtualKeyCode: 9 });
}
const visited = order.map((at) => at.split('|')[0]);
const wanted = await evaluate(`[...document.querySelectorAll('main button, main select, main input')].filter((one) => one.checkVisibility() && !one.disabled && one.tabIndex >= 0).map((one) => one.id)`);
const missed = wanted.filter((id) => !visited.includes(id));
check(`Tab comes to ${visited.length} controls`, missed.length === 0 && visited.length < 80, `but not to ${missed.join(', ')}`);
check('what has the keyboard is marked', order.every((at) => at.startsWith('BODY') || !at.endsWith('|none')), order.filter((at) => at.endsWith('|none')).join(' '));
const sorted = wanted.filter((id) => visited.includes(id));
check('the order is that of the page', sorted.every((id, i) => i === 0 || visited.indexOf(id) > visited.indexOf(sorted[i - 1])), visited.join(' '));

await evaluate("document.getElementById('open').focus()");
await page.key('Tab', { windowsVirtualKeyCode: 9 });
await page.key('Tab', { windowsVirtualKeyCode: 9 });
await page.key('Escape', { windowsVirtualKeyCode: 27 });
check('Escape closes a panel and leads back', await evaluate("document.activeElement.id === 'open' && document.getElementById('settings').hidden"));

await evaluate("document.activeElement.blur()");
await viewer.changes('before anything has the keyboard, keys are for the picture', 'tilt', () => page.key('t'), (_, after) => after === 0);

// ---- Motion
check('nothing moves by itself', await evaluate("document.getAnimations().length === 0 && matchMedia('(prefers-reduced-motion: reduce)').matches"));

// ---- Units
const settled = (id, value) =>
  viewer.settled(() => evaluate(`(() => { const select = document.getElementById('${id}'); select.value = '${value}'; select.dispatchEvent(new Event('change')); })()`));
await viewer.show(`domain=${station}&moment=REF&azimuth=180&tilt=0&zoom=0.5&field-of-view=0&least=75`);
await open(panels[0]);
for (const [id, value] of [['units-height', 'kft'], ['units-distance', 'miles'], ['units-speed', 'knots']]) await settled(id, value);
check(`the address holds the units: ${await viewer.told('units')}`, (await viewer.told('units')) === 'knots,miles,kft');
await evaluate("document.getElementById('open').click()");
const [x, y] = [400, 300];
await page.drag([x - 30, y - 20], [0, 0]);
const reading = await page.until("document.getElementById('reading').innerText", 5);
check(`heights are read in thousands of feet: ${reading.split('\n').find((line) => line.includes('kft'))}`, /\d kft/.test(reading) && !/ km\b/.test(reading));
await viewer.open(`domain=${station}&moment=REF&zoom=0.3&least=75`);
check('the browser remembers the units', (await evaluate("document.getElementById('units-height').value")) === 'kft');
check('nothing of the page failed', page.trouble.length === 0, page.trouble.join('\n'));
await browser.end();
