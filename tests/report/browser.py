"""browser.py WRITE_REPORT: has the program write reports, and uses them in a headless Chromium as a user would.

Exit status: 0 when all holds, 1 when not, 77 when there is no Chromium.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time

from chromium import Chromium, find_chromium

WIDTH, HEIGHT, IMAGES = 48, 32, 3
NAMES = ['reference', '</script><b id=planted>x</b>', 'größer "näher" & \'mehr\' ☀']
failures = []


def check(condition, what):
    if not condition:
        failures.append(what)
        print('FAILED:', what)


def equal(found, expected, what):
    check(found == expected, f'{what}: {found!r} instead of {expected!r}')


# What write_report.cpp puts in ----------------------------------------------------------------------------------------


def pixel(image, x, y):
    special = {(0, 0): [None, math.nan, None], (1, 0): [math.inf, None, None], (2, 0): [-0.5, 1e-6, 1e6]}
    value = [(x + 1) * (image + 1) / 256, (y + 1) / 64, (image + 1) / 8]
    replaced = special.get((x, y), [None] * 3) if image == 1 else [None] * 3
    return [v if r is None else r for v, r in zip(value, replaced)]


def srgb(value):
    encoded = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return 255 * min(1, max(0, encoded))


def color(image, x, y, stops=0):
    value = pixel(image, x, y)
    return [255, 0, 255] if not all(map(math.isfinite, value)) else [srgb(max(0, v) * 2 ** stops) for v in value]


def number(text):
    text = text.replace('\u2212', '-')
    return float(text)  # nan, inf and -inf too


def same_numbers(texts, values, what):
    """The page shows four digits, three beside an exponent."""
    def same(found, value):
        digits = 4 if 1e-3 <= abs(value) < 1e5 else 3
        both_nan = math.isnan(found) and math.isnan(value)
        return found == value or both_nan or abs(found - value) <= 6 * 10**-digits * abs(value)

    fits = len(texts) == len(values) and all(map(same, map(number, texts), values))
    check(fits, f'{what}: {texts} instead of {values}')


# What a user sees -----------------------------------------------------------------------------------------------------


class Page:
    """The report in the browser. Places are in pixels of the window, `pane` counts from 0."""

    def __init__(self, browser):
        self.browser = browser

    def js(self, expression):
        return self.browser.evaluate(expression)

    def text(self, selector):
        return self.js(f'document.querySelector({json.dumps(selector)}).textContent')

    def texts(self, selector):
        return self.js(f'[...document.querySelectorAll({json.dumps(selector)})].map(e => e.textContent)')

    def pane(self, index=0):
        return self.browser.box(f'.pane:nth-child({index + 1})')

    def place(self, x, y, pane=0):
        """The place of the centre of an image pixel while the whole image is shown."""
        left, top, width, height = self.pane(pane)
        zoom = min(width / WIDTH, height / HEIGHT)
        return left + width / 2 + (x + 0.5 - WIDTH / 2) * zoom, top + height / 2 + (y + 0.5 - HEIGHT / 2) * zoom

    def at(self, place, pane=0):
        """The canvas's colour at a place, once everything is drawn."""
        left, top, _, _ = self.pane(pane)
        return self.js(f'''[...document.querySelectorAll('.pane canvas')[{pane}].getContext('2d')
            .getImageData({int(place[0] - left)}, {int(place[1] - top)}, 1, 1).data].slice(0, 3)''')

    def shows(self, place, expected, what, pane=0):
        found = self.at(place, pane)
        check(max(abs(a - b) for a, b in zip(found, expected)) <= 1.5, f'{what}: colour {found} instead of {expected}')

    def hover(self, place):
        self.browser.mouse('mouseMoved', *place)
        return json.loads(self.text('#where').removeprefix('Pixel ').replace('(', '[').replace(')', ']'))

    def values(self, row):
        return self.texts(f'#values tbody tr:nth-child({row + 1}) td')

    def choose(self, selector, value):
        self.js(f'''(() => {{ const e = document.querySelector('{selector}'); e.value = {json.dumps(value)};
            e.dispatchEvent(new Event('change', {{bubbles: true}})); }})()''')

    def mode(self, name):
        self.browser.click(f'input[value={name}]')
        self.js('0')  # the layout is another one once it is drawn


def test_text(page):
    equal(page.js('document.title'), 'Title <i>&amp;</i> "quoted" ☀', 'title')
    equal(page.text('h1'), 'Title <i>&amp;</i> "quoted" ☀', 'heading')
    equal(page.texts('.summary p'), ['One </main><script>alert(1)</script>', 'Two'], 'summary')
    equal(page.js("document.querySelectorAll('#planted, i, main b:not(.used)').length"), 0, 'elements out of names')
    equal(page.texts('#a option'), [f'{i + 1} {name}' for i, name in enumerate(NAMES)], 'names to choose from')
    equal(page.texts('.tag'), [NAMES[1], NAMES[0]], 'names on the images')
    equal(page.texts('#tables td'), ['<b>a</b>', '0.25', 'b', ''], 'table')
    equal(page.texts('#facts td'), ['16', '</script>', '32', '</script>', '64', '</script>'], 'facts')


