# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How a node leaves the middleware: with nothing left behind, and in a limited time."""

import subprocess
import sys

import pytest

from support.harness import DEADLINE

# With two publishers of a topic the node samples it by a hidden node of its own.
SAMPLING = """
import sys
from time import monotonic

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Float64
from sensor_msgs.msg import JointState
from pam_ros.nodes.{module}.node import {name}

def hidden():
    return [name for name in other.get_node_names() if name.endswith('_sampler')]

rclpy.init()
node, other = {name}(), rclpy.create_node('other')
publishers = [other.create_publisher({kind}, '{topic}', 10) for _ in range(2)]
executor = SingleThreadedExecutor()
executor.add_node(node)
limit = monotonic() + {deadline}
while not hidden() and monotonic() < limit:
    executor.spin_once(timeout_sec=0.1)
print(hidden())
node.finish()
while hidden() and monotonic() < limit:
    pass
print(hidden())
node.destroy_node()
other.destroy_node()
rclpy.shutdown()
"""

HANGING = """
import sys, time
import rclpy
from rclpy.node import Node
from pam_ros.nodes.common import spin
from pam_ros.nodes.sim.node import PamSim

spin.LEAVING = 0.5
if {is_hanging}:
    def destroy_node(node):
        time.sleep(600.0)

    Node.destroy_node = destroy_node

class Stop:
    is_made = True

sys.argv = ['pam_sim']
sys.exit(spin.run(PamSim, Stop(), 'a node that is stopped at once'))
"""


def run(code):
    return subprocess.run(
        [sys.executable, '-c', code],
        capture_output=True,
        text=True,
        check=False,
        timeout=4 * DEADLINE,
    )


@pytest.mark.at_any_pace
@pytest.mark.parametrize(
    ('module', 'name', 'kind', 'topic'),
    [
        ('sim', 'PamSim', 'Float64', 'pressure_command'),
        ('control', 'PamControl', 'JointState', 'joint_states'),
    ],
)
def test_a_node_that_samples_a_topic_leaves_no_hidden_node(domain, module, name, kind, topic):
    # One that was left was released after the middleware, by the interpreter at its end: some
    # programs then ended by "malloc_consolidate(): unaligned fastbin chunk", and some never.
    done = run(
        SAMPLING.format(module=module, name=name, kind=kind, topic=topic, deadline=DEADLINE)
    )
    node = f'pam_{module}'
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [f"['_{node}_sampler']", '[]'], done.stderr


@pytest.mark.at_any_pace
def test_a_middleware_that_hangs_at_the_end_does_not_keep_the_program(domain):
    done = run(HANGING.format(is_hanging=True))
    assert done.returncode == 1
    assert 'in destroy_node' in done.stderr


@pytest.mark.at_any_pace
def test_a_program_that_does_not_hang_ends_properly(domain):
    done = run(HANGING.format(is_hanging=False))
    assert done.returncode == 0, done.stderr
    assert 'destroy_node' not in done.stderr
