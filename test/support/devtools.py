# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A page in a real browser that is moved, clicked and asked through the DevTools protocol.

The browser is started with ``--remote-debugging-pipe``: messages are JSON with a NUL behind them,
on its file descriptors 3 and 4, so that no port is open and no further library is necessary.
"""

import base64
import json
import os
import subprocess
import time
from contextlib import contextmanager
from select import select

from support.browsing import QUIET

PATIENCE = 120.0  # s
FLAGS = ('--headless', '--no-sandbox', '--disable-gpu', '--no-first-run')


class Page:
    """One page, with its requests, its errors and its downloads."""

    def __init__(self, read, write, downloads):
        self.downloads = downloads
        self.requests, self.errors = [], []
        self._read, self._write = read, write
        self._rest, self._number, self._answers = b'', 0, {}
        self._session = self._target = None

    def open(self, address, width=1280, height=800):
        """Open the page at *address* in a window of this size in px."""
        self.close()
        self._target = self.call('Target.createTarget', url='about:blank')['targetId']
        attached = self.call('Target.attachToTarget', targetId=self._target, flatten=True)
        self._session = attached['sessionId']
        for domain in ('Page', 'Runtime', 'Network', 'Log'):
            self.call(f'{domain}.enable')
        self.call(
            'Browser.setDownloadBehavior', behavior='allow', downloadPath=str(self.downloads)
        )
        self.resize(width, height)
        self.call('Page.navigate', url=address)

    def close(self):
        """Close the page that is open."""
        if self._session:
            self._session = None
            self.call('Target.closeTarget', targetId=self._target)

    def resize(self, width, height):
        """Give the window another size in px."""
        self.call(
            'Emulation.setDeviceMetricsOverride',
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def call(self, method, **parameters):
        """Call a method of the protocol, and return its result."""
        return self._answer(self._send(method, parameters))

    def _send(self, method, parameters):
        """Send a message, and return its number."""
        self._number += 1
        message = {'id': self._number, 'method': method, 'params': parameters}
        if self._session:
            message['sessionId'] = self._session
        os.write(self._write, json.dumps(message).encode() + b'\0')
        return self._number

    def _answer(self, number):
        """Return the result of the message with this number."""
        end = time.monotonic() + PATIENCE
        while number not in self._answers:
            self._receive(end)
        answer = self._answers.pop(number)
        assert 'error' not in answer, answer
        return answer['result']

    def _receive(self, end):
        ready, _, _ = select([self._read], [], [], max(end - time.monotonic(), 0.0))
        assert ready, 'the browser does not answer'
        found = os.read(self._read, 1 << 20)
        assert found, 'the browser has ended'
        *texts, self._rest = (self._rest + found).split(b'\0')
        for text in texts:
            message = json.loads(text)
            if 'id' in message:
                self._answers[message['id']] = message
            elif message.get('sessionId') == self._session:  # not of a page that was closed
                self._note(message['method'], message['params'])

    def _note(self, method, parameters):
        if method == 'Network.requestWillBeSent':
            self.requests.append(parameters['request']['url'])
        elif method == 'Runtime.exceptionThrown':
            self.errors.append(parameters['exceptionDetails'])
        elif method == 'Log.entryAdded' and parameters['entry']['level'] == 'error':
            self.errors.append(parameters['entry'])

    def ask(self, expression):
        """Return the value of an expression of JavaScript; a promise is awaited."""
        found = self.call(
            'Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True
        )
        assert 'exceptionDetails' not in found, found['exceptionDetails']
        return found['result'].get('value')

    def until(self, expression, what):
        """Return the value of an expression as soon as it is true."""
        end = time.monotonic() + PATIENCE
        while not (found := self.ask(expression)):
            assert time.monotonic() < end, f'waited for {what}: {self.errors}'
            time.sleep(0.02)
        return found

    def mouse(self, kind, x, y, **more):
        """Dispatch one event of the mouse at a place in px."""
        self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, **more)

    def move(self, x, y):
        """Move the pointer."""
        self.mouse('mouseMoved', x, y)

    def click(self, x, y, count=1):
        """Click at a place in px, *count* times quickly: no click waits for the one before."""
        self.move(x, y)
        sent = [
            self._send(
                'Input.dispatchMouseEvent',
                {'type': kind, 'x': x, 'y': y, 'button': 'left', 'clickCount': number},
            )
            for number in range(1, count + 1)
            for kind in ('mousePressed', 'mouseReleased')
        ]
        for number in sent:
            self._answer(number)

    def drag(self, start, end):
        """Drag from one place in px to another."""
        self.move(*start)
        self.mouse('mousePressed', *start, button='left', buttons=1, clickCount=1)
        for share in (0.25, 0.5, 0.75, 1.0):
            at = [a + share * (b - a) for a, b in zip(start, end, strict=True)]
            self.mouse('mouseMoved', *at, button='left', buttons=1)
        self.mouse('mouseReleased', *end, button='left', clickCount=1)

    def downloaded(self, name):
        """Return the path of a file as soon as it is downloaded completely, and forget it."""
        path, end = self.downloads / name, time.monotonic() + PATIENCE
        while not path.exists() or list(self.downloads.glob('*.crdownload')):
            assert time.monotonic() < end, f'waited for {name}'
            time.sleep(0.02)
        return path

    def screenshot(self, path):
        """Write a picture of the window."""
        path.write_bytes(base64.b64decode(self.call('Page.captureScreenshot')['data']))


@contextmanager
def page_in(browser, folder):
    """Start *browser* with a profile in *folder*, and give a :class:`Page`; end it afterwards."""
    downloads = folder / 'downloads'
    downloads.mkdir()
    to_browser, own_write = os.pipe()
    own_read, from_browser = os.pipe()
    quiet = [f'--disable-{name}' for name in QUIET]
    flags = [*FLAGS, *quiet, f'--user-data-dir={folder / "profile"}', '--remote-debugging-pipe']
    # The shell puts the two pipes where the browser expects them.
    line = f'exec "$0" "$@" 3<&{to_browser} 4>&{from_browser}'
    process = subprocess.Popen(
        ['bash', '-c', line, browser, *flags],
        pass_fds=(to_browser, from_browser),
        stderr=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )
    os.close(to_browser)
    os.close(from_browser)
    try:
        yield Page(own_read, own_write, downloads)
    finally:
        os.close(own_write)  # the browser ends when its pipe does
        try:
            process.wait(10.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        os.close(own_read)
