# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Command lines of all programs with something wrong: exit code 2 and a sentence, or accepted.

A node that accepts its command line is made, ticks once and ends with 0.
"""

import random

import pytest

from pam_ros.cli import pam_bench, pam_demo, pam_identify
from pam_ros.settings.control import settings_of
from pam_ros.settings.scene import Scene
from support.bad_values import TEXTS
from support.ends import ends

QUICK, FULL = 12, 200  # command lines of each node
GOOD = 0.6  # share of the parameters that have their default
# The parameters of each node, with their defaults as texts.
NODES = {
    'pam_sim': {name: entry[1] for name, entry in Scene({}).table().items()},
    'pam_control': {name: entry[1] for name, entry in settings_of({})[0].items()},
    'pam_plot': {'use_sim_time': False},
    'pam_record': {'use_sim_time': False},
    'pam_excite': {'rate': 100.0, 'silence': 0.5, 'muscle': ''},
}
# No process can be given these.
USABLE = [text for text in TEXTS if '\0' not in text]
WORDS = (
    *('--nonsense', '-x', '--', '-p', '-r', '--params-file', '--ros-args', '-p a', 'a:=1', ':='),
    *('-p :=', '--params-file=/', '/dev/null', '-r a:=', '-r __ns:=1', '-r __node:=a b', 'ä', ''),
)


def command_lines(name, count):
    """Return so many command lines for a node, the same in each run."""
    chance = random.Random(name)
    found = []
    for k in range(count):
        line = []
        for _ in range(chance.randint(1, 2)):
            parameter, default = chance.choice(list(NODES[name].items()))
            good = f"'{default}'" if isinstance(default, str) else str(default).lower()
            is_good = chance.random() < GOOD and default != ()
            line += ['-p', f'{parameter}:={good if is_good else chance.choice(USABLE)}']
        if k % 4 == 0:
            line += chance.choice(WORDS).split(' ')
        found.append(line)
    return found


@pytest.mark.slow
@pytest.mark.at_any_pace
@pytest.mark.parametrize('name', NODES)
def test_a_node(name, domain, request, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # A node has signal handlers, outputs and a context of its own: each runs in a process.
    lines = command_lines(name, FULL if request.config.getoption('full') else QUICK)
    for line, end in zip(lines, ends(name, lines, is_once=True), strict=True):
        assert end.code in (0, 2), (line, end)
        assert 'Traceback' not in end.output, (line, end)
        assert 'Warning' not in end.output, (line, end)
        if end.code:
            assert f'{name}: ' in end.output, (line, end)


@pytest.mark.parametrize(
    ('main', 'before'),
    [
        (pam_identify.main, []),
        (pam_identify.main, ['nowhere.csv', '--out', 'found']),
        (pam_identify.main, ['nowhere.csv', '--out', 'found', '--params']),
        (
            pam_identify.main,
            ['nowhere.csv', '--params', 'dmsp_20_400n', '--out', 'found', '--set'],
        ),
        (pam_demo.main, []),
        (pam_bench.main, []),
        (pam_bench.main, ['pid', '--out', 'bench']),
    ],
)
@pytest.mark.parametrize('word', [*USABLE, *WORDS])
def test_a_program_without_ros(main, before, word, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if main is pam_demo.main:
        before, word = ['--out', 'found'], f'no {word}'
    monkeypatch.setattr('sys.argv', ['program', *before, word])
    # What a program does to its process is not to stay in the one of the tests.
    monkeypatch.setattr(main.__module__ + '.guard_outputs', lambda: None)
    monkeypatch.setattr('signal.signal', lambda kind, handler: None)
    with pytest.raises(SystemExit) as end:
        main()
    output = ''.join(capsys.readouterr())
    assert end.value.code == 2
    assert output.strip()
    assert 'Traceback' not in output
