# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The experiment of the paper over topics: 20 kg released at 600 kPa, then pressure steps."""

from itertools import pairwise

from std_msgs.msg import Float64

from pam_ros.demo import paper
from pam_ros.demo.run import PublishedRun
from pam_ros.demo.stage import DemoStage
from pam_ros.errors import PamError
from pam_ros.nodes.demo.client import Client
from pam_ros.nodes.demo.lockstep_pair import PATIENCE
from pam_ros.nodes.demo.rig_log import RigLog
from pam_ros.processes.children import Program
from pam_ros.settings.load import load_joint

MUSCLE = 'dmsp_20_400n'
RELEASE = 3.0  # s
STEPS = (500e3, 400e3, 300e3, 450e3, 600e3)  # Pa
STEP = 2.0  # s
RATE = 250.0  # Hz


def play(stage: DemoStage) -> None:
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


def record(stage: DemoStage) -> tuple[PublishedRun, list[PublishedRun]]:
    """Return the run of the released load, and one run for each pressure step."""
    space = stage.namespace
    # Its /clock is in its namespace: no other node follows it.
    remap = ('-r', f'__ns:={space}', '-r', f'/clock:={space}/clock')
    given = {
        'muscle': MUSCLE,
        'mass': paper.MASS,
        'initial.pressure': paper.PRESSURE,
        'initial.at_rest': False,
        'initial.position': 0.0,
        'time_mode': 'lockstep',
        'publish_rate': RATE,
    }
    with Program('pam_sim', *remap, parameters=given) as sim, Client(space, PATIENCE) as client:
        log = RigLog(client)
        client.until(lambda: log.has_begun or not sim.is_running, 'the first state of pam_sim')
        if not sim.is_running:
            raise PamError(f'pam_sim ended: {sim.output.strip()}')
        begin = log.now
        log.hold(Float64(data=paper.PRESSURE), RELEASE, 'released at 600 kPa')
        marks = [log.now]
        for pressure in STEPS:
            log.hold(Float64(data=pressure), STEP, f'step to {pressure / 1e3:.0f} kPa')
            marks.append(log.now)
        run = log.run()
    parts = [run.between(a, b) for a, b in pairwise(marks)]
    return run.between(begin, marks[0]), parts
