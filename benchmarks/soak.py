# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run ``pam_sim``, ``pam_control`` and ``pam_record`` of six topics at 1 kHz for three minutes.

Claims: no message is lost on its way to the bag; the memory of each process stays within 1 % after
its warm-up; stamps drift by less than 1 ms against the clock; less than one period in a thousand
is overrun. ``--minutes 60`` makes it a test of an hour. The exit code is 1 if a claim fails.
"""

import argparse
import os
import re
import struct
import sys
import tempfile
from pathlib import Path
from time import monotonic

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray

from pam_ros.nodes.demo.client import Client
from pam_ros.processes.children import Program
from pam_ros.recording.bag.source import open_bag

RATE = 1000.0  # Hz
TOPICS = ('joint_states', 'pressure', 'force', 'stiffness', 'damping', 'pressure_command')
STAMPED = TOPICS[0]  # its stamps are multiples of the period, so that they show missing messages
WARM_UP = 0.25  # share of the duration, at most LONGEST_WARM_UP
LONGEST_WARM_UP = 300.0  # s
LOOK = 2.0  # s between two looks at the memory
MOST_GROWTH, MOST_DRIFT, MOST_OVERRUNS = 0.01, 1e-3, 1e-3  # share, s, share of the periods
SUMMARY = re.compile(r'^  \S*/(\w+) +(\d+) messages +[\d.]+ Hz(?:  (\d+) lost)?', re.MULTILINE)

Claim = tuple[str, str, bool]  # its text, the measured figure, whether it holds


def memory(program: Program) -> float:
    """Return the resident memory of a process in kB."""
    text = Path(f'/proc/{program.process.pid}/status').read_text()
    (size,) = re.findall(r'^VmRSS:\s+(\d+) kB', text, re.MULTILINE)
    return float(size)


def overruns(arrays: list[DiagnosticArray]) -> dict[str, int]:
    """Return the overruns of each node since its first message in ``/diagnostics``."""
    found: dict[str, list[int]] = {}
    for array in arrays:
        for status in array.status:
            name, _, part = status.name.rpartition(': ')
            values = {pair.key: pair.value for pair in status.values}
            if part == 'timing':
                found.setdefault(name, []).append(int(values['overruns']))
    return {name: counts[-1] - counts[0] for name, counts in found.items()}


def stamps(bag: Path, space: str) -> tuple[np.ndarray, np.ndarray]:
    """Return when the messages of STAMPED were received, and their stamps, in ns."""
    source = open_bag(bag)
    rows = []
    for message in source.messages([f'{space}/{STAMPED}']):
        second, nanosecond = struct.unpack_from('<iI', message.data, 4)  # after the CDR header
        rows.append((message.stamp, second * 10**9 + nanosecond))
    received, stamped = np.array(rows, dtype=np.int64).T
    return received, stamped


def of_messages(output: str, stamped: np.ndarray) -> list[Claim]:
    """Print what was published, recorded and lost of each topic; return the claims."""
    found = {topic: (int(n), int(lost or 0)) for topic, n, lost in SUMMARY.findall(output)}
    print(f'{"topic":18} {"published":>10} {"recorded":>10} {"lost":>6}')
    claims = []
    for topic in TOPICS:
        recorded, lost = found.get(topic, (0, 0))
        print(f'{topic:18} {recorded + lost:10} {recorded:10} {lost:6}')
        claims.append((f'{topic}: lost', str(lost), recorded > 0 and lost == 0))
    periods = round((stamped[-1] - stamped[0]) * 1e-9 * RATE) + 1
    gaps = periods - len(stamped)
    claims.append((f'{STAMPED}: stamps that are missing', str(gaps), gaps == 0))
    return claims


def of_stamps(received: np.ndarray, stamped: np.ndarray) -> Claim:
    """Return the claim about the drift: the change of the least delay from beginning to end.

    The least delay is that of a message that did not have to wait, even on a busy machine.
    """
    delay = (received - stamped) * 1e-9
    part = max(len(delay) // 10, 1)
    drift = delay[-part:].min() - delay[:part].min()
    return 'drift of the stamps (us)', f'{1e6 * drift:.1f}', bool(abs(drift) < MOST_DRIFT)


def of_memory(name: str, seen: list[tuple[float, float]], duration: float) -> Claim:
    """Return the claim about one process, from times in s and memory in kB."""
    begin = min(WARM_UP * duration, LONGEST_WARM_UP)
    sizes = np.array([size for time, size in seen if time >= begin])
    growth = np.abs(sizes / sizes[0] - 1.0).max()
    print(
        f'{name:18} {seen[0][1] / 1e3:10.1f} {sizes[0] / 1e3:10.1f} {sizes[-1] / 1e3:10.1f} '
        f'{sizes.max() / 1e3:10.1f}'
    )
    return f'{name}: memory differs by (%)', f'{100 * growth:.2f}', bool(growth <= MOST_GROWTH)


def run(duration: float, folder: Path) -> list[Claim]:
    """Run all programs for *duration* s; print the tables and return the claims."""
    space = f'/soak_{os.getpid()}'
    where, bag = ('-r', f'__ns:={space}'), folder / 'bag'
    sim = {'publish_rate': RATE, 'physics_rate': RATE, 'initial.pressure': 300e3}
    seen: dict[str, list[tuple[float, float]]] = {}
    with (
        Client(space) as client,
        Program('pam_record', *where, '--', '-o', str(bag)) as recorder,
        Program('pam_sim', *where, parameters=sim) as simulator,
        Program('pam_control', *where, parameters={'rate': RATE, 'mass': 20.0}) as controller,
    ):
        arrays = client.collect(DiagnosticArray, '/diagnostics')
        client.until((bag / 'metadata.yaml').exists, 'a bag on the disk')
        client.until(lambda: len(overruns(arrays)) == 2, 'both nodes')
        programs = (simulator, controller, recorder)
        begin = monotonic()
        while (passed := monotonic() - begin) < duration:
            for one in programs:
                seen.setdefault(one.name, []).append((passed, memory(one)))
            client.work(min(LOOK, duration - passed))
        # The recorder stops first, while the others still publish, so that no message is missing.
        recorder.stop()
        late, output = overruns(arrays), recorder.output
    received, stamped = stamps(bag, space)
    claims = of_messages(output, stamped)
    print(f'\n{"memory in MB":18} {"at first":>10} {"warm":>10} {"at last":>10} {"most":>10}')
    claims += [of_memory(name, sizes, duration) for name, sizes in seen.items()]
    claims.append(of_stamps(received, stamped))
    for name, count in late.items():
        is_few = count <= MOST_OVERRUNS * RATE * duration
        claims.append((f'{name.rpartition("/")[2]}: overruns', str(count), is_few))
    return claims


def main() -> None:
    """Measure, print the tables with the verdicts, and exit with 1 if a claim fails."""
    parser = argparse.ArgumentParser(prog='soak')
    parser.add_argument('--minutes', type=float, default=3.0, help='duration (default: 3)')
    minutes = parser.parse_args().minutes
    # Keep out nodes of other machines.
    os.environ.setdefault('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    load = os.getloadavg()[0]
    print(f'{minutes:g} min at {RATE:g} Hz; load {load:.1f} on {os.cpu_count()} cores before')
    with tempfile.TemporaryDirectory() as folder:
        claims = run(60.0 * minutes, Path(folder))
    print()
    for what, figure, holds in claims:
        print(f'{what:42} {figure:>10}  {"as claimed" if holds else "NOT AS CLAIMED"}')
    sys.exit(0 if all(holds for _, _, holds in claims) else 1)


if __name__ == '__main__':
    main()
