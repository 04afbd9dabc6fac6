# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What the cells of a notebook print and draw, and how two runs of it differ."""

import re

NUMBER = re.compile(r'[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?')
CLOSE = 0.01  # of a number: fits end a little apart where libraries differ


def code_cells(notebook):
    return [cell for cell in notebook['cells'] if cell['cell_type'] == 'code']


def text(value):
    """Return a text, which files of notebooks have as a list of lines."""
    return value if isinstance(value, str) else ''.join(value)


def printed(cell):
    """Return what a cell printed, what it complained of, and the kinds of what else it showed."""
    streams = {'stdout': '', 'stderr': ''}
    shown = []
    for output in cell['outputs']:
        if output['output_type'] == 'stream':
            streams[output['name']] += text(output['text'])
        else:
            shown.append(sorted(output.get('data', {'error': ''})))
    return streams['stdout'], streams['stderr'], shown


def alike(stored, found):
    """Return whether two texts are the same, but for numbers that are close.

    A number with decimals may differ by one in its last place; every number by a part of it.
    """
    if NUMBER.sub('#', stored) != NUMBER.sub('#', found):
        return False
    return all(
        abs(float(one) - float(other)) <= max(CLOSE * abs(float(one)), 1.01 * last_place(one))
        for one, other in zip(NUMBER.findall(stored), NUMBER.findall(found), strict=True)
    )


def last_place(number):
    """Return what the last decimal of a printed number stands for, 0 where it has none."""
    digits, _, exponent = number.partition('e')
    decimals = len(digits.partition('.')[2])
    return 10.0 ** (int(exponent or 0) - decimals) if decimals else 0.0


def differences(stored, run):
    """Return a text for each cell of *run* whose outputs are not those of *stored*."""
    found = []
    for k, (before, after) in enumerate(zip(code_cells(stored), code_cells(run), strict=True)):
        (said, _, shown), (says, complaint, shows) = printed(before), printed(after)
        if complaint:
            found.append(f'code cell {k + 1} complains: {complaint}')
        if not alike(said, says):
            found.append(f'code cell {k + 1} has stored\n{said}\nand prints\n{says}')
        if shown != shows:
            found.append(f'code cell {k + 1} has stored {shown} and shows {shows}')
    return found
