# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A simulator, a controller and a recorder on a network that loses packets; a program of its own.

    python -m support.lossy_rig FOLDER

It is started in a network namespace of its own, by :func:`run`. It moves the load, holds it, ends
the programs, and prints what it saw as JSON.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from support.harness import PEER_DEADLINE, Peer
from support.station import Station, fastest

MOVES, HELD = 3, 5.0  # s
# As docs/simulator.md says for such networks: a command that is sent again delays no later one.
NEWEST = {'qos_overrides./pressure_command.subscription.reliability': 'best_effort'}
TEST = Path(__file__).parents[1]
# A private network: its loopback interface drops this share of all UDP packets on receipt.
# It is not done with the kernel's netem, which fewer kernels have.
RULES = """
table inet loss {{
  chain input {{
    type filter hook input priority 0;
    meta l4proto udp numgen random mod 1000 < {permille} counter drop
  }}
}}
"""
SCRIPT = 'set -e; ip link set lo up; printf %s "$RULES" | nft -f -; exec "$@"'
PRIVATE = ('unshare', '--net', '--map-root-user')


def obstacle():
    """Return why this machine cannot lose packets, empty if it can."""
    missing = [name for name in ('unshare', 'ip', 'nft') if shutil.which(name) is None]
    if missing:
        return (
            f'{" and ".join(missing)} is not installed (packages util-linux, iproute2, nftables)'
        )
    tried = _in_lossy_network(500, 'true', timeout=30.0)
    return '' if tried.returncode == 0 else tried.stderr.strip().splitlines()[-1]


def run(percent, folder):
    """Return what the program saw while *percent* % of the packets were lost."""
    done = _in_lossy_network(
        10 * percent, sys.executable, '-m', __name__, str(folder), timeout=3 * PEER_DEADLINE
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def _in_lossy_network(permille, *command, timeout):
    path = os.pathsep.join(map(str, (TEST, TEST.parent)))
    return subprocess.run(
        [*PRIVATE, 'sh', '-c', SCRIPT, 'sh', *command],
        env={**os.environ, 'RULES': RULES.format(permille=permille), 'PYTHONPATH': path},
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )


def dropped():
    """Return the number of packets that were lost until now."""
    told = subprocess.run(['nft', '-j', 'list', 'ruleset'], check=True, capture_output=True)
    (rule,) = [one['rule'] for one in json.loads(told.stdout)['nftables'] if 'rule' in one]
    (counter,) = [one['counter'] for one in rule['expr'] if 'counter' in one]
    return counter['packets']


def main(folder):
    """Move and hold the load; return what was seen, in SI units."""
    with Peer() as peer, Station(peer, folder, **NEWEST) as station:
        for _ in range(MOVES):
            station.move()
        since = len(station.states)
        peer.work(HELD)
        held = [one.position[0] for one in station.states[since:]]
        ends = {
            name: station.end(name, signal.SIGINT)
            for name in ('pam_record', 'pam_control', 'pam_sim')
        }
        return {
            'fastest': fastest(station.states),
            'moved': max(held) - min(held),
            'states': len(station.states),
            'bag': str(station.bag),
            'ends': ends,
            'dropped': dropped(),
        }


if __name__ == '__main__':
    print(json.dumps(main(Path(sys.argv[1]))))
