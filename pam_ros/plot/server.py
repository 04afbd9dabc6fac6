# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page with the plots, for a browser on this machine only."""

import json
from collections.abc import Callable, Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from math import isfinite
from pathlib import Path
from socketserver import TCPServer
from threading import Thread
from typing import Any, NamedTuple
from urllib.parse import parse_qs, urlsplit

import numpy as np
from numpy.typing import NDArray

from pam_ros.errors import PamError
from pam_ros.plot.bokeh_files import bokeh_files
from pam_ros.plot.colours import colour
from pam_ros.plot.column_names import word
from pam_ros.plot.panels import Panel
from pam_ros.plot.shown_units import choices, label, scale
from pam_ros.plot.thinning import is_outlier, thinned

Array = NDArray[np.float64]

HOST = '127.0.0.1'
PATIENCE = 10.0  # s within which a browser must send its request
PAGE = Path(__file__).with_name('page.html')
COARSE, FINE = 600, 6000  # columns of time, of the whole axis and of a part of it
# The page, and the library that draws it, come from this program and may send requests to it only.
_HEADERS = {
    'Cache-Control': 'no-store',
    'Content-Security-Policy': (
        "default-src 'none'; script-src 'self' 'unsafe-inline'; style-src 'unsafe-inline'; "
        "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'"
    ),
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
}


class Window(NamedTuple):
    """A part of the axis of time, in s; ``is_complete`` requests every sample that there is."""

    start: float
    end: float
    is_complete: bool


def content(
    panels: Sequence[Panel],
    start: float,
    end: float,
    now: float,
    *,
    note: str = '',
    is_live: bool = True,
    window: Window | None = None,
) -> dict[str, Any]:
    """Return the data of the page, for JSON: the axis of time, the present time, a note, *panels*.

    Times are in s, values in SI; a gap in a line is None. The lines are thinned to the pixels of a
    screen, or ten times finer within a *window*.
    """
    first, last, is_complete = window or (start, end, False)
    columns = None if is_complete else FINE if window else COARSE
    units = choices(panels)
    return {
        'start': start,
        'end': end,
        'now': now,
        'note': note,
        'live': is_live,
        'units': units,
        'panels': [_content(panel, units, first, last, columns) for panel in panels],
    }


def _content(
    panel: Panel, units: Sequence[str], start: float, end: float, columns: int | None
) -> dict[str, Any]:
    return {
        'label': label(panel),
        'title': panel.title,
        'scales': {one: scale(panel, one)._asdict() for one in units},
        'lines': [
            {
                'name': line.name,
                'column': line.column or word(f'{label(panel)} {line.name}'),
                'colour': colour(line.number),
                'setPoint': line.is_set_point,
                'held': line.is_held,
                't': np.round(line.t, 6).tolist(),
                'value': _numbers(line.value),
                'outliers': np.flatnonzero(is_outlier(line)).tolist(),
            }
            for line in thinned(panel, start, end, columns).lines
        ],
    }


def _numbers(value: Array) -> list[float | None]:
    """Return values with seven significant digits, for JSON: None in gaps."""
    is_number = np.isfinite(value) & (value != 0.0)
    size = np.floor(np.log10(np.abs(value, where=is_number, out=np.ones_like(value))))
    # A division by a power of ten gives the nearest number to the decimal one; a product may not.
    up, down = 10.0 ** np.maximum(6.0 - size, 0.0), 10.0 ** np.maximum(size - 6.0, 0.0)
    rounded: list[float | None] = (np.round(value * up / down) * down / up).tolist()
    for i in np.flatnonzero(~np.isfinite(value)):
        rounded[i] = None
    return rounded


Look = Callable[[Window | None], dict[str, Any]]


class PageServer:
    """Serves the page and its data on 127.0.0.1.

    Each request is answered in a separate thread, which calls *look*. Requests to another host
    are refused: a page of another site could otherwise read the plots through a host name that
    leads to this machine.
    """

    def __init__(self, look: Look, port: int = 0) -> None:
        """Listen on *port*, 0 for any free port; *look* returns the :func:`content`.

        It is given a part of the axis of time, or None for all of it. Raises PamError if the port
        cannot be used, or if the library that draws the page is not installed.
        """
        scripts = bokeh_files()
        try:
            self._server = _Server((HOST, port), _Handler)
        except OSError as error:
            raise PamError(
                f'port {port} of {HOST} cannot be used: {error.strerror}; give another --port, or '
                'none'
            ) from error
        self._server.look = look
        self._server.files = {'/': ('text/html; charset=utf-8', PAGE.read_bytes())}
        for name, text in scripts.items():
            self._server.files[f'/{name}'] = ('text/javascript; charset=utf-8', text)
        self._thread = Thread(
            target=self._server.serve_forever, args=(0.1,), name='page', daemon=True
        )

    @property
    def port(self) -> int:
        """Return the port that it listens on."""
        return self._server.server_port

    @property
    def address(self) -> str:
        """Return the address to open in a browser."""
        return f'http://{HOST}:{self.port}/'

    def start(self) -> None:
        """Answer requests from now on."""
        self._thread.start()

    def close(self) -> None:
        """Answer no more requests."""
        if self._thread.is_alive():
            self._server.shutdown()
            self._thread.join()
        self._server.server_close()


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False  # a browser that keeps its connection open does not delay the end
    look: Look
    files: dict[str, tuple[str, bytes]]  # type and content by path

    def server_bind(self) -> None:
        """Listen without asking the network for the name of this machine."""
        TCPServer.server_bind(self)
        self.server_name, self.server_port = HOST, int(self.server_address[1])

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing if a browser disconnects during an answer."""


class _Handler(BaseHTTPRequestHandler):
    server: _Server
    timeout = PATIENCE
    server_version, sys_version = 'pam_plot', ''

    def do_GET(self) -> None:
        """Answer with the page or with its data."""
        port = self.server.server_port
        if self.headers.get('Host', '') not in (f'{HOST}:{port}', f'localhost:{port}'):
            self.send_error(HTTPStatus.FORBIDDEN, 'The page is only for this machine')
        elif self.path in self.server.files:
            self._answer(*self.server.files[self.path])
        elif urlsplit(self.path).path == '/data':
            self._answer_data(urlsplit(self.path).query)
        else:
            self.send_error(HTTPStatus.NOT_FOUND)

    def _answer_data(self, query: str) -> None:
        try:
            window = _window(query)
        except ValueError as error:
            self.send_error(HTTPStatus.BAD_REQUEST, str(error))
            return
        text = json.dumps(self.server.look(window), allow_nan=False, separators=(',', ':'))
        self._answer('application/json', text.encode())

    def _answer(self, kind: str, body: bytes) -> None:
        self.send_response(HTTPStatus.OK)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header('Content-Type', kind)
        self.send_header('Content-Length', str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002 as http.server has it
        """Print nothing for each request."""


def _window(query: str) -> Window | None:
    """Return the part of the axis of time that is requested; raises ValueError if it is none."""
    found = {name: values[0] for name, values in parse_qs(query).items()}
    if not found:
        return None
    if not {'from', 'to'} <= found.keys() <= {'from', 'to', 'all'}:
        raise ValueError('a part of the data has from=S&to=S in s, and all=1 for every sample')
    start, end = (float(found[name]) for name in ('from', 'to'))
    if not (isfinite(start) and isfinite(end) and start < end):
        raise ValueError('from and to are times in s, and from is before to')
    return Window(start, end, 'all' in found)
