# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run the benchmarks: ``python -m benchmarks`` for all, ``python -m benchmarks NAME...`` for some.

If there is only one name, options of this benchmark may follow it.
A benchmark is a module of this folder with a function ``main()`` that measures and prints its
table; modules whose name starts with an underscore are their helpers. Each runs in a process of
its own, so that it is not influenced by the others.
"""

import subprocess
import sys
from itertools import takewhile
from pathlib import Path

HERE = Path(__file__).parent
# The benchmark reads its options from sys.argv, like a program.
RUN_ONE = (
    'import importlib, sys; sys.argv = sys.argv[1:]; '
    'importlib.import_module("benchmarks." + sys.argv[0]).main()'
)


def names() -> list[str]:
    """Return the names of all benchmarks."""
    return sorted(path.stem for path in HERE.glob('*.py') if not path.stem.startswith('_'))


def main(given: list[str]) -> int:
    """Run the benchmarks that are *given*, all if there are none; return the exit code."""
    known, wanted = names(), list(takewhile(lambda word: not word.startswith('-'), given))
    options = given[len(wanted) :]
    if options and len(wanted) != 1:
        print(f'{options[0]} is an option of one benchmark: give its name before', file=sys.stderr)
        return 2
    for name in wanted:
        if name not in known:
            print(f'{name} is not a benchmark: give one of {", ".join(known)}', file=sys.stderr)
            return 2
    failed = []
    for name in wanted or known:
        print(f'== {name}', flush=True)
        command = [sys.executable, '-c', RUN_ONE, name, *options]
        done = subprocess.run(command, cwd=HERE.parent, check=False)
        if done.returncode:
            failed.append(name)
        print(flush=True)
    if failed:
        print(f'failed: {", ".join(failed)}', file=sys.stderr)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