def test_values(page):
    for x, y in [(0, 0), (1, 0), (2, 0), (47, 31), (20, 9), (33, 30)]:
        equal(page.hover(page.place(x, y)), [x, y], 'pixel under the pointer')
        for image in range(IMAGES):
            same_numbers(page.values(image), pixel(image, x, y), f'image {image} at {x}, {y}')
        difference = [a - b for a, b in zip(pixel(1, x, y), pixel(0, x, y))]
        same_numbers(page.values(IMAGES), difference, f'A - B at {x}, {y}')
        equal(number(page.values(IMAGES + 1)[0]), float(f'{(x // 8 + y // 8 * 6) / 32:.4g}'), 'value of the map')


def test_slider_and_exposure(page):
    browser = page.browser
    left, right = page.place(10, 12), page.place(40, 12)
    page.shows(left, color(1, 10, 12), 'A on the left')
    page.shows(right, color(0, 40, 12), 'B on the right')
    page.shows(page.place(0, 0), [255, 0, 255], 'NaN')
    page.shows(page.place(1, 0), [255, 0, 255], 'infinity')
    page.shows(page.place(2, 0), [0, 0, 255], 'negative and huge values')

    x, y, width, height = page.pane()
    browser.drag((x + width / 2, y + height / 2), (page.place(42, 12)[0] + 12, y + height / 2))
    page.shows(right, color(1, 40, 12), 'A where the slider has passed')
    page.js("document.querySelector('.divider').focus()")
    before = float(page.js("document.querySelector('.divider').getAttribute('aria-valuenow')"))
    browser.press('ArrowLeft', times=7)
    after = float(page.js("document.querySelector('.divider').getAttribute('aria-valuenow')"))
    equal(after, before - 7, 'slider by keys')
    browser.press('ArrowLeft', times=8, modifiers=8)
    page.shows(left, color(0, 10, 12), 'B where the slider is gone')

    page.js("document.querySelector('#exposure').focus()")
    browser.press('ArrowRight', times=6)
    equal(page.text('#stops'), '+1.5 EV', 'exposure shown')
    page.shows(left, color(0, 10, 12, 1.5), 'B at +1.5 EV')
    browser.drag(*[(x + 3, y + height - 3)] * 2)  # leaves the control
    page.js("document.activeElement.blur()")
    browser.press('[', 'BracketLeft', times=5)
    page.shows(left, color(0, 10, 12, -1), 'B at -1 EV')
    browser.click('#no-exposure')
    page.shows(left, color(0, 10, 12), 'B at 0 EV again')
    browser.click('#swap')
    page.shows(left, color(1, 10, 12), 'B after swapping')
    browser.click('#swap')


def test_flip(page):
    page.mode('flip')
    place = page.place(30, 20)
    page.shows(place, color(1, 30, 20), 'A in front')
    page.browser.drag(place, place)
    page.shows(place, color(0, 30, 20), 'B after a click')
    page.js('document.activeElement.blur()')
    page.browser.press(' ', 'Space', ' ')
    page.shows(place, color(1, 30, 20), 'A after the space key')
    page.browser.press('3', 'Digit3')
    page.shows(place, color(2, 30, 20), 'the third image')
    equal(page.text('.tag'), NAMES[2], 'name of the third image')
    page.browser.press('@', 'Digit2', modifiers=8)
    page.browser.press(' ', 'Space', ' ')
    page.shows(place, color(1, 30, 20), 'B chosen with the shift key')
    page.choose('#a', '1')
    page.choose('#b', '0')
    page.browser.press(' ', 'Space', ' ')


