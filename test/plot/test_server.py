# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page over real HTTP requests."""

import http.client
import json
import re
import socket

import numpy as np
import pytest

from pam_ros.errors import PamError
from pam_ros.plot.panels import Curves, panels
from pam_ros.plot.server import HOST, PageServer, Window, content
from pam_ros.plot.topics import Key


@pytest.fixture
def server():
    t = np.array([0.0, 1.0, 8.0, 9.0, 9.1])
    value = np.array([1.0, 2.0, 3.0, 1.0 / 3.0, 5.0])
    samples = {Key('force', 'force'): (np.concatenate([t, [30.0]]), np.append(value, 6.0))}
    made = panels(Curves(samples), 'm', 30.0)
    server = PageServer(
        lambda window: content(made, 10.0, 30.0, 29.0, note='a note', window=window)
    )
    server.start()
    yield server
    server.close()


def ask(server, path, host=None, method='GET'):
    connection = http.client.HTTPConnection(HOST, server.port, timeout=60.0)
    try:
        headers = {} if host is None else {'Host': host}
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()
    finally:
        connection.close()


def test_the_page_needs_nothing_from_the_network(server):
    status, headers, body = ask(server, '/')
    text = body.decode()
    assert status == 200
    assert headers['Content-Type'].startswith('text/html')
    assert "default-src 'none'" in headers['Content-Security-Policy']
    assert headers['Cache-Control'] == 'no-store'
    assert '<title>pam_plot</title>' in text
    assert not re.search(r'https?://|//\w+\.\w|@import|<link[^>]+href="[^d]', text)
    scripts = re.findall(r'<script[^>]+src="([^"]*)"', text)
    assert scripts == ['bokeh.min.js', 'bokeh-api.min.js']
    for name in scripts:
        status, headers, body = ask(server, f'/{name}')
        assert status == 200
        assert headers['Content-Type'].startswith('text/javascript')
        assert len(body) > 50_000
    # It needs no code from strings.
    assert 'unsafe-eval' not in headers['Content-Security-Policy']


def test_the_numbers(server):
    status, headers, body = ask(server, '/data')
    assert status == 200
    assert headers['Content-Type'] == 'application/json'
    assert 'Access-Control-Allow-Origin' not in headers
    found = json.loads(body)
    assert [found[name] for name in ('start', 'end', 'now', 'note')] == [
        10.0,
        30.0,
        29.0,
        'a note',
    ]
    assert found['live'] is True
    (panel,) = found['panels']
    assert panel['title'] == 'force, N'
    (line,) = panel['lines']
    assert (line['name'], line['setPoint'], line['held']) == ('force', False, False)
    assert len(line['t']) == len(line['value'])
    # The axis begins at 10 s, to which the line leads from before. A pause of 20.9 s is above ten
    # periods of 1 s: a gap.
    assert line['t'] == [9.1, 30.0, 30.0]
    assert line['value'] == [5.0, None, 6.0]


def test_a_part_of_the_numbers(server):
    _, _, body = ask(server, '/data?from=0.5&to=8.5')
    (line,) = json.loads(body)['panels'][0]['lines']
    assert line['t'] == [0.0, 1.0, 8.0, 9.0]
    assert line['value'] == [1.0, 2.0, 3.0, 0.3333333]


@pytest.mark.parametrize(
    'query',
    ['from=1', 'from=1&to=x', 'from=2&to=1', 'from=nan&to=1', 'from=0&to=inf', 'from=0&to=1&a=1'],
)
def test_a_part_that_is_none_is_refused(server, query):
    status, _, body = ask(server, f'/data?{query}')
    assert status == 400
    assert b'Traceback' not in body


def test_the_whole_axis_is_thinned_a_part_less_and_a_file_not_at_all():
    t = np.arange(100_000) / 1000.0
    made = panels(Curves({Key('force', 'force'): (t, np.sin(50.0 * t))}), 'm', 100.0)

    def count(window):
        found = content(made, 0.0, 100.0, 100.0, window=window)
        (line,) = found['panels'][0]['lines']
        return len(line['t'])

    assert 1000 < count(None) <= 1202
    assert 10_000 < count(Window(0.0, 50.0, is_complete=False)) <= 12_002
    assert count(Window(0.0, 50.0, is_complete=True)) == 50_002


@pytest.mark.parametrize('name', ['127.0.0.1', 'localhost'])
def test_this_machine_is_answered(server, name):
    assert ask(server, '/data', f'{name}:{server.port}')[0] == 200


@pytest.mark.parametrize('path', ['/', '/data'])
@pytest.mark.parametrize('host', ['evil.example', 'evil.example:80', '127.0.0.1', '', '10.0.0.1'])
def test_another_host_is_refused(server, path, host):
    status, _, body = ask(server, path, host)
    assert status == 403
    assert b'force' not in body


def test_only_this_machine_can_connect(server):
    assert server.address == f'http://127.0.0.1:{server.port}/'
    with pytest.raises(OSError, match=r'.'), socket.socket() as other:
        # Every address 127.x.y.z is this machine; the server listens on one of them alone.
        other.connect(('127.0.0.2', server.port))


@pytest.mark.parametrize(
    ('path', 'method', 'code'),
    [('/nowhere', 'GET', 404), ('/../setup.py', 'GET', 404), ('/', 'POST', 501)],
)
def test_there_is_nothing_else(server, path, method, code):
    assert ask(server, path, method=method)[0] == code


def test_a_port_that_is_taken_is_one_sentence(server):
    with pytest.raises(PamError, match=f'^port {server.port} of 127.0.0.1 cannot be used: '):
        PageServer(lambda window: {}, server.port)


def test_a_browser_that_holds_its_connection_does_not_hold_up_the_end(server):
    with socket.create_connection((HOST, server.port), timeout=60.0) as held:
        held.sendall(b'GET /data HTTP/1.1\r\n')
        server.close()
    with pytest.raises(OSError, match=r'.'):
        socket.create_connection((HOST, server.port), timeout=60.0)
