"""Chromium without a window, controlled by its DevTools protocol over two pipes.

Every wait ends: with an error after PATIENCE_S. One thread.
"""
import base64, json, os, pathlib, selectors, shutil, signal, subprocess, sys, tempfile, time

PATIENCE_S = 300  # for hangs alone: software draws the pages, perhaps on a busy machine

# A sandbox needs rights that a container lacks; the pages are our own. Software draws: there is no GPU to rely on.
# It draws what WebGL asks for alone: a page put together by it takes seconds a picture.
SWITCHES = '''--headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --disable-gpu-compositing --disable-dev-shm-usage --hide-scrollbars
    --no-first-run --disable-background-networking --disable-component-update --remote-debugging-pipe'''.split()


def end_on_request():
    """From now on a script that is told to end (SIGTERM) leaves no browser and no server behind."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))


class PageThrew(RuntimeError):
    """What was evaluated threw."""


class Browser:
    """An open page; `switches` are further ones of Chromium's. Use it in a `with` statement."""

    def __init__(self, switches=()):
        program = shutil.which('chromium-headless-shell') or shutil.which('chromium')
        if program is None:
            raise RuntimeError('there is no Chromium; scripts/install-dependencies.sh installs chromium-headless-shell')
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        there, back = os.pipe(), os.pipe()

        def take_pipes():  # DevTools' are descriptors 3 and 4; first out of the way of each other
            ends = os.dup(there[0]), os.dup(back[1])
            high = [end if end > 4 else os.dup(end) for end in ends]
            for number, end in zip((3, 4), high):
                os.dup2(end, number)

        self._process = subprocess.Popen(
            [program, *SWITCHES, f'--user-data-dir={self._profile.name}', *switches, 'about:blank'], close_fds=False,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=take_pipes, start_new_session=True)
        os.close(there[0])
        os.close(back[1])
        self._to, self._from, self._received, self._last_call, self._session = there[1], back[0], b'', 0, None
        self._readable = selectors.DefaultSelector()
        self._readable.register(self._from, selectors.EVENT_READ)
        self.complaints = []  # what the page complained of: errors, exceptions, what its policy kept out
        target = self.call('Target.createTarget', url='about:blank')['targetId']
        self._session = self.call('Target.attachToTarget', targetId=target, flatten=True)['sessionId']
        for domain in 'Page', 'Runtime', 'Log':
            self.call(f'{domain}.enable')
        self.call('Emulation.setFocusEmulationEnabled', enabled=True)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        os.close(self._to)
        os.close(self._from)
        os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._profile.cleanup()

    def _receive(self):
        while b'\0' not in self._received:
            if not self._readable.select(PATIENCE_S):
                raise RuntimeError('the browser does not answer')
            data = os.read(self._from, 1 << 16)
            if not data:
                raise RuntimeError('the browser ended')
            self._received += data
        message, self._received = self._received.split(b'\0', 1)
        return json.loads(message)

    def _note(self, event):
        method, what = event.get('method'), event.get('params', {})
        if method == 'Log.entryAdded' and what['entry']['level'] == 'error':
            self.complaints.append(what['entry']['text'])
        elif method == 'Runtime.consoleAPICalled' and what['type'] == 'error':
            self.complaints.append(' '.join(str(each.get('value', each.get('description', ''))) for each in what['args']))
        elif method == 'Runtime.exceptionThrown':
            self.complaints.append(what['exceptionDetails'].get('exception', {}).get('description', what['exceptionDetails']['text']))

    def call(self, method, **parameters):
        self._last_call += 1
        message = {'id': self._last_call, 'method': method, 'params': parameters}
        if self._session:
            message['sessionId'] = self._session
        data = json.dumps(message).encode() + b'\0'
        while data:
            data = data[os.write(self._to, data):]
        while (answer := self._receive()).get('id') != self._last_call:
            self._note(answer)
        if 'error' in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return answer['result']

    def open(self, url):
        self.call('Page.navigate', url=url)
        self.wait_for(f'location.href === {json.dumps(url)} && document.readyState === "complete"')

    def resize(self, width, height, phone=False):
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=1, mobile=phone)
        # a phone shows a page that is too wide smaller, in a wider window
        self.wait_for(f'Math.round(visualViewport.width * visualViewport.scale) === {width}')

    def set_dark(self, dark):
        scheme = 'dark' if dark else 'light'
        self.call('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': scheme}])
        self.wait_for(f"matchMedia('(prefers-color-scheme: {scheme})').matches")

    def key(self, code, down):
        """`code` is a KeyboardEvent's. Space also types its character, so that it presses a button that has the focus."""
        space = {'text': ' ', 'windowsVirtualKeyCode': 32} if code == 'Space' and down else {}
        self.call('Input.dispatchKeyEvent', type='keyDown' if space else 'rawKeyDown' if down else 'keyUp', code=code,
                  key=' ' if code == 'Space' else code, **space)

    def press(self, code):
        self.key(code, True)
        self.key(code, False)

    def evaluate(self, expression):
        """What the expression is worth; a promise is waited for. Raises where it throws."""
        answer = self.call('Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True)
        if 'exceptionDetails' in answer:
            raise PageThrew(answer['exceptionDetails'].get('exception', {}).get('description', str(answer['exceptionDetails'])))
        return answer['result'].get('value')

    def wait_for(self, expression):
        end, why = time.monotonic() + PATIENCE_S, ''
        while True:
            try:
                why = ''
                if self.evaluate(f'Boolean({expression})'):
                    return
            except PageThrew as error:  # what it is about may not be there yet
                why = f', last: {error}'
            except RuntimeError as error:  # asked while the page was left
                if 'navigated' not in str(error) and 'context' not in str(error):
                    raise
            if time.monotonic() > end:
                raise RuntimeError(f'in vain waited for: {expression}{why}')
            time.sleep(0.02)

    def screenshot(self, png):
        pathlib.Path(png).write_bytes(base64.b64decode(self.call('Page.captureScreenshot', format='png')['data']))