def test_grid(page):
    page.mode('grid')
    equal(page.js("document.querySelectorAll('.pane').length"), IMAGES + 1, 'panes')

    def together(what):
        """All panes show one pixel at one place; returns that pixel."""
        seen = []
        for pane in range(IMAGES + 1):
            left, top, width, height = page.pane(pane)
            place = (left + width * 0.6 + 0.5, top + height * 0.55 + 0.5)
            seen.append(page.hover(place))
            if pane < IMAGES:
                page.browser.mouse('mouseMoved', left + 1, top + 1)  # the outline of the pixel is not in the way
                page.shows(place, color(pane, *seen[-1]), f'{what}, pane {pane}', pane)
        check(all(pixel == seen[0] for pixel in seen), f'{what}: panes at different pixels: {seen}')
        return seen[0]

    together('whole images')
    left, top, width, height = page.pane(1)
    corner = (left + width * 0.3, top + height * 0.4)
    fixed = page.hover(corner)
    for _ in range(8):
        page.browser.mouse('mouseWheel', *corner, deltaX=0, deltaY=-120)
    zoom = page.text('#percent')
    equal(page.hover(corner), fixed, 'pixel under the pointer while zooming')
    start = together('zoomed')
    page.browser.drag((left + width / 2, top + height / 2), (left + width / 2 - 90, top + height / 2 - 60))
    moved = together('moved')
    equal(page.text('#percent'), zoom, 'zoom while moving')
    check(moved[0] > start[0] and moved[1] > start[1], f'dragging moved from {start} to {moved}')
    page.js("document.querySelector('#panes').focus()")
    page.browser.press('ArrowLeft', times=2)
    check(together('moved by keys')[0] < moved[0], 'the arrow keys move the images')

    # Magnified, a pixel is one colour up to its border.
    page.browser.click('#zoom-fit')
    for _ in range(4):
        page.browser.click('#zoom-in')
    left, top, width, height = page.pane(0)
    page.browser.mouse('mouseMoved', 5, 5)
    row = page.js(f'''(() => {{ const d = document.querySelector('.pane canvas').getContext('2d')
        .getImageData(0, {int(height * 0.3)}, {int(width)}, 1).data, r = [];
        for (let i = 0; i < d.length; i += 4) r.push(d.slice(i, i + 3).join()); return r; }})()''')
    changes = sum(a != b for a, b in zip(row, row[1:]))
    check(3 <= changes <= WIDTH, f'{changes} changes of colour along {len(row)} places of a magnified row')
    page.browser.click('#zoom-one')
    equal(page.text('#percent'), '100 %', 'zoom 1:1')
    page.browser.click('#zoom-fit')


