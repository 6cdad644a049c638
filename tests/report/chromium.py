"""A headless Chromium, driven through the DevTools protocol over a pair of pipes. Standard library only."""

import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find_chromium():
    """The path of a Chromium or Chrome, or None. LIGHTSWITCH_CHROMIUM overrides the search."""
    names = [os.environ.get('LIGHTSWITCH_CHROMIUM'), 'chromium', 'chromium-browser', 'google-chrome']
    return next((path for path in map(shutil.which, filter(None, names)) if path), None)


class Chromium:
    """One page. Messages of errors are kept in `problems`, the addresses that it asks for in `requests`."""

    def __init__(self, program, width=1280, height=800, seconds=100):
        self.deadline = time.monotonic() + seconds
        self.profile = tempfile.mkdtemp(prefix='lightswitch-chromium-')
        self.problems, self.requests, self.buffer, self.last_id, self.session = [], [], b'', 0, None
        from_us, self.to_browser = os.pipe()
        self.from_browser, to_us = os.pipe()

        def become_3_and_4():  # the numbers that --remote-debugging-pipe expects
            source, target = os.dup(from_us), os.dup(to_us)
            os.dup2(source, 3)
            os.dup2(target, 4)

        self.process = subprocess.Popen(
            [program, '--headless', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
             '--disable-background-networking', '--disable-extensions', '--force-device-scale-factor=1',
             '--force-color-profile=srgb', f'--window-size={width},{height}', f'--user-data-dir={self.profile}',
             '--remote-debugging-pipe', 'about:blank'],
            close_fds=False, preexec_fn=become_3_and_4, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True)
        os.close(from_us)
        os.close(to_us)
        try:
            page = next(t for t in self.call('Target.getTargets')['targetInfos'] if t['type'] == 'page')
            self.session = self.call('Target.attachToTarget', targetId=page['targetId'], flatten=True)['sessionId']
            for domain in ('Runtime', 'Log', 'Network', 'Page'):
                self.call(domain + '.enable')
            self.resize(width, height)
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        try:
            self.session = None
            self.call('Browser.close')
            self.process.wait(10)
        except Exception:  # it is gone, or hangs
            self.process.kill()
            self.process.wait()
        os.close(self.to_browser)
        os.close(self.from_browser)
        shutil.rmtree(self.profile, ignore_errors=True)

    def call(self, method, **parameters):
        self.last_id += 1
        message = {'id': self.last_id, 'method': method, 'params': parameters}
        if self.session:
            message['sessionId'] = self.session
        data = json.dumps(message).encode() + b'\0'
        while data:
            data = data[os.write(self.to_browser, data):]
        while True:
            answer = self.receive()
            if answer.get('id') == self.last_id:
                if 'error' in answer:
                    raise RuntimeError(f'{method}: {answer["error"]}')
                return answer['result']
            self.note(answer)

    def receive(self):
        while b'\0' not in self.buffer:
            if not select.select([self.from_browser], [], [], max(0, self.deadline - time.monotonic()))[0]:
                raise TimeoutError('Chromium did not answer in time')
            chunk = os.read(self.from_browser, 1 << 20)
            if not chunk:
                raise RuntimeError('Chromium ended')
            self.buffer += chunk
        message, self.buffer = self.buffer.split(b'\0', 1)
        return json.loads(message)

    def note(self, event):
        method, what = event.get('method'), event.get('params', {})
        if method == 'Runtime.exceptionThrown':
            self.problems.append(what['exceptionDetails'])
        elif method == 'Log.entryAdded' and what['entry']['level'] in ('error', 'warning'):
            if 'willReadFrequently' not in what['entry']['text']:  # advice on reading pixels, which only the test does
                self.problems.append(what['entry'])
        elif method == 'Runtime.consoleAPICalled' and what['type'] in ('error', 'warning', 'assert'):
            self.problems.append(what)
        elif method == 'Page.javascriptDialogOpening':
            self.problems.append(what)
            self.call('Page.handleJavaScriptDialog', accept=True)
        elif method == 'Network.requestWillBeSent':
            self.requests.append(what['request']['url'])

    # A page -----------------------------------------------------------------------------------------------------------

    def evaluate(self, expression, drawn=True):
        """The value of a JavaScript expression (awaited), after the page has drawn what is due."""
        frames = 'await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));' if drawn else ''
        result = self.call('Runtime.evaluate', expression=f'(async () => {{ {frames} return ({expression}); }})()',
                           awaitPromise=True, returnByValue=True)
        if 'exceptionDetails' in result:
            raise RuntimeError(f'{expression}: {result["exceptionDetails"]}')
        return result['result'].get('value')

    def open(self, address, until):
        self.call('Page.navigate', url=address)
        while not self.evaluate(until):
            if time.monotonic() > self.deadline:
                raise TimeoutError(f'the page never got to {until}: {self.problems}')
            time.sleep(0.05)

    def resize(self, width, height, dark=False):
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=1, mobile=False)
        scheme = {'name': 'prefers-color-scheme', 'value': 'dark' if dark else 'light'}
        self.call('Emulation.setEmulatedMedia', features=[scheme])

    def mouse(self, kind, x, y, **more):
        self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, **more)

    def drag(self, start, end):
        self.mouse('mouseMoved', *start)
        self.mouse('mousePressed', *start, button='left', buttons=1, clickCount=1)
        for i in (1, 2, 3, 4):
            self.mouse('mouseMoved', *(a + (b - a) * i / 4 for a, b in zip(start, end)), button='left', buttons=1)
        self.mouse('mouseReleased', *end, button='left', clickCount=1)

    def click(self, selector):
        left, top, width, height = self.box(selector)
        self.drag(*[(left + width / 2, top + height / 2)] * 2)

    def box(self, selector):
        return self.evaluate(f'''(() => {{ const e = document.querySelector({json.dumps(selector)});
            e.scrollIntoView({{block: 'nearest'}}); const b = e.getBoundingClientRect();
            return [b.left, b.top, b.width, b.height]; }})()''', drawn=False)

    def press(self, key, code=None, text=None, times=1, modifiers=0):
        keys = {'ArrowLeft': 37, 'ArrowUp': 38, 'ArrowRight': 39, 'ArrowDown': 40, ' ': 32}
        virtual = keys.get(key) or ord(key.upper()[0])
        for _ in range(times):
            for kind in ('keyDown', 'keyUp'):
                self.call('Input.dispatchKeyEvent', type=kind, key=key, code=code or key, windowsVirtualKeyCode=virtual,
                          modifiers=modifiers, **({'text': text} if text and kind == 'keyDown' else {}))
