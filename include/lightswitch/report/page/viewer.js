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
