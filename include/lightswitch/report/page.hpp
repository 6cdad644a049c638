#pragma once

// The files in page/, which make a report's page. Written by page/embed.cmake: edit those and run
//   cmake -P include/lightswitch/report/page/embed.cmake

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch::detail {

inline constexpr const char* page_head_html = R"page(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="lightswitch">
<meta http-equiv="Content-Security-Policy"
      content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:">
<link rel="icon" href="data:,">
)page";

inline constexpr const char* page_style_css = R"page(:root {
  color-scheme: light dark;
  --paper: #f6f7f8; --panel: #ffffff; --ink: #1b2127; --muted: #596470; --line: #d8dde2; --accent: #0a5fbd;
  --accent-soft: #e3eefb; --stage: #dfe3e7; --s0: #0a5fbd; --s1: #c8501e; --s2: #14795a; --s3: #8b3fb0; --s4: #9a6b00;
  --s5: #c02a63; --s6: #267f99; --s7: #5f6670;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #121518; --panel: #1b1f24; --ink: #e4e8ec; --muted: #9ba6b1; --line: #343b43; --accent: #74b4ff;
    --accent-soft: #20344c; --stage: #0b0d0f; --s0: #74b4ff; --s1: #ff9a66; --s2: #55cfa4; --s3: #d09bf2; --s4: #e2bb55;
    --s5: #ff86b0; --s6: #62c6e2; --s7: #aab2bb;
  }
}
* { box-sizing: border-box; }
[hidden] { display: none !important; }
body {
  margin: 0 auto; padding: 20px 24px 48px; max-width: 1600px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans",
  sans-serif;
}
h1 { margin: 0 0 8px; font-size: 22px; line-height: 1.25; font-weight: 650; overflow-wrap: anywhere; }
.summary { border-left: 3px solid var(--accent); padding: 1px 0 1px 14px; margin: 0 0 16px; max-width: 90ch; }
.summary p { margin: 4px 0; white-space: pre-line; overflow-wrap: anywhere; }
section { margin: 0 0 24px; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }

.bar { display: flex; flex-wrap: wrap; gap: 8px 18px; align-items: center; margin: 0 0 8px; }
.bar > span, .bar > label, .segments { display: inline-flex; align-items: center; gap: 6px; min-width: 0; }
.bar .name { color: var(--muted); white-space: nowrap; }
button, select, input[type="number"] {
  font: inherit; font-size: 14px; color: var(--ink); background: var(--panel); border: 1px solid var(--line);
  border-radius: 6px; height: 32px; padding: 0 10px;
}
select { max-width: 240px; min-width: 0; text-overflow: ellipsis; padding: 0 6px; }
button:hover, select:hover { border-color: var(--muted); }
button { min-width: 32px; cursor: pointer; }
input[type="number"] { width: 104px; font-variant-numeric: tabular-nums; }
input[type="range"] { width: 150px; accent-color: var(--accent); margin: 0; }
input[type="checkbox"] { accent-color: var(--accent); width: 16px; height: 16px; margin: 0; }
input:disabled + span { opacity: 0.5; }
output { font-variant-numeric: tabular-nums; min-width: 4.2em; text-align: right; }
.segments {
  border: 1px solid var(--line); border-radius: 7px; padding: 2px; margin: 0; background: var(--panel); gap: 2px;
}
.segments label { position: relative; }
.segments input { position: absolute; inset: 0; opacity: 0; margin: 0; cursor: pointer; }
.segments label span { display: block; padding: 2px 13px; border-radius: 5px; font-size: 14px; font-weight: 500; }
.segments input:checked + span { background: var(--accent-soft); color: var(--accent); }
.segments input:focus-visible + span { outline: 2px solid var(--accent); outline-offset: 1px; }

.stage { display: grid; grid-template-columns: minmax(0, 1fr) 360px; gap: 16px; align-items: start; }
.panes {
  height: clamp(320px, calc(100vh - 290px), 900px); display: grid; gap: 4px; background: var(--line); overflow: hidden;
  border: 1px solid var(--line); border-radius: 6px; touch-action: none; user-select: none; -webkit-user-select: none;
}
.pane {
  position: relative; min-width: 0; min-height: 0; overflow: hidden; background: var(--stage); cursor: crosshair;
}
.pane canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.tag {
  position: absolute; top: 6px; left: 6px; max-width: calc(50% - 12px); padding: 1px 8px; border-radius: 4px;
  font-size: 13px;
  background: rgb(20 24 28 / 78%); color: #fff; overflow: hidden; text-overflow: ellipsis; white-space: nowrap;
  pointer-events: none;
}
.tag.right { left: auto; right: 6px; }
.tag.whole { max-width: calc(100% - 12px); }
.divider { position: absolute; top: 0; bottom: 0; width: 25px; margin-left: -12px; cursor: ew-resize; }
.divider::before {
  content: ""; position: absolute; top: 0; bottom: 0; left: 11px; width: 3px; background: #fff;
  box-shadow: 0 0 0 1px rgb(0 0 0 / 55%);
}
.divider::after {
  content: "\2194"; position: absolute; top: calc(50% - 14px); left: -1px; width: 28px; height: 28px;
  border-radius: 50%;
  background: #fff; color: #1b2127; text-align: center; font: 16px/27px sans-serif;
  box-shadow: 0 0 0 1px rgb(0 0 0 / 55%);
}
.divider:focus-visible { outline: none; }
.divider:focus-visible::after { box-shadow: 0 0 0 3px var(--accent); }
.side { display: grid; gap: 12px; min-width: 0; }
.panel.legend { max-width: 480px; padding: 12px 40px; font-size: 13px; font-variant-numeric: tabular-nums; }
.legend .ramp { height: 14px; border: 1px solid var(--line); border-radius: 3px; }
.legend .ticks { position: relative; height: 20px; }
.legend .ticks span { position: absolute; transform: translateX(-50%); white-space: nowrap; }
.legend .what { color: var(--muted); text-align: center; }
.panel {
  background: var(--panel); border: 1px solid var(--line); border-radius: 6px; padding: 12px 14px; min-width: 0;
}
.panel table { table-layout: fixed; width: 100%; font-size: 13px; }
.panel td, .panel th { padding: 3px 0 3px 6px; }
.panel td:first-child, .panel th:first-child { padding-left: 0; overflow-wrap: anywhere; }
.panel col.value { width: 76px; }
.used { color: var(--accent); font-size: 12px; margin-left: 5px; }
.panel .number { white-space: nowrap; }
.hint { color: var(--muted); font-size: 13px; margin: 8px 0 0; }
kbd {
  font: 12px/1.4 ui-monospace, "DejaVu Sans Mono", monospace; border: 1px solid var(--line); border-radius: 4px;
  padding: 0 4px; background: var(--panel); color: var(--ink);
}

