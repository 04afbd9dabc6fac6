# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The text of ``--help``: the docstring of a program without the markup of docstrings."""

import re


def help_text(docstring: str | None) -> str:
    """Return *docstring* as a terminal shows it: without backticks, roles and asterisks.

    An empty text for None, which Python gives with the option -OO.
    """
    plain = re.sub(r':\w+:`([^`]*)`', r'\1', docstring or '')
    plain = re.sub(r'(?<![\w*])(\*+)(\w[^*]*)\1(?![\w*])', r'\2', plain)
    return plain.replace('`', '')