def test_maps(page):
    page.mode('map')
    place = page.place(30, 20)
    reds, _, blues = page.at(place)
    check(reds > blues + 40, f'A > B is red, not {page.at(place)}')
    page.browser.click('#swap')
    reds, _, blues = page.at(place)
    check(blues > reds + 40, f'A < B is blue, not {page.at(place)}')
    page.browser.click('#swap')
    page.shows(page.place(0, 0), [255, 0, 255], 'NaN in the difference')

    page.js("document.querySelector('#scale').focus()")
    page.js("document.querySelector('#scale').select()")
    page.browser.call('Input.insertText', text='0.5')
    strong = page.at(place)
    equal(page.texts('.ticks span'), ['≤\u2009\u22120.5', '\u22120.25', '0', '0.25', '≥\u20090.5'], 'legend')
    page.browser.click('#scale-double')
    weak = page.at(place)
    check(sum(weak) > sum(strong) + 20, f'double the scale is paler: {strong} to {weak}')
    equal(page.js("document.querySelector('#scale').value"), '1', 'scale shown')
    page.browser.click('#black')
    check(sum(page.at(place)) < sum(weak) - 100, 'black at zero is darker')
    page.browser.click('#black')
    page.browser.click('#scale-auto')

    # The dominant channel of 2/8 - 1/8 relative to 1/8 + 0.01 is about 0.926; at the scale's end it is as red as can
    # be.
    page.choose('#map', '2')
    page.js("document.querySelector('#scale').select(), document.querySelector('#scale').focus()")
    page.browser.call('Input.insertText', text='0.9')
    page.shows(page.place(40, 20), page.js('mapColor(1, true, false)'), 'relative difference beyond the scale')
    for index, value in [(1, 0.125), (3, None)]:
        page.choose('#map', str(index))
        page.js("document.querySelector('#scale').select(), document.querySelector('#scale').focus()")
        page.browser.call('Input.insertText', text='1')
        for x, y in [(3, 5), (7, 5), (8, 5), (47, 31)]:
            expected = (x // 8 + y // 8 * 6) / 32 if value is None else max(value, (x + 1) / 256)
            page.shows(page.place(x, y), page.js(f'mapColor({expected}, false, false)'), f'map {index} at {x}, {y}')
    page.mode('slider')


def test_charts(page):
    equal(page.texts('figcaption'), ['Error over time', 'Error over samples', 'p-values <of> tiles'], 'charts')
    wrong = page.js("document.querySelector('#charts').innerHTML.match(/NaN|Infinity|undefined/)")
    check(not wrong, f'a chart holds {wrong}')
    for chart in (0, 1):
        curves, ideals = (page.js(f'''[...document.querySelectorAll('figure')[{chart}].querySelectorAll('path.{kind}')]
            .map(e => e.getAttribute('d').slice(1).split('L').map(p => p.split(' ').map(Number)))''')
                          for kind in ('curve', 'ideal'))
        equal([len(c) for c in curves], [6, 6], 'points of the curves')
        # A curve that falls with 1/sqrt(N) lies on its ideal line; one that falls with the cube root ends above.
        check(math.dist(curves[0][-1], ideals[0][-1]) < 0.5, 'the ideal line of a curve that is ideal')
        slopes = [(c[-1][1] - c[0][1]) / (c[-1][0] - c[0][0]) for c in curves]
        check(abs(slopes[1] / slopes[0] - 2 / 3) < 0.01, f'slopes {slopes}')
    heights = page.js("[...document.querySelectorAll('.bin')].map(e => Number(e.getAttribute('height')))")
    equal(len(heights), 20, 'bins')
    check(abs(heights[0] / heights[1] - 2) < 0.01 and max(heights[1:]) - min(heights[1:]) < 1e-6, f'bins {heights}')
    top, line = page.js("""[['.bin:nth-of-type(2)', 'y'], ['figure:last-child > svg .expected', 'y1']]
        .map(([s, name]) => Number(document.querySelector(s).getAttribute(name)))""")
    check(abs((top + heights[1] - line) / heights[1] - 21 / 20) < 0.01, 'expected level')
    check('2 of 422' in page.text('figure:last-child .keys'), 'values that are not counted')


def test_widths(page):
    for width, height, dark in [(1280, 800, True), (400, 800, False), (1280, 800, False)]:
        page.browser.resize(width, height, dark)
        equal(page.js('matchMedia("(prefers-color-scheme: dark)").matches'), dark, 'colour scheme')
        for mode in ('grid', 'map', 'flip', 'slider'):
            page.mode(mode)
            wide = page.js('document.documentElement.scrollWidth - document.documentElement.clientWidth')
            check(wide <= 0, f'{mode} at width {width}: {wide} pixels too wide')
    check(page.js("getComputedStyle(document.body).backgroundColor") != 'rgb(18, 21, 24)', 'light again')


def test_large(page):
    """Many pixels, of which fewer bits are kept."""
    equal(page.js('report.bits'), 20, 'bits kept')
    left, top, width, height = page.pane()
    for across, down in [(0.3, 0.2), (0.501, 0.777), (0.7, 0.9)]:
        x, y = page.hover((left + width * across, top + height * down))
        for image in range(6):
            mixed = [(x * 73856093 ^ y * 19349663 ^ (3 * image + c) * 83492791) * 2654435761 % 2**32 for c in range(3)]
            expected = [(m // 2**21 + 2048) * 2.0 ** (m // 2**10 % 8 - 12) for m in mixed]
            same_numbers(page.values(image), expected, f'image {image} at {x}, {y}')


def test_single(page):
    """One black pixel: nothing to compare, and nothing that breaks."""
    for mode in ('grid', 'map', 'flip', 'slider'):
        page.mode(mode)
        left, top, width, height = page.pane()
        equal(page.hover((left + width * 0.4, top + height * 0.4)), [0, 0], f'the pixel in the mode {mode}')
    equal(page.values(0), ['0', '0', '0'], 'black')


def test_words(page):
    equal(page.texts('td'), ['cell'], 'table')
    equal(page.js("document.querySelectorAll('canvas, figure, select').length"), 0, 'nothing to look at')


def use(program, path, tests):
    with Chromium(program) as browser:
        start = time.monotonic()
        viewer = "document.querySelector('#viewer') && document.body.dataset.ready !== 'yes'"
        loaded = "document.querySelector('h1') && document.readyState === 'complete'"
        browser.open('file://' + path, f'{loaded} && !({viewer})')
        print(f'{os.path.getsize(path) / 1e6:.1f} MB, ready after {time.monotonic() - start:.1f} s', flush=True)
        page = Page(browser)
        for test in tests:
            print(test.__name__, flush=True)
            test(page)
        equal(page.js("document.querySelectorAll('.error').length"), 0, 'errors shown')
        check(not browser.problems, f'errors in the console: {browser.problems}')
        others = [url for url in browser.requests if not url.startswith(('file://' + path, 'data:', 'about:'))]
        check(not others, f'the page asks for {others}')


def main():
    program = find_chromium()
    if program is None:
        print('skipped: there is no Chromium (install the package chromium, or name one in LIGHTSWITCH_CHROMIUM)')
        return 77
    with tempfile.TemporaryDirectory(prefix='lightswitch-report-') as folder:
        small = [test_text, test_values, test_slider_and_exposure, test_flip, test_grid, test_maps, test_charts,
                 test_widths]
        for size, tests in [('small', small), ('large', [test_large]),
                            ('single', [test_single]), ('words', [test_words])]:
            path = os.path.join(folder, size + '.html')
            subprocess.run([sys.argv[1], size, path], check=True)
            use(program, path, tests)
    print(f'{len(failures)} failures')
    return 1 if failures else 0


sys.exit(main())