.scroll { overflow-x: auto; margin: 0 0 20px; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-size: 16px; font-weight: 650; padding: 0 0 6px; }
.panel caption { font-size: 14px; }
th, td { text-align: left; padding: 5px 22px 5px 0; border-bottom: 1px solid var(--line); vertical-align: baseline; }
th { color: var(--muted); font-weight: 600; }
th[scope="row"] { color: var(--ink); font-weight: 400; }
.number { text-align: right; }
#tables td:first-child { white-space: nowrap; }

#charts {
  display: grid; grid-template-columns: repeat(auto-fit, minmax(min(420px, 100%), 1fr)); gap: 16px; align-items: start;
}
figure { margin: 0; }
figcaption { font-weight: 650; margin-bottom: 4px; }
.keys { display: flex; flex-wrap: wrap; gap: 2px 16px; margin: 0 0 4px; padding: 0; list-style: none; font-size: 13px; }
.keys li { display: inline-flex; align-items: center; gap: 6px; }
svg { display: block; max-width: 100%; overflow: visible; }
svg text { fill: var(--muted); font-size: 12px; }
svg .axis { stroke: var(--muted); fill: none; }
svg .grid { stroke: var(--line); }
svg .curve { fill: none; stroke-width: 2; stroke-linejoin: round; }
svg .band { stroke: none; opacity: .22; }
svg .ideal { fill: none; stroke-width: 1.25; stroke-dasharray: 5 4; opacity: .8; }
svg .level { stroke: var(--muted); stroke-width: 1.5; stroke-dasharray: 2 3; }
svg .bin { fill: var(--s0); }
svg .expected { stroke: var(--s1); stroke-width: 2; stroke-dasharray: 6 4; }
.error { border: 1px solid var(--s1); border-radius: 6px; padding: 10px 14px; background: var(--panel); }

@media (max-width: 980px) {
  .stage { grid-template-columns: minmax(0, 1fr); }
  .panes { height: clamp(280px, 60vh, 900px); }
}
@media (max-width: 560px) {
  body { padding: 14px 14px 32px; }
  h1 { font-size: 20px; }
  .bar { gap: 8px 12px; }
  .segments { width: 100%; }
  .segments label { flex: 1; text-align: center; }
  .segments label span { padding: 4px 2px; }
  .bar > .choice { width: 100%; }
  .bar > .choice select { flex: 1; max-width: none; }
}
@media print { .bar, .hint, .divider { display: none; } }
)page";

inline constexpr const char* page_viewer_html = R"page(<section id="viewer" aria-label="Images">
<div class="bar">
  <div class="segments" role="radiogroup" aria-label="View">
    <label><input type="radio" name="mode" value="slider" checked><span>Slider</span></label>
    <label><input type="radio" name="mode" value="flip"><span>Flip</span></label>
    <label><input type="radio" name="mode" value="grid"><span>Grid</span></label>
    <label><input type="radio" name="mode" value="map"><span>Map</span></label>
  </div>
  <label class="choice"><span class="name">A</span><select id="a" aria-label="Image A"></select></label>
  <label class="choice"><span class="name">B</span><select id="b" aria-label="Image B"></select></label>
  <button type="button" id="swap" title="Swap A and B" aria-label="Swap A and B">&#8644;</button>
</div>
<div class="bar">
  <span><label class="name" for="exposure">Exposure</label>
    <input type="range" id="exposure" min="-12" max="12" step="0.25" value="0">
    <output id="stops" for="exposure">0 EV</output>
    <button type="button" id="no-exposure" aria-label="Exposure back to 0">0</button></span>
  <span><span class="name">Zoom</span>
    <button type="button" id="zoom-out" aria-label="Zoom out">&#8722;</button>
    <button type="button" id="zoom-in" aria-label="Zoom in">+</button>
    <button type="button" id="zoom-one" title="One image pixel to one pixel of the page">1:1</button>
    <button type="button" id="zoom-fit" title="The whole image">Fit</button>
    <output id="percent">100 %</output></span>
</div>
<div class="bar" id="map-bar" hidden>
  <label class="choice"><span class="name">Map</span><select id="map"></select></label>
  <span><label class="name" for="scale">Scale</label>
    <input type="number" id="scale" min="0" step="any">
    <button type="button" id="scale-half" aria-label="Halve the scale">&#247;2</button>
    <button type="button" id="scale-double" aria-label="Double the scale">&#215;2</button>
    <button type="button" id="scale-auto" title="As it was chosen at first">Auto</button></span>
  <label><input type="checkbox" id="black"><span>Black at zero</span></label>
