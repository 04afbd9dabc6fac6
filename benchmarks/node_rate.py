# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``pam_sim`` at 1000 Hz compared with a minimal node that publishes the same messages.

Claims: CPU time at most 1.3 times the bare node's, at least 999 messages a second over 30 s, and
the 99th percentile of lateness at most 10 % above the bare node's. One subscriber process each.
"""

import os
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

RATE = 1000.0  # Hz
SECONDS = 30.0
TICK = os.sysconf('SC_CLK_TCK')
BARE = [sys.executable, '-m', 'benchmarks._bare_node']
# Keep out nodes of other programs.
NAMESPACE = ['--ros-args', '-r', f'__ns:=/node_rate_{os.getpid()}']
PUBLISHERS = {
    # A timer of rclpy skips the periods for which it is late, so that its lateness means little.
    'bare node, rclpy timer': [*BARE, 'timer', str(RATE)],
    'bare node': [*BARE, 'loop', str(RATE)],
    'pam_sim': [
        *(sys.executable, '-m', 'pam_ros.cli.pam_sim'),
        *('--ros-args', '-p', f'publish_rate:={RATE}', '-p', f'physics_rate:={RATE}'),
        *('-p', 'initial.at_rest:=false', '-p', 'initial.pressure:=600000.0'),
    ],
}


@dataclass(frozen=True)
class Measured:
    """CPU time in us a message, messages a second, and lateness in us: median, p99, worst."""

    cpu: float
    rate: float
    lateness: tuple[float, float, float]


def cpu_seconds(pid: int) -> float:
    """Return the CPU time that a process has used so far."""
    fields = Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICK


def lateness(arrival: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Return by how many us each message came after its period's time.

    The periods are a grid on which the most punctual message has no lateness.
    """
    late = arrival - arrival[0] - (number - number[0]) * 1e9 / RATE
    return (late - late.min()) / 1e3


def measure(command: list[str]) -> Measured:
    """Run one publisher with one subscriber."""
    env = {**os.environ, 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder, 'received.npz'))
        listen = [*BARE, 'listen', str(SECONDS), file, *NAMESPACE]
        with (
            subprocess.Popen([*command, *NAMESPACE], env=env, start_new_session=True) as publisher,
            subprocess.Popen(listen, env=env, stdout=subprocess.PIPE, text=True) as listener,
        ):
            assert listener.stdout is not None
            listener.stdout.readline()
            begin = cpu_seconds(publisher.pid)
            listener.stdout.readline()
            used = cpu_seconds(publisher.pid) - begin
            listener.wait()
            publisher.send_signal(signal.SIGINT)
        with np.load(file) as received:
            arrival, stamp, position = (
                received[name] for name in ('arrival', 'stamp', 'position')
            )
    # The simulator's stamps count its periods, the bare node's position does.
    is_bare = command[:3] == BARE
    number = position if is_bare else np.round((stamp - stamp[0]) * RATE * 1e-9)
    rate = (len(arrival) - 1) / (arrival[-1] - arrival[0]) * 1e9
    percentiles = np.percentile(lateness(arrival, number), [50, 99, 100])
    return Measured(used / len(arrival) * 1e6, rate, tuple(percentiles))


def main() -> None:
    """Measure all publishers in turn and print the table."""
    load = os.getloadavg()[0]
    print(f'{SECONDS:g} s each at {RATE:g} Hz; load {load:.1f} on {os.cpu_count()} cores before')
    print(f'{"":26} {"CPU us/tick":>11} {"Hz":>8} {"late p50":>9} {"p99":>8} {"worst":>8} us')
    results = {}
    for name, command in PUBLISHERS.items():
        results[name] = got = measure(command)
        p50, p99, worst = got.lateness
        print(
            f'{name:26} {got.cpu:11.1f} {got.rate:8.2f} {p50:9.0f} {p99:8.0f} {worst:8.0f}',
            flush=True,
        )
    bare, sim = results['bare node'], results['pam_sim']
    print(f'CPU, pam_sim / bare node: {sim.cpu / bare.cpu:.2f} (at most 1.3)')
    print(f'late p99, pam_sim / bare node: {sim.lateness[1] / bare.lateness[1]:.2f} (at most 1.1)')
    print(f'pam_sim: {sim.rate:.2f} Hz (at least 999)')


if __name__ == '__main__':
    main()
