# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Programs that end by themselves, such as those with bad arguments, many in the time of one.

What a program imports takes a second. So one process imports it, and forks a process for each
run, whose exit code and output are those of the program.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import traceback
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

DEADLINE = 60  # s; it only bounds how long a program that does not end may hang a test


class End(NamedTuple):
    """How a program ended, and what it printed."""

    code: int
    output: str

    @property
    def sentence(self):
        """The last line of the output."""
        return self.output.splitlines()[-1] if self.output else ''


def ends(name, runs, *, is_once=False):
    """Run the program ``pam_ros.cli.<name>`` with each of these ROS arguments; return the Ends.

    With *is_once* a node whose arguments are good ticks once, and ends.
    """
    given = [name, is_once, *(['--ros-args', *arguments] for arguments in runs)]
    done = subprocess.run(
        [sys.executable, __file__],
        input=json.dumps(given),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return [End(*each) for each in json.loads(done.stdout)]


def check_refusals(name, refusals):
    """Check that each of *refusals*, (arguments, words), ends with 2 and a sentence with words."""
    found = ends(name, [arguments for arguments, _ in refusals])
    for (arguments, words), end in zip(refusals, found, strict=True):
        assert end.code == 2, (arguments, end)
        assert end.sentence.startswith(f'{name}: '), (arguments, end)
        assert 'Traceback' not in end.output, (arguments, end)
        assert '.c:' not in end.sentence, (arguments, end)
        for word in words:
            assert word in end.sentence, (arguments, word, end)


def _run(main, arguments):
    """Run *main* in a new process; return its exit code and what it printed."""
    with tempfile.TemporaryFile('w+') as output:
        child = os.fork()
        if not child:
            os.dup2(output.fileno(), 1)
            os.dup2(output.fileno(), 2)
            signal.alarm(DEADLINE)
            code = 1
            try:
                sys.argv[1:] = arguments
                main()
            except SystemExit as end:
                code = end.code or 0
            except BaseException:
                traceback.print_exc()
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
        _, status = os.waitpid(child, 0)
        output.seek(0)
        return os.waitstatus_to_exitcode(status), output.read()


def _main():
    name, is_once, *runs = json.load(sys.stdin)
    spin = import_module('pam_ros.nodes.common.spin')
    if is_once:
        spin.spin = lambda node, executor, stop: node.tick()
    import_module(f'pam_ros.nodes.{name.removeprefix("pam_")}.node')
    program = import_module(f'pam_ros.cli.{name}')
    sys.argv[0] = str(Path(program.__file__))
    json.dump([_run(program.main, arguments) for arguments in runs], sys.stdout)


if __name__ == '__main__':
    _main()
