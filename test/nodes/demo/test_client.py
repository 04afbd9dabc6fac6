# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A client whose service answers, or does not."""

import threading

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future
from std_srvs.srv import SetBool, Trigger

from pam_ros.errors import PamError
from pam_ros.nodes.demo import client as client_module
from pam_ros.nodes.demo.client import Client

pytestmark = [pytest.mark.at_any_pace, pytest.mark.usefixtures('domain')]


@pytest.fixture
def requests(domain):
    """Serve two services in a thread; return the list of the requests that have come."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('server', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    came = []

    def serve(request, response):
        came.append(request)
        response.success = True
        return response

    node.create_service(SetBool, 'switch', serve)
    node.create_service(Trigger, 'act', serve)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield came
    executor.shutdown()
    thread.join()
    node.destroy_node()
    rclpy.shutdown(context=context)


@pytest.fixture
def losing(monkeypatch):
    """Let the first answer to each client be lost, which no real middleware does on request."""
    create = rclpy.node.Node.create_client

    def create_client(self, *arguments, **options):
        client = create(self, *arguments, **options)
        call = client.call_async

        def first(request):
            client.call_async = call
            call(request)
            return Future()

        client.call_async = first
        return client

    monkeypatch.setattr(rclpy.node.Node, 'create_client', create_client)
    monkeypatch.setattr(client_module, 'AGAIN', 0.2)


def test_a_service_is_called_once(requests):
    with Client() as client:
        assert client.call(SetBool, 'switch', data=True).success
        assert client.call(Trigger, 'act').success
    assert len(requests) == 2


def test_a_request_without_a_response_is_repeated(requests, losing):
    with Client() as client:
        assert client.call(SetBool, 'switch', data=True).success
    assert [one.data for one in requests] == [True, True]


def test_a_request_that_may_act_twice_is_not_repeated(requests, losing):
    with (
        Client(patience=1.0) as client,
        pytest.raises(PamError, match='while waiting for the answer of act'),
    ):
        client.call(Trigger, 'act')
    assert len(requests) == 1
