# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The whole procedure over topics: excite, record and identify a rig, then simulate it better.

``pam_sim`` represents the rig, with effects that no other program is given. ``pam_excite`` plays
its programme, ``pam_record`` writes a rosbag2, ``pam_identify`` finds the effects that the nominal
model lacks.
Then the rig runs once more with commands that were not used for the fit. Two simulators run next
to it, one with the nominal model and one with ``identified.yaml``; all three receive the same
commands.
"""

import json
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Float64
from tqdm import tqdm

from pam_ros.demo import loop
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.stage import Stage
from pam_ros.processes.children import Program

EXCITATION: Mapping[str, Any] = {
    'muscle': loop.MUSCLE,
    'duration': 30.0,  # s, the shortest programme
    'pressure_min': 150e3,
    'pressure_max': 400e3,
    'countdown': 2.0,  # s
    'rate': 100.0,
    'silence': 3.0,  # s; long, since a simulated rig endangers no person
}
UNSEEN = {**EXCITATION, 'seed': 1}
RATE = 200.0  # states per second
LATE = 0.1  # s by which a simulator may be late
TOO_BUSY = 'this machine is too busy for real time'


def play(stage: Stage) -> None:
    """Excite, record, identify, replay; write the bags, the report, a plot and a table."""
    folder = stage.folder / 'loop'
    folder.mkdir(parents=True, exist_ok=True)
    stage.say(f'Closing the loop: what does a rig have that {loop.MUSCLE} has not?')
    record_in_time(stage, folder / 'recording', {'rig': loop.HIDDEN}, EXCITATION)
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
    record_in_time(stage, folder / 'replay', again, UNSEEN)
    command, *spaces = (f'{stage.namespace}/{name}' for name in ('pressure_command', *again))
    replay = loop.read_replay(folder / 'replay', command, *spaces)
    from pam_ros.demo import figures

    figures.save(loop.figure(replay), folder / 'before_and_after.png')
    stage.wrote(folder / 'before_and_after.png')
    stage.text('loop/before_and_after.txt', loop.table(replay, report))


def record_in_time(
    stage: Stage, bag: Path, rigs: Mapping[str, Mapping[str, Any]], excitation: Mapping[str, Any]
) -> None:
    """Record as :func:`record` does, a second time if the machine was too busy for real time.

    If a simulator is late, a command acts later than the recording shows. The better of the two
    recordings is kept.
    """
    shutil.rmtree(bag, ignore_errors=True)
    late = record(stage, bag, rigs, excitation)
    if late > LATE:
        stage.say(
            f'  this machine is busy: a simulator stood still for {1e3 * late:.0f} ms; again'
        )
        with TemporaryDirectory(dir=bag.parent) as folder:
            again = Path(folder) / bag.name
            late_again = record(stage, again, rigs, excitation)
            if late_again < late:
                shutil.rmtree(bag)
                again.rename(bag)
                late = late_again
        if late > LATE:
            stage.say(f'  {TOO_BUSY}: the results will show it ({1e3 * late:.0f} ms)')
    stage.wrote(bag)


def record(
    stage: Stage, bag: Path, rigs: Mapping[str, Mapping[str, Any]], excitation: Mapping[str, Any]
) -> float:
    """Record the simulated *rigs* (name -> parameters) to *bag*; the first of them is excited.

    All receive the same commands, those of pam_excite with the parameters *excitation*. Return
    the worst lateness of the rigs in s.
    Raises PamError if the excitation stopped early.
    """
    space = stage.namespace
    states = [f'{space}/{name}/joint_states' for name in rigs]
    commands = ('-r', f'pressure_command:={space}/pressure_command')
    with ExitStack() as programs, Client(space) as client:
        running = []
        for name, given in rigs.items():
            where = ('-r', f'__ns:={space}/{name}')
            parameters = {**given, 'publish_rate': RATE}
            running.append(Program('pam_sim', *where, *commands, parameters=parameters))
            programs.enter_context(running[-1])
        recorder = Program('pam_record', '-r', f'__ns:={space}', '--', *states, '-o', str(bag))
        running.append(programs.enter_context(recorder))
        # The recorder subscribes to topics with a publisher: without this one it would be late.
        publisher = client.node.create_publisher(Float64, 'pressure_command', 1)

        def is_ready() -> bool:
            for program in running:
                if not program.is_running:
                    raise PamError(f'{program.name} ended: {program.output.strip()}')
            return publisher.get_subscription_count() > len(rigs) and all(
                client.node.count_subscribers(topic) for topic in states
            )

        client.until(is_ready, 'the rigs and the recorder')
        client.node.destroy_publisher(publisher)
        watch = ('-r', f'__ns:={space}', '-r', f'joint_states:={states[0]}')
        reports = client.collect(DiagnosticArray, '/diagnostics')
        with Program('pam_excite', *watch, parameters=excitation) as excite:
            show(client, excite, excitation['duration'])
            if excite.wait():
                raise PamError(f'pam_excite stopped: {excite.output.splitlines()[-1]}')
        recorder.stop()
        return worst_lateness(reports, space)


def worst_lateness(reports: list[DiagnosticArray], space: str) -> float:
    """Return the worst lateness in s that simulators in a namespace have reported."""
    values = [
        float(item.value)
        for report in reports
        for status in report.status
        if status.hardware_id.startswith(space.strip('/'))
        for item in status.values
        if item.key == 'worst lateness (s)'
    ]
    return max(values, default=0.0)


def show(client: Client, excite: Program, duration: float) -> None:
    """Show the progress of the excitation until it ends."""
    pause = 0.1 if sys.stderr.isatty() else 5.0
    form = '  {desc:<20} {bar:30} {n:4.1f} of {total:g} s'
    with tqdm(total=duration, desc='exciting', bar_format=form, mininterval=pause) as bar:
        while excite.is_running:
            client.work(0.2)
            if 'vented' in excite.output:
                bar.update(min(0.2, duration - bar.n))


def identify(stage: Stage, folder: Path) -> dict[str, Any]:
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
