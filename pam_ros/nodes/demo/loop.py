# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole procedure over topics: excite, record and identify a rig, then validate the model.

``pam_sim`` represents the rig, with effects that no other program is given. ``pam_excite`` plays
its programme, ``pam_record`` writes a rosbag2, ``pam_identify`` finds the effects that the nominal
model lacks. Then the rig runs once more with commands that were not used for the fit. Two
simulators run next to it, one with the nominal model and one with ``identified.yaml``; all three
receive the same commands at the same simulated times, since each runs in lockstep.
"""

import json
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from pam_ros.demo import loop
from pam_ros.demo.recorded_rig import RATE, RecordedRig
from pam_ros.demo.stage import DemoStage, progress
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.lockstep_pair import PATIENCE

TURN = 0.1  # s between two checks of running programs
EXCITATION: Mapping[str, Any] = {
    'muscle': loop.MUSCLE,
    'duration': 30.0,  # s, the shortest programme
    'pressure_min': 150e3,
    'pressure_max': 400e3,
    'countdown': 1.0,  # s
    # The rig and the recorder. The middleware can take 3 s to connect two programs, in which the
    # rig alone would already be excited.
    'subscribers': 2,
    'patience': 60.0,  # s
    'rate': RATE,
    'silence': 3.0,  # s; long, since a simulated rig endangers no person
}
UNSEEN = {**EXCITATION, 'seed': 1}


def play(stage: DemoStage) -> None:
    """Excite, record, identify, replay; write the bags, the report, a plot and a table."""
    folder = stage.folder / 'loop'
    folder.mkdir(parents=True, exist_ok=True)
    stage.say(
        f'Closing the loop: which effects of a rig does the nominal model {loop.MUSCLE} lack?'
    )
    record(stage, folder, {'recording': loop.HIDDEN}, EXCITATION)
    stage.wrote(folder / 'recording')
    report = identify(stage, folder)
    stage.say(
        'Commands that were not used for the fit: the rig, and pam_sim with the nominal and the '
        'identified model'
    )
    identified = {'muscle': str(folder / 'report' / 'identified.yaml')}
    again = {
        'rig': {**loop.HIDDEN, 'sensor.seed': 1},
        'nominal': {'muscle': loop.MUSCLE},
        'identified': identified,
    }
    record(stage, folder / 'replay', again, UNSEEN)
    stage.wrote(folder / 'replay')
    replay = loop.read_replay(*(folder / 'replay' / name for name in again))
    from pam_ros.demo import figures

    figures.save(loop.figure(replay), folder / 'before_and_after.png')
    stage.wrote(folder / 'before_and_after.png')
    stage.text('loop/before_and_after.txt', loop.table(replay, report))


def record(
    stage: DemoStage,
    bags: Path,
    rigs: Mapping[str, Mapping[str, Any]],
    excitation: Mapping[str, Any],
) -> None:
    """Record each of the simulated *rigs* (name -> parameters) to ``bags/<name>``.

    All receive the same commands at the same simulated times: those of pam_excite with the
    parameters *excitation*. Raises PamError if a program ends early.
    """
    with ExitStack() as programs, Client(stage.namespace, PATIENCE) as client:
        started, count = [], client.node.count_subscribers
        for name, given in rigs.items():
            shutil.rmtree(bags / name, ignore_errors=True)
            space = f'{stage.namespace}/{name}'
            started.append(RecordedRig(programs, count, space, given, bags / name))
        client.until(lambda: all(rig.is_ready for rig in started), 'the rigs and the recorders')
        times = client.collect(Clock, started[0].clock)
        for rig in started:
            rig.excite(excitation)
        show(client, started, times, excitation['duration'])
        for rig in started:
            rig.finish()


def show(client: Client, rigs: list[RecordedRig], times: list[Clock], duration: float) -> None:
    """Show the progress of the programme, in simulated time, until that of all *rigs* ends."""
    with progress(duration, 'exciting', 5.0) as bar:
        while any(rig.is_excited for rig in rigs):
            client.work(TURN)
            if times:
                first, last = (Time.from_msg(one.clock) for one in (times[0], times[-1]))
                bar.update(min(1e-9 * (last - first).nanoseconds, duration) - bar.n)


def identify(stage: DemoStage, folder: Path) -> dict[str, Any]:
    """Run ``pam_identify`` on the recording and return its report.json."""
    given = (str(folder / 'recording'), '--params', loop.MUSCLE, '--out', str(folder / 'report'))
    stage.say(f'  $ pam_identify {shlex.join(given)}')
    command = [sys.executable, '-m', 'pam_ros.cli.pam_identify', *given]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise PamError(f'pam_identify ended with code {done.returncode}')
    stage.say(f'  {done.stdout.strip()}')
    content: dict[str, Any] = json.loads(
        (folder / 'report' / 'report.json').read_text(encoding='utf-8')
    )
    return content
