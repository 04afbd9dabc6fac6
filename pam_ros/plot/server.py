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
from typing import Any

from pam_ros.errors import PamError
from pam_ros.plot.colours import colour
from pam_ros.plot.panels import Panel

HOST = '127.0.0.1'
PATIENCE = 10.0  # s within which a browser must send its request
PAGE = Path(__file__).with_name('page.html')
# The page contains everything it needs, and may send requests to this program only.
_HEADERS = {
    'Cache-Control': 'no-store',
    'Content-Security-Policy': (
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
        "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'"
    ),
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
}


def content(
    panels: Sequence[Panel],
    start: float,
    end: float,
    now: float,
    *,
    note: str = '',
    is_live: bool = True,
) -> dict[str, Any]:
    """Return the data of the page, for JSON: the axis of time, the present time, a note, *panels*.

    Times are in s. A gap in a line is None.
    """
    return {
        'start': start,
        'end': end,
        'now': now,
        'note': note,
        'live': is_live,
        'panels': [
            {
                'title': panel.title,
                'lines': [
                    {
                        'name': line.name,
                        'colour': colour(line.number),
                        'setPoint': line.is_set_point,
                        'held': line.is_held,
                        't': [round(float(t), 4) for t in line.t],
                        'value': [_rounded(float(value)) for value in line.value],
                    }
                    for line in panel.lines
                ],
            }
            for panel in panels
        ],
    }


def _rounded(value: float) -> float | None:
    return float(f'{value:.7g}') if isfinite(value) else None


class PageServer:
    """Serves the page and its data on 127.0.0.1.

    Each request is answered in a separate thread, which calls *look*. Requests to another host
    are refused: a page of another site could otherwise read the plots through a host name that
    leads to this machine.
    """

    def __init__(self, look: Callable[[], dict[str, Any]], port: int = 0) -> None:
        """Listen on *port*, 0 for any free port; *look* returns the :func:`content`.

        Raises PamError if the port cannot be used.
        """
        try:
            self._server = _Server((HOST, port), _Handler)
        except OSError as error:
            raise PamError(
                f'port {port} of {HOST} cannot be used: {error.strerror}; give another --port, or '
                'none'
            ) from error
        self._server.look, self._server.page = look, PAGE.read_bytes()
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
    look: Callable[[], dict[str, Any]]
    page: bytes

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
        elif self.path == '/':
            self._answer('text/html; charset=utf-8', self.server.page)
        elif self.path == '/data':
            text = json.dumps(self.server.look(), allow_nan=False, separators=(',', ':'))
            self._answer('application/json', text.encode())
        else:
            self.send_error(HTTPStatus.NOT_FOUND)

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
