# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The fingerprint of a function: all that its machine code depends on, and nothing else."""

import sys
from types import ModuleType

import pytest

from pam_ros.compiled import HAVE_NUMBA, scalar
from pam_ros.rig.fingerprint import fingerprint

# As it may be in two files of a user: an equation, and what it calls and reads.
GEOMETRY = """
WIDTH = 0.1
HEIGHT = 0.2  # nobody asks for it
"""
SOURCE = '''
from math import cos

import geometry
import numpy as np

from pam_ros.compiled import scalar

SCALE = 2.0
TABLE = np.array([1.0, 2.0])
SHARES = (TABLE, 0.25)


@scalar
def helper(v, power=1):
    return SCALE * v**power


def equation(f, v):
    """Say something."""

    def clipped(value):
        return max(value, 0.0)

    return f - helper(v) + TABLE[0] * geometry.WIDTH + SHARES[1] * clipped(v)
'''


def names_of(source, geometry=GEOMETRY, name='equations'):
    module = ModuleType('geometry')
    exec(geometry, vars(module))
    names = {'__name__': name}
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, 'geometry', module)
        exec(compile(source, 'equations.py', 'exec'), names)
    return names


def of(source, geometry=GEOMETRY):
    return fingerprint(names_of(source, geometry)['equation'])


@pytest.mark.parametrize(
    ('old', 'new'),
    [
        ('f - helper', 'f + helper'),  # another operator
        ('SCALE = 2.0', 'SCALE = 3.0'),  # another constant
        ('[1.0, 2.0]', '[1.0, 3.0]'),  # in an array
        ('[1.0, 2.0]', '[[1.0, 2.0]]'),
        ('[1.0, 2.0]', '[1.0, 2.0], np.float32'),
        ('(TABLE, 0.25)', '(TABLE, 0.5)'),
        ('(TABLE, 0.25)', '(TABLE[:1], 0.25)'),
        ('SCALE * v', 'SCALE * v * v'),  # another helper
        ('SCALE * v', 'cos(SCALE * v)'),
        ('power=1', 'power=2'),
        ('max(value, 0.0)', 'max(value, 1.0)'),  # in a function within the function
        ('max(value, 0.0)', 'min(value, 0.0)'),
    ],
)
def test_it_changes_with_the_code_and_the_constants_that_it_reads(old, new):
    changed = SOURCE.replace(old, new)
    assert changed != SOURCE
    assert of(SOURCE) != of(changed)


def test_it_changes_with_the_constants_of_other_modules():
    assert of(SOURCE) != of(SOURCE, GEOMETRY.replace('0.1', '0.3'))
    assert of(SOURCE) == of(SOURCE, GEOMETRY.replace('0.2', '0.3'))


@pytest.mark.parametrize(
    ('old', 'new'),
    [('SCALE * v**power', 'SCALE*v**power  # a comment'), ('SCALE = 2.0\n', 'SCALE = 2.0\n\n\n')],
)
def test_it_does_not_change_with_the_text_alone(old, new):
    changed = SOURCE.replace(old, new)
    assert changed != SOURCE
    assert of(SOURCE) == of(changed)


@pytest.mark.skipif(not HAVE_NUMBA, reason='nothing is kept on disk without numba')
def test_it_changes_with_the_module_of_what_numba_compiles_there():
    """With the machine code numba imports that module, but not those of helpers of ours."""
    import numba

    ours, theirs = (
        [make(names_of(SOURCE, name=name)['equation']) for name in ('one', 'other')]
        for make in (scalar, numba.njit)
    )
    assert fingerprint(ours[0]) == fingerprint(ours[1])
    assert fingerprint(theirs[0]) != fingerprint(theirs[1])
