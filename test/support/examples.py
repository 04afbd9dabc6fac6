# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How an example of a page is run: it prints what its comments say, in their order.

``print(...)  # text`` says that this text is printed.
"""

import contextlib
import io
import re

from sybil.evaluators.python import PythonEvaluator

# The comment after a print, which may go over several lines.
SAYS = re.compile(r'^(?: *print\(.*)?\)  # (.*)$', re.MULTILINE)
run = PythonEvaluator()


def evaluate(example):
    """Run an example of Sybil; return what is wrong with what it prints, None if nothing is."""
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        run(example)
    lines = iter(printed.getvalue().splitlines())
    for text in SAYS.findall(example.parsed):
        if text not in lines:  # what comes before it is passed over
            return f'{text!r} is not printed in its place, but:\n{printed.getvalue()}'
    if 'print(' in example.parsed and not printed.getvalue():
        return 'nothing is printed'
    return None
