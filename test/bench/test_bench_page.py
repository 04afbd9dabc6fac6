# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The page on the bench has all scores, references, keys and options; its scenario is valid."""

import pytest
import yaml

from pam_ros.bench.controllers import OWN
from pam_ros.bench.faults import KINDS, CommandFaults, StateFaults, messages_of, outages_of
from pam_ros.bench.references import REFERENCES
from pam_ros.bench.scenario import KEYS, TABLES, read_scenario
from pam_ros.bench.scores import SCORES
from pam_ros.cli.pam_bench import parser
from pam_ros.parameters import described
from support.pages import DOCS, blocks, code, names, rows, text_of

PAGE = DOCS / 'bench.md'
UNITS = {'position': 'm or rad', 'percent': '%', 'um/N': 'µm/N'}


def marked(name):
    """Return the rows of the table between two comments with this *name*."""
    return rows(text_of(PAGE).partition(f'<!-- {name} -->')[2].partition(f'<!-- /{name} -->')[0])


def test_scores():
    assert marked('scores') == [
        [f'`{one.name}`', UNITS.get(one.unit, one.unit), one.text] for one in SCORES
    ]


def test_references():
    found = {code(kind)[0]: set(code(given)) for kind, given, _ in marked('references')}
    assert found == {kind: {*described(cls)} - {'time'} for kind, cls in REFERENCES.items()}


def test_messages_and_outages():
    kinds = {'states': StateFaults, 'commands': CommandFaults}
    assert marked('messages') == [
        [f'`{part}.{name}`', '0 s' if about.unit else '0', f'{about.text}, {about.allowed()}']
        for part, cls in kinds.items()
        for name, (_, _, about) in described(cls).items()
    ]
    assert [code(kind)[0] for kind, *_ in marked('outages')] == [*KINDS]
    _, messages, outages = (yaml.safe_load(text) for text in blocks(PAGE, 'yaml')[:3])
    assert messages_of(messages['messages']).commands.jitter == 0.004
    assert [one.kind for one in outages_of(outages['outages'], 14.0)] == ['freeze', 'stop']


def test_keys_options_and_controllers():
    named = {word for text in names(PAGE) for word in (text, *text.split())}
    options = {
        option
        for action in parser()._actions
        for option in action.option_strings
        if len(option) > 2 and option not in ('--help', '--version')
    }
    assert {*KEYS, *TABLES, *options} <= named
    assert {*OWN} <= named | {'pam_control'}


@pytest.mark.parametrize('k', [0])
def test_the_scenario(tmp_path, k):
    path = tmp_path / 'mine.yaml'
    path.write_text(blocks(PAGE, 'yaml')[k], encoding='utf-8')
    assert len(read_scenario(path).changes) == 1