</div>
<div class="stage">
  <div class="panes" id="panes" tabindex="0" role="group" aria-describedby="hint"
       aria-label="Images: arrow keys move them"></div>
  <div class="side">
  <div class="panel legend" id="legend" hidden></div>
  <div class="panel">
    <table id="values">
      <caption id="where">Point at a pixel</caption>
      <colgroup><col><col class="value"><col class="value"><col class="value"></colgroup>
      <thead><tr><th scope="col">Linear</th><th scope="col" class="number">R</th>
        <th scope="col" class="number">G</th><th scope="col" class="number">B</th></tr></thead>
      <tbody></tbody>
    </table>
    <p class="hint" id="hint">Drag to move, wheel or pinch to zoom. <kbd>1</kbd>&#8211;<kbd>9</kbd> choose image A, with
      <kbd>Shift</kbd> B. <kbd>Space</kbd> or a click flips.
      <kbd>S</kbd> <kbd>F</kbd> <kbd>G</kbd> <kbd>M</kbd> change the view, <kbd>[</kbd> <kbd>]</kbd> the exposure,
      <kbd>+</kbd> <kbd>&#8722;</kbd> <kbd>0</kbd> the zoom.</p>
    <p class="hint" id="digits"></p>
  </div>
  </div>
</div>
</section>
)page";

inline constexpr const char* page_facts_html = R"page(<div class="scroll" id="facts" tabindex="0"
     role="region" aria-label="About the images" hidden></div>
)page";

inline constexpr const char* page_pixels_js = R"page(const byId = id => document.getElementById(id);
const report = JSON.parse(byId('report').textContent);

function element(tag, attributes, ...children) {
  const result = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) result.setAttribute(name, value);
  result.append(...children);
  return result;
}

function complain(what) {
  document.querySelector('main').prepend(element('p', {class: 'error', role: 'alert'}, String(what)));
}
addEventListener('error', event => complain('This page does not work here: ' + event.message));
addEventListener('unhandledrejection', event => complain('This page does not work here: ' + event.reason));

async function inflate(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes the encoding of pixels: one Uint32Array of the bits of 32-bit floats per channel.
async function readPixels(index, count, channels) {
  const lines = byId('pixels-' + index).textContent.trim().split('\n');
  const [first, second, rest] = await Promise.all(lines.map(inflate));
  const low = report.bits - 16, mask = 2 ** report.bits - 1, planes = [];
  for (let c = 0; c < channels; ++c) {
    const words = new Uint32Array(count);
    for (let p = 0, i = c * count; p < count; ++p, ++i) {
      const tail = low === 8 ? rest[i] : rest[i >> 1] >> 4 * (i & 1) & 15;
      const value = (first[i] << 8 | second[i]) << low | tail;
      words[p] = c === 0 ? value : value + planes[0][p] & mask;
    }
    planes.push(words);
  }
  for (const words of planes) for (let p = 0; p < count; ++p) words[p] <<= 32 - report.bits;
  return channels === 1 ? planes : [planes[1], planes[0], planes[2]];
}

function format(x) {
  if (Number.isNaN(x)) return 'nan';
  if (!Number.isFinite(x)) return x > 0 ? 'inf' : '\u2212inf';
  const size = Math.abs(x);
  const plain = size === 0 || (size >= 1e-3 && size < 1e5);
  const text = size === 0 ? '0' : plain ? x.toPrecision(4) : x.toExponential(2).replace('e+', 'e');
  return text.replace('-', '\u2212').replace('e-', 'e\u2212');
}
const short = x => format(Number(x.toPrecision(3))).replace(/(\.\d*?)0+(?=e|$)/, '$1').replace(/\.(?=e|$)/, '');

const encode = linear => linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;

// The sRGB value of every non-negative float by its leading 20 bits.
function exposureTable(stops) {
  const table = new Uint8ClampedArray(1 << 19), words = new Uint32Array(1), value = new Float32Array(words.buffer);
  for (let i = 0, scale = 2 ** stops; i < table.length; ++i) {
    words[0] = (i << 12) + 2048;
    const linear = value[0] * scale;
    table[i] = linear < 1e-4 ? 0 : linear >= 1 ? 255 : 255 * encode(linear);
  }
  return table;
}

const magenta = 0xffff00ff, notFinite = 0x7f800000;

function paintExposed(words, table, pixels) {
  const [red, green, blue] = words, level = w => w >>> 31 ? 0 : table[w >>> 12];
  for (let i = 0; i < pixels.length; ++i) {
    const r = red[i], g = green[i], b = blue[i];
    pixels[i] = (r & notFinite) === notFinite || (g & notFinite) === notFinite || (b & notFinite) === notFinite
        ? magenta : 0xff000000 | level(b) << 16 | level(g) << 8 | level(r);
  }
}

// Colour maps that are uniform to the eye (Oklab): diverging for t in [-1,1], sequential for t in [0,1].
function mapColor(t, signed, black) {
  const size = Math.abs(t);
  const [lightness, chroma, degrees] = signed
      ? [black ? 0.72 * size : 0.98 - 0.5 * size, 0.19 * size, t < 0 ? 262 : 27]
      : [0.22 + 0.7 * size, 0.1 + 0.07 * size * size, 310 - 205 * size];
  const a = chroma * Math.cos(degrees * Math.PI / 180), b = chroma * Math.sin(degrees * Math.PI / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3;
  return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s]
      .map(c => Math.round(255 * Math.min(1, Math.max(0, encode(c)))));
}

function paintMapped(values, scale, signed, black, pixels) {
  const steps = 1024, table = new Uint32Array(2 * steps + 1);
  for (let i = -steps; i <= steps; ++i) {
    const [r, g, b] = mapColor(i / steps, signed, black);
    table[i + steps] = 0xff000000 | b << 16 | g << 8 | r;
  }
  for (let i = 0; i < pixels.length; ++i) {
    const t = Math.min(1, Math.max(-1, values[i] / scale));
    pixels[i] = Number.isFinite(values[i]) ? table[Math.round((signed ? t : Math.abs(t)) * steps) + steps] : magenta;
  }
}

// The 99th percentile of the magnitudes that are finite, rounded up to a number whose half and quarters are round, too.
function chooseScale(values) {
  const sizes = values.filter(Number.isFinite).map(Math.abs).sort();
  const size = sizes[Math.ceil((sizes.length - 1) * 0.99)] || sizes[sizes.length - 1] || 1;
  const power = 10 ** Math.floor(Math.log10(size));
  return Number((power * [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find(digit => size <= digit * power)).toPrecision(2)) || size;
}
)page";

inline constexpr const char* page_charts_js = R"page((() => {
const box = byId('charts'), colors = 8;
const color = i => `var(--s${i % colors})`;

function svg(tag, attributes, ...children) {
  const result = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) result.setAttribute(name, value);
  result.append(...children);
  return result;
}

