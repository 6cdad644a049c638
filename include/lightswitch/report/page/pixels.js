const byId = id => document.getElementById(id);
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
