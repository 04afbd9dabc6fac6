# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The speed of lockstep and scaled time, and the CPU time of 64 muscles in real time.

Claims: lockstep with a controller in another process over DDS at 500 Hz is at least 10 times as
fast as real time; scaled time, as fast as possible and published at 100 Hz, at least 50 times; 64
muscles with physics at 1 kHz, published at 500 Hz in real time, need less than 60 % of a core, at
499 Hz or more, without an overrun in 30 s. The CPU time of one more muscle is printed as well.

Other programs on the machine slow everything except CPU times. So the load is printed, and CPU
times next to the others.
"""

import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from time import monotonic

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from benchmarks.node_rate import cpu_seconds
from pam_ros.nodes.demo.client import Client

HERE = Path(__file__).parent
CONTROLLER = HERE.parent / 'test' / 'support' / 'example_controller.py'
NAMESPACE = f'/time_modes_{os.getpid()}'
SECONDS = 30.0
SIM = [sys.executable, '-m', 'pam_ros.cli.pam_sim', '--ros-args', '-r', f'__ns:={NAMESPACE}']
MUSCLES = (2, 8, 16, 32, 64)
ARRAYS = ('pressures', 'forces', 'stiffnesses', 'dampings')
TURNS = 3


def simulator(name: str, **parameters: object) -> subprocess.Popen[bytes]:
    """Start a simulator of this name in the namespace of the benchmark."""
    given = itertools.chain.from_iterable(
        ('-p', f'{k}:={json.dumps(v)}') for k, v in parameters.items()
    )
    return subprocess.Popen([*SIM, '-r', f'__node:={name}', *given], start_new_session=True)


def end(process: subprocess.Popen[bytes]) -> None:
    """Stop it as Ctrl-C does."""
    process.send_signal(signal.SIGINT)
    process.wait()


def values(diagnostics: list[DiagnosticArray], name: str) -> dict[str, str]:
    """Return the timing that the simulator of this name published last."""
    full = f'{NAMESPACE[1:]}/{name}: timing'
    found = (s for m in reversed(diagnostics) for s in m.status if s.name == full)
    status = next(found, None)
    return {v.key: v.value for v in status.values} if status else {}


def lockstep(client: Client, diagnostics: list[DiagnosticArray], seconds: float) -> None:
    """Print how much faster than real time a closed loop in lockstep is."""
    for turn in range(TURNS):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, 'run.npz')
            remapped = ['--ros-args', '-r', f'__ns:={NAMESPACE}']
            name = f'lockstep_{turn}'
            sim = simulator(name, time_mode='lockstep')
            client.until(partial(values, diagnostics, name), 'the simulator')
            begin = cpu_seconds(sim.pid)
            subprocess.run([sys.executable, CONTROLLER, str(seconds), file, *remapped], check=True)
            used = cpu_seconds(sim.pid) - begin
            end(sim)
            run = np.load(file)
            took = float(run['took'])
        periods = len(run['t'])
        print(
            f'lockstep, {seconds:g} s at 500 Hz, run {turn + 1}: {seconds / took:6.1f} times real '
            f'time (at least 10), {took / periods * 1e6:.0f} us a period, of these '
            f'{used / periods * 1e6:.0f} us CPU of the simulator',
            flush=True,
        )


def scaled(client: Client, diagnostics: list[DiagnosticArray]) -> None:
    """Print how fast scaled time is without a limit of its speed."""
    for rate in (100.0, 500.0):
        name = f'scaled_{rate:.0f}'
        sim = simulator(name, time_mode='scaled', speed_factor=0.0, publish_rate=rate)

        def simulated(name: str = name) -> float:
            return float(values(diagnostics, name).get('simulated time (s)', 0.0))

        client.until(simulated, 'the simulator')
        begin = simulated(), cpu_seconds(sim.pid), monotonic()
        client.work(SECONDS / 3)
        now = simulated(), cpu_seconds(sim.pid), monotonic()
        done, used, took = np.subtract(now, begin)
        end(sim)
        diagnostics.clear()
        limit = ' (at least 50)' if rate == 100.0 else ''
        print(
            f'scaled, as fast as possible, publishing at {rate:g} Hz: {done / took:.0f} times '
            f'real time{limit}, {done / used:.0f} times its CPU time',
            flush=True,
        )


def many(client: Client, diagnostics: list[DiagnosticArray]) -> None:
    """Print the CPU time of different numbers of muscles in real time."""
    shares = []
    for kind, topic in (
        (JointState, 'joint_states'),
        *((Float64MultiArray, name) for name in ARRAYS),
    ):
        # Each topic has a subscriber, so that messages are sent.
        client.node.create_subscription(kind, topic, lambda message: None, 10, raw=True)
    for count in MUSCLES:
        names = [f'm{i}' for i in range(count)]
        name = f'of_{count}'
        sim = simulator(name, muscles=names)
        client.until(partial(values, diagnostics, name), 'the simulator')
        client.work(2.0)
        before, used, begin = values(diagnostics, name), cpu_seconds(sim.pid), monotonic()
        rates = []
        while monotonic() - begin < SECONDS:
            client.work(1.0)
            rates.append(float(values(diagnostics, name)['publish rate (Hz)']))
        share = (cpu_seconds(sim.pid) - used) / (monotonic() - begin)
        after = values(diagnostics, name)
        end(sim)
        diagnostics.clear()
        overruns = int(after['overruns']) - int(before['overruns'])
        shares.append(share)
        print(
            f'{count:3} muscles at 1 kHz, published at 500 Hz: {100 * share:5.1f} % of a core, '
            f'{np.mean(rates):.1f} Hz, {overruns} overruns in {SECONDS:g} s, worst lateness '
            f'{1e3 * float(after["worst lateness (s)"]):.1f} ms in the last second',
            flush=True,
        )
    slope, base = np.polyfit(MUSCLES, shares, 1)
    print(f'a muscle more: {100 * slope:.2f} % of a core (line from {100 * base:.1f} %)')
    print(f'64 muscles: {100 * shares[-1]:.1f} % of a core (below 60)')


def main() -> None:
    """Measure all and print the numbers."""
    print(f'load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores before')
    with Client(NAMESPACE) as client:
        diagnostics = client.collect(DiagnosticArray, '/diagnostics')
        lockstep(client, diagnostics, 20.0)
        scaled(client, diagnostics)
        many(client, diagnostics)


if __name__ == '__main__':
    main()
