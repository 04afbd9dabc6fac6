# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The experiment of the paper over topics: 20 kg released at 600 kPa, then pressure steps."""

from itertools import pairwise

from std_srvs.srv import Trigger

from pam_ros.demo import paper
from pam_ros.demo.run import PublishedRun
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.rig_log import RigLog, lose_nothing, seconds
from pam_ros.nodes.demo.stage import Stage, hold_pressure
from pam_ros.processes.children import Program
from pam_ros.settings.load import load_joint

MUSCLE = 'dmsp_20_400n'
RELEASE = 3.0  # s
STEPS = (500e3, 400e3, 300e3, 450e3, 600e3)  # Pa
STEP = 2.0  # s


def play(stage: Stage) -> None:
    """Run the experiment, and write figures 5 and 6, the steps and the table."""
    stage.say(f'The experiment of the paper: {MUSCLE}, 600 kPa, 20 kg, over ROS topics')
    released, steps = record(stage)
    model = load_joint(MUSCLE, mass=paper.MASS)
    stage.say('  drawing')
    from pam_ros.demo import figures

    for name, figure in (
        ('figure_5.png', figures.figure_5(released, model)),
        ('figure_6.png', figures.figure_6(released, model)),
        ('pressure_steps.png', figures.figure_steps(steps, model)),
    ):
        figures.save(figure, stage.folder / name)
        stage.wrote(stage.folder / name)
    rows = [*paper.compare(released, model), *paper.steps(steps, model)]
    stage.text('paper.txt', paper.table(rows))


def record(stage: Stage) -> tuple[PublishedRun, list[PublishedRun]]:
    """Return the run of the released load, and one run for each pressure step."""
    remap = ('-r', f'__ns:={stage.namespace}')
    given = {
        'muscle': MUSCLE,
        'mass': paper.MASS,
        'initial.pressure': paper.PRESSURE,
        'initial.at_rest': False,
        'initial.position': 0.0,
        **lose_nothing(stage.namespace),
    }
    with Program('pam_sim', *remap, parameters=given) as sim, Client(stage.namespace) as client:
        log = RigLog(client)
        client.until(lambda: log.states or not sim.is_running, 'the first state of pam_sim')
        received = len(log.states)
        client.call(Trigger, 'pam_sim/reset')

        def released() -> list[float]:
            return [seconds(m) for m in log.states[received:] if m.position[0] == 0.0]

        (begin, *_) = client.until(released, 'the release')
        hold_pressure(client, paper.PRESSURE, RELEASE, lambda: log.now, 'released at 600 kPa')
        marks = [log.now]
        for pressure in STEPS:
            what = f'step to {pressure / 1e3:.0f} kPa'
            hold_pressure(client, pressure, STEP, lambda: log.now, what)
            marks.append(log.now)
        run = log.put_in_step()
    parts = [run.between(a, b) for a, b in pairwise(marks)]
    return run.between(begin, marks[0]), parts