// Ticks of a logarithmic axis: powers of ten, and 2 and 5 between them on a short one.
function logTicks(from, to) {
  const decades = Math.log10(to / from), step = Math.max(1, Math.ceil(decades / 7)), ticks = [];
  for (let e = Math.floor(Math.log10(from)); e <= Math.log10(to); ++e)
    for (const digit of decades < 2.5 ? [1, 2, 5] : [1])
      if (e % step === 0) ticks.push(digit * 10 ** e);
  return ticks.filter(x => x >= from * 0.999 && x <= to * 1.001);
}
function tickText(x) {
  const e = Math.floor(Math.log10(x) + 1e-9), digit = Math.round(x / 10 ** e);
  if (e >= -3 && e <= 4) return String(Number(x.toPrecision(2)));
  const raised = '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079';
  const power = '10' + String(e).replace(/./g, c => c === '-' ? '\u207b' : raised[c]);
  return digit === 1 ? power : digit + '\u00b7' + power;
}

// The frame of a chart: x and y map values to places, ticks are given with their texts.
function frame(width, label, xTitle, yTitle, x, y, xTicks, yTicks) {
  const {left, right, top, bottom, height} = margins;
  const root = svg('svg', {width, height, viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label});
  for (const [at, text] of yTicks) {
    root.append(svg('line', {class: 'grid', x1: left, x2: width - right, y1: y(at), y2: y(at)}));
    root.append(svg('text', {x: left - 7, y: y(at) + 4, 'text-anchor': 'end'}, text));
  }
  for (const [at, text] of xTicks) {
    root.append(svg('line', {class: 'grid', x1: x(at), x2: x(at), y1: top, y2: height - bottom}));
    root.append(svg('text', {x: x(at), y: height - bottom + 17, 'text-anchor': 'middle'}, text));
  }
  root.append(svg('path', {class: 'axis', d: `M${left} ${top}V${height - bottom}H${width - right}`}));
  root.append(svg('text', {x: (left + width - right) / 2, y: height - 6, 'text-anchor': 'middle'}, xTitle));
  root.append(svg('text', {x: 0, y: 12}, yTitle));
  return root;
}
const margins = {left: 56, right: 14, top: 24, bottom: 44, height: 320};

function marker(i, x, y) {
  const d = [`M${x - 3} ${y}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0`, `M${x - 3} ${y - 3}h6v6h-6z`, `M${x} ${y - 4}l4 7h-8z`,
             `M${x} ${y - 4}l4 4l-4 4l-4 -4z`][i % 4];
  return svg('path', {d, fill: color(i)});
}

// What a kind of line stands for, and of curve `i`.
function lineKey(kind, text, style = {stroke: 'currentColor'}, ...more) {
  const sample = svg('svg', {width: 26, height: 12, 'aria-hidden': 'true'});
  sample.append(svg('line', {class: kind, x1: 0, x2: 26, y1: 6, y2: 6, ...style}), ...more);
  return element('li', {}, sample, text);
}
const key = (i, text) => lineKey('curve', text, {stroke: color(i)}, marker(i, 13, 6));

