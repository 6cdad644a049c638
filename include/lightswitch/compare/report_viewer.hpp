#pragma once

// The script of a report's image viewer: what it shows.

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch::detail {

/// Opens a function that `report_controls_script` closes.
inline constexpr const char* report_viewer_script = R"js(
(async () => {
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

)js";

}  // namespace lightswitch::detail
