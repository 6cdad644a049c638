#pragma once

// The script of a report's image viewer: what the mouse, the keyboard and the controls do.

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch::detail {

/// Continues `report_viewer_script`.
inline constexpr const char* report_controls_script = R"js(

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
)js";

}  // namespace lightswitch::detail