function errorChart(title, xTitle, column, width) {
  const curves = report.curves.map((curve, i) => ({
    i, name: curve.name,
    points: curve.points.map(p => [p[column], p[2], p[3], p[4]]).filter(p => p[0] > 0 && p[1] > 0)
        .sort((p, q) => p[0] - q[0]),
  })).filter(curve => curve.points.length);
  if (!curves.length) return null;
  const ideal = ([first], xEnd) => [first, [xEnd, first[1] * (first[0] / xEnd) ** report.power]];
  for (const curve of curves) curve.ideal = ideal(curve.points, curve.points[curve.points.length - 1][0]);
  const banded = curve => curve.points.filter(p => p[2] > 0 && p[3] > 0);
  const edges = curve => [...banded(curve).map(p => [p[0], p[2]]), ...banded(curve).reverse().map(p => [p[0], p[3]])];
  const all = curves.flatMap(curve => [...curve.points, ...curve.ideal, ...edges(curve)]);
  const level = report.noise > 0 ? [report.noise] : [];
  const range = values => [Math.min(...values) / 1.25, Math.max(...values) * 1.25];
  const [x0, x1] = range(all.map(p => p[0])), [y0, y1] = range([...all.map(p => p[1]), ...level]);
  const {left, right, top, bottom, height} = margins;
  const x = v => left + (width - left - right) * Math.log(v / x0) / Math.log(x1 / x0);
  const y = v => height - bottom - (height - top - bottom) * Math.log(v / y0) / Math.log(y1 / y0);
  const ticks = (from, to) => logTicks(from, to).map(v => [v, tickText(v)]);
  const root = frame(width, title, xTitle, report.errorName, x, y, ticks(x0, x1), ticks(y0, y1));
  const path = points => 'M' + points.map(p => `${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join('L');
  for (const v of level) root.append(svg('line', {class: 'level', x1: left, x2: width - right, y1: y(v), y2: y(v)}));
  for (const curve of curves)
    if (banded(curve).length > 1)
      root.append(svg('path', {class: 'band', fill: color(curve.i), d: path(edges(curve)) + 'Z'}));
  for (const curve of curves) root.append(svg('path', {class: 'ideal', stroke: color(curve.i), d: path(curve.ideal)}));
  for (const curve of curves) {
    root.append(svg('path', {class: 'curve', stroke: color(curve.i), d: path(curve.points)}));
    for (const p of curve.points) {
      const dot = marker(curve.i, x(p[0]), y(p[1]));
      const band = p[2] > 0 ? `, ${short(p[2])} to ${short(p[3])}` : '';
      dot.append(svg('title', {}, `${curve.name}: ${short(p[1])}${band} at ${short(p[0])}`));
      root.append(dot);
    }
  }
  const list = element('ul', {class: 'keys'}, ...curves.map(c => key(c.i, c.name)),
                       lineKey('ideal', report.power === 1 ? '1/N' : '1/\u221aN'),
                       ...level.map(v => lineKey('level', `noise of the reference: about ${short(v)}`)));
  return element('figure', {class: 'panel'}, element('figcaption', {}, title), list, root);
}

function histogramChart(histogram, width) {
  const {bins, total, name} = histogram, {left, right, top, bottom, height} = margins;
  const counted = bins.reduce((sum, n) => sum + n, 0), expected = counted / bins.length;
  const most = Math.max(...bins, expected, 1) * 1.1;
  const x = v => left + (width - left - right) * v, y = v => height - bottom - (height - top - bottom) * v / most;
  const power = 10 ** Math.floor(Math.log10(most / 2)), yTicks = [];
  const step = Math.max(1, [1, 2, 5].map(digit => digit * power).find(s => most / s <= 6) ?? 10 * power);
  for (let v = 0; v <= most; v += step) yTicks.push([v, String(v)]);
  const xTicks = [0, 0.2, 0.4, 0.6, 0.8, 1].map(v => [v, String(v)]);
  const root = frame(width, name, 'p-value', 'Count', x, y, xTicks, yTicks);
  bins.forEach((n, i) => {
    const from = x(i / bins.length) + 1, to = x((i + 1) / bins.length) - 1;
    const bar = svg('rect', {class: 'bin', x: from, y: y(n), width: to - from, height: y(0) - y(n)});
    bar.append(svg('title', {}, `${i / bins.length} to ${(i + 1) / bins.length}: ${n}`));
    root.append(bar);
  });
  root.append(svg('line', {class: 'expected', x1: left, x2: width - right, y1: y(expected), y2: y(expected)}));
  const others = total > counted ? `; ${total - counted} of ${total} are not in [0, 1] and not counted` : '';
  const list = element('ul', {class: 'keys'}, lineKey('expected', `expected: ${short(expected)} in each bin${others}`));
  return element('figure', {class: 'panel'}, element('figcaption', {}, name), list, root);
}

const charts = [
  w => errorChart('Error over time', 'Seconds', 0, w), w => errorChart('Error over samples', 'Samples per pixel', 1, w),
  ...report.histograms.map(histogram => w => histogramChart(histogram, w)),
];
let drawn = 0;
function draw() {
  const column = parseFloat(getComputedStyle(box).gridTemplateColumns) || box.clientWidth;
  const width = Math.floor(Math.min(column, 760)) - 30;  // less the panel's padding and border
  if (width === drawn || width < 100) return;
  drawn = width;
  box.replaceChildren(...charts.map(chart => chart(width)).filter(Boolean));
}
draw();
new ResizeObserver(draw).observe(box);
})();
)page";

inline constexpr const char* page_viewer_js = R"page((async () => {
const {images, maps} = report, {width, height} = images[0], letters = ['a', 'b'];
const other = report.reference === 0 ? 1 : 0, last = images.length - 1;
const view = {
  mode: 'slider', a: Math.min(other, last), b: report.reference ?? Math.min(1, last), front: 'a', split: 0.5,
  exposure: 0, zoom: 1, fits: true, x: width / 2, y: height / 2, map: 0, black: false, pixel: null,
};

// The pixels ---------------------------------------------------------------------------------------------------------

const floats = words => words.map(channel => new Float32Array(channel.buffer));
await Promise.all([...images, ...maps].map(async (item, i) => {
  item.words = await readPixels(i, item.width * item.height, i < images.length ? 3 : 1);
  item.values = floats(item.words);
}));

// Of each pixel the channel in which `measure` of A and B is largest, so that errors of opposite sign do not cancel.
function dominant(measure) {
  const a = images[view.a].values, b = images[view.b].values, result = new Float32Array(width * height);
  for (let i = 0; i < result.length; ++i) {
    let value = 0;
    for (let c = 0; c < 3; ++c) {
      const x = measure(a[c][i], b[c][i]);
      if (Number.isNaN(x) || Math.abs(x) > Math.abs(value)) value = x;
      if (Number.isNaN(x)) break;
    }
    result[i] = value;
  }
  return result;
}

const derived = [
  {name: 'A \u2212 B', signed: true, legend: 'A \u2212 B in the channel where it is largest', measure: (a, b) => a - b},
  {name: '|A \u2212 B|', signed: false, legend: '|A \u2212 B| in the channel where it is largest',
   measure: (a, b) => Math.abs(a - b)},
  {name: '(A \u2212 B) / B', signed: true, legend: '(A \u2212 B) / (|B| + 0.01) in the channel where it is largest',
   measure: (a, b) => (a - b) / (Math.abs(b) + 0.01)},
].map(map => ({...map, width, height, scale: 0}));
const allMaps = [...derived, ...maps.map(map => ({...map, values: map.values[0]}))];

function refreshMap(map) {
  const key = view.a + ':' + view.b;
  if (map.measure && map.key !== key) {
    map.values = dominant(map.measure);
    map.key = key;
    map.chosen = 0;
  }
  map.chosen ||= map.scale || chooseScale(map.values);
}
const scaleOf = map => map.own || map.chosen;

// Pictures: drawn anew only when what they depend on has changed -----------------------------------------------------

function picture(item, key, paint) {
  if (!item.canvas) {
    item.canvas = element('canvas', {width: item.width, height: item.height});
    item.context = item.canvas.getContext('2d');
    item.data = item.context.createImageData(item.width, item.height);
  }
  if (item.painted !== key) {
    paint(new Uint32Array(item.data.data.buffer));
    item.context.putImageData(item.data, 0, 0);
    item.painted = key;
  }
  return item.canvas;
}

let table = null, tableStops = NaN;
function imagePicture(image) {
  if (tableStops !== view.exposure) table = exposureTable(tableStops = view.exposure);
  return picture(image, view.exposure, pixels => paintExposed(image.words, table, pixels));
}
function mapPicture(map) {
  refreshMap(map);
  return picture(map, [map.key, scaleOf(map), view.black].join(), pixels =>
      paintMapped(map.values, scaleOf(map), map.signed, view.black, pixels));
}

// Panes --------------------------------------------------------------------------------------------------------------

const box = byId('panes');
let panes = [], divider = null;

function addPane(sources) {
  const canvas = element('canvas', {role: 'img'}), node = element('div', {class: 'pane'}, canvas);
  const kind = i => i ? 'tag right' : sources.length > 1 ? 'tag' : 'tag whole';
  const tags = sources.map((_, i) => element('span', {class: kind(i)}));
  node.append(...tags);
  box.append(node);
  panes.push({node, canvas, tags, sources, context: canvas.getContext('2d')});
  return node;
}

const imageSource = index => ({picture: () => imagePicture(images[index()]), name: () => images[index()].name});
const sourceA = imageSource(() => view.a), sourceB = imageSource(() => view.b);
const mapSource = {picture: () => mapPicture(allMaps[view.map]), name: () => allMaps[view.map].name};

function setMode(mode) {
  view.mode = mode;
  document.querySelector(`input[name="mode"][value="${mode}"]`).checked = true;
  box.replaceChildren();
  panes = [];
  divider = null;
  if (mode === 'slider') {
    divider = element('div', {class: 'divider', role: 'slider', tabindex: 0, 'aria-label': 'Border between A and B',
                              'aria-valuemin': 0, 'aria-valuemax': 100});
    addPane([sourceA, sourceB]).append(divider);
  } else if (mode === 'flip') {
    addPane([imageSource(() => view[view.front])]);
  } else if (mode === 'map') {
    addPane([mapSource]);
  } else {
    images.forEach((_, i) => addPane([imageSource(() => i)]));
    addPane([mapSource]);
  }
  box.style.gridTemplateColumns = `repeat(${columns()}, minmax(0, 1fr))`;
  update();
}

// As many columns as make the panes, and so the images, largest.
function columns() {
  let best = 1, largest = 0;
  for (let n = 1; n <= panes.length; ++n) {
    const rows = Math.ceil(panes.length / n);
    const size = Math.min(box.clientWidth / n / width, box.clientHeight / rows / height);
    if (size > largest * 1.001) [best, largest] = [n, size];
  }
  return best;
}

function fitZoom() {
  const {clientWidth, clientHeight} = panes[0].node;
  return Math.min(clientWidth / width, clientHeight / height) || 1;
}

function drawPane(pane) {
  const ratio = devicePixelRatio || 1;
  const w = Math.round(pane.node.clientWidth * ratio), h = Math.round(pane.node.clientHeight * ratio);
  if (pane.canvas.width !== w || pane.canvas.height !== h) Object.assign(pane.canvas, {width: w, height: h});
  const {context} = pane, zoom = view.zoom * ratio;
  const left = Math.round(w / 2 - view.x * zoom), top = Math.round(h / 2 - view.y * zoom);
  context.clearRect(0, 0, w, h);
  pane.sources.forEach((source, i) => {
    const image = source.picture(), from = i * Math.round(w * view.split);
    context.save();
    if (pane.sources.length > 1) {
      context.beginPath();
      context.rect(from, 0, i ? w - from : Math.round(w * view.split), h);
      context.clip();
    }
    context.imageSmoothingEnabled = zoom < 1 && image.width === width;
    context.drawImage(image, left, top, width * zoom, height * zoom);
    context.restore();
    pane.tags[i].textContent = source.name();
  });
  pane.canvas.setAttribute('aria-label', pane.sources.map(source => source.name()).join(' | '));
  if (view.pixel && zoom >= 2) {
    const [x, y] = [left + view.pixel[0] * zoom, top + view.pixel[1] * zoom];
    for (const [color, out] of [['#000', 1.5], ['#fff', 0.5]]) {
      context.strokeStyle = color;
      context.strokeRect(x - out, y - out, zoom + 2 * out, zoom + 2 * out);
    }
  }
}

let requested = false;
function update() {
  if (requested) return;
  requested = true;
  requestAnimationFrame(() => {
    requested = false;
    if (view.fits) Object.assign(view, {zoom: fitZoom(), x: width / 2, y: height / 2});
    panes.forEach(drawPane);
    showControls();
    showValues();
  });
}

// What is shown beside the images ------------------------------------------------------------------------------------

function showControls() {
  if (divider) {
    divider.style.left = view.split * 100 + '%';
    divider.setAttribute('aria-valuenow', Math.round(view.split * 100));
  }
  for (const letter of letters) byId(letter).value = view[letter];
  byId('exposure').value = view.exposure;
  byId('stops').textContent = (view.exposure > 0 ? '+' : '') + String(view.exposure).replace('-', '\u2212') + ' EV';
  byId('percent').textContent = Number((view.zoom * 100).toPrecision(3)) + ' %';
  const mapped = view.mode === 'map' || view.mode === 'grid', map = allMaps[view.map];
  byId('map-bar').hidden = byId('legend').hidden = !mapped;
  if (!mapped) return;
  byId('map').value = view.map;
  if (document.activeElement !== byId('scale')) byId('scale').value = Number(scaleOf(map).toPrecision(4));
  byId('black').checked = view.black;
  byId('black').disabled = !map.signed;
  showLegend(map);
}

function showLegend(map) {
  const at = i => map.signed ? i * 2 - 1 : i, colors = [];
  for (let i = 0; i <= 32; ++i) colors.push(`rgb(${mapColor(at(i / 32), map.signed, view.black)})`);
  const ramp = element('div', {class: 'ramp'}), ticks = element('div', {class: 'ticks'});
  ramp.style.background = `linear-gradient(to right, ${colors})`;
  for (const i of [0, 0.25, 0.5, 0.75, 1]) {
    const beyond = i === 1 ? '\u2265\u2009' : i === 0 && map.signed ? '\u2264\u2009' : '';
    const label = element('span', {}, beyond + short(at(i) * scaleOf(map)));
    label.style.left = i * 100 + '%';
    ticks.append(label);
  }
  const what = element('div', {class: 'what'}, (map.legend || map.name) + '; not finite: magenta');
  byId('legend').replaceChildren(ramp, ticks, what);
}

const rows = [];
function addRow(name, values) {
  const cells = [0, 1, 2].map(() => element('td', {class: 'number'}, '\u2013'));
  const head = element('th', {scope: 'row'}, name);
  byId('values').tBodies[0].append(element('tr', {}, head, ...cells));
  rows.push({head, name, cells, values});
}
images.forEach((image, i) => addRow(`${i + 1} ${image.name}`, p => image.values.map(channel => channel[p])));
if (last > 0) addRow('A \u2212 B', p => [0, 1, 2].map(c => images[view.a].values[c][p] - images[view.b].values[c][p]));
maps.forEach(map => {
  const cell = (x, y) => Math.floor(y * map.height / height) * map.width + Math.floor(x * map.width / width);
  addRow(map.name, (_, x, y) => [map.values[0][cell(x, y)]]);
});

function showValues() {
  rows.forEach((row, i) => {
    const used = i > last ? '' : (i === view.a ? 'A' : '') + (i === view.b ? 'B' : '');
    row.head.replaceChildren(row.name, ...used ? [element('b', {class: 'used'}, used)] : []);
  });
  if (!view.pixel) return;
  const [x, y] = view.pixel;
  byId('where').textContent = `Pixel (${x}, ${y})`;
  for (const row of rows) {
    const values = row.values(y * width + x, x, y);
    row.cells.forEach((cell, c) => cell.textContent = c < values.length ? format(values[c]) : '');
  }
}

function set(changes) {
  Object.assign(view, changes);
  update();
}
function zoomTo(zoom, x = view.x, y = view.y) {
  const next = Math.min(128, Math.max(Math.min(1, fitZoom()) / 4, zoom)), share = view.zoom / next;
  set({fits: false, zoom: next, x: x + (view.x - x) * share, y: y + (view.y - y) * share});
}
const move = (dx, dy) => set({fits: false, x: Math.min(width, Math.max(0, view.x + dx / view.zoom)),
                              y: Math.min(height, Math.max(0, view.y + dy / view.zoom))});
const expose = stops => set({exposure: Math.min(12, Math.max(-12, stops))});
const flip = () => set({front: view.front === 'a' ? 'b' : 'a'});
function rescale(scale) {
  allMaps[view.map].own = scale;
  update();
}

// The position under the pointer in pixels of the image.
function position(event) {
  const pane = event.target.closest('.pane');
  if (!pane) return null;
  const frame = pane.getBoundingClientRect();
  return [view.x + (event.clientX - frame.left - frame.width / 2) / view.zoom,
          view.y + (event.clientY - frame.top - frame.height / 2) / view.zoom];
}
function point(event) {
  const at = position(event)?.map(Math.floor);
  if (at && at[0] >= 0 && at[1] >= 0 && at[0] < width && at[1] < height) set({pixel: at});
}

const pointers = new Map();
let moved = 0, splitting = false;
box.addEventListener('pointerdown', event => {
  if (event.button !== 0 || !position(event)) return;
  splitting = event.target === divider;
  event.target.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  moved = pointers.size > 1 ? Infinity : 0;
  point(event);
});
box.addEventListener('pointermove', event => {
  const before = pointers.get(event.pointerId);
  if (!before) return point(event);
  const now = [event.clientX, event.clientY], [dx, dy] = [now[0] - before[0], now[1] - before[1]];
  if (splitting) {
    const frame = panes[0].node.getBoundingClientRect();
    set({split: Math.min(1, Math.max(0, (now[0] - frame.left) / frame.width))});
  } else if (pointers.size > 1) {
    const fixed = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = from => Math.hypot(from[0] - fixed[0], from[1] - fixed[1]);
    zoomTo(view.zoom * apart(now) / (apart(before) || 1));
  } else if ((moved += Math.hypot(dx, dy)) > 3) {
    move(-dx, -dy);
  }
  pointers.set(event.pointerId, now);
});
box.addEventListener('pointerup', event => {
  if (pointers.delete(event.pointerId) && moved <= 3 && !splitting && view.mode === 'flip') flip();
});
box.addEventListener('pointercancel', event => pointers.delete(event.pointerId));
box.addEventListener('wheel', event => {
  event.preventDefault();
  const at = position(event);
  const turned = Math.max(-300, Math.min(300, event.deltaY * (event.deltaMode ? 30 : 1)));
  if (at) zoomTo(view.zoom * Math.exp(-turned / 500), ...at);
}, {passive: false});

for (const input of document.querySelectorAll('input[name="mode"]'))
  input.addEventListener('change', () => setMode(input.value));
for (const letter of letters) {
  byId(letter).append(...images.map((image, i) => element('option', {value: i}, `${i + 1} ${image.name}`)));
  byId(letter).addEventListener('change', () => set({[letter]: Number(byId(letter).value)}));
}
byId('map').append(...allMaps.map((map, i) => element('option', {value: i}, map.name)));
byId('map').addEventListener('change', () => set({map: Number(byId('map').value)}));
byId('exposure').addEventListener('input', () => expose(Number(byId('exposure').value)));
byId('black').addEventListener('change', () => set({black: byId('black').checked}));
byId('scale').addEventListener('input', () => {
  const scale = Number(byId('scale').value);
  if (scale > 0 && Number.isFinite(scale)) rescale(scale);
});
const buttons = {
  swap: () => set({a: view.b, b: view.a}), 'no-exposure': () => expose(0),
  'zoom-in': () => zoomTo(view.zoom * 1.5), 'zoom-out': () => zoomTo(view.zoom / 1.5), 'zoom-one': () => zoomTo(1),
  'zoom-fit': () => set({fits: true}), 'scale-half': () => rescale(scaleOf(allMaps[view.map]) / 2),
  'scale-double': () => rescale(scaleOf(allMaps[view.map]) * 2), 'scale-auto': () => rescale(0),
};
for (const [id, act] of Object.entries(buttons)) byId(id).addEventListener('click', act);

const keys = {
  '[': () => expose(view.exposure - 0.5), ']': () => expose(view.exposure + 0.5), '+': buttons['zoom-in'],
  '=': buttons['zoom-in'], '-': buttons['zoom-out'], '0': buttons['zoom-fit'],
};
const modes = {s: 'slider', f: 'flip', g: 'grid', m: 'map'};
const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
addEventListener('keydown', event => {
  const {target, key} = event, arrow = arrows[key];
  if (event.ctrlKey || event.metaKey || event.altKey || target.matches('select, input:not([type="radio"])')) return;
  const digit = /^(?:Digit|Numpad)([1-9])$/.exec(event.code);
  if (digit) {
    const letter = view.mode === 'flip' && !event.shiftKey ? view.front : event.shiftKey ? 'b' : 'a';
    if (digit[1] <= images.length) set({[letter]: digit[1] - 1});
  } else if (arrow && target === divider && arrow[0]) {
    set({split: Math.min(1, Math.max(0, view.split + arrow[0] * (event.shiftKey ? 0.1 : 0.01)))});
  } else if (arrow && target === box) {
    move(40 * arrow[0], 40 * arrow[1]);
  } else if (key === ' ' && view.mode === 'flip' && !target.matches('button, input')) {
    flip();
  } else if (keys[key]) {
    keys[key]();
  } else if (modes[key]) {
    setMode(modes[key]);
  } else {
    return;
  }
  event.preventDefault();
});

byId('digits').textContent = 'Values are rounded by at most ' + (report.bits === 24 ? '0.0015' : '0.024') + ' %.';
showFacts();
new ResizeObserver(() => {
  box.style.gridTemplateColumns = `repeat(${columns()}, minmax(0, 1fr))`;
  update();
}).observe(box);
setMode('slider');
document.body.dataset.ready = 'yes';  // for whoever waits for the page from outside

function showFacts() {
  const names = [...new Set(images.flatMap(image => image.facts.map(([name]) => name)))];
  if (!names.length) return;
  const find = (image, name) => image.facts.find(fact => fact[0] === name)?.[1] ?? '\u2013';
  const head = element('tr', {}, ...['Image', ...names].map(name => element('th', {scope: 'col'}, name)));
  const body = images.map(image => element('tr', {}, element('th', {scope: 'row'}, image.name),
                                           ...names.map(name => element('td', {}, find(image, name)))));
  byId('facts').append(element('table', {}, element('caption', {}, 'About the images'), element('thead', {}, head),
                               element('tbody', {}, ...body)));
  byId('facts').hidden = false;
}
})();
)page";

}  // namespace lightswitch::detail
