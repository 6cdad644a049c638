(() => {
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
