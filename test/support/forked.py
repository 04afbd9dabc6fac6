# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Nodes as processes of their own, forked from one that has imported what all of them import.

A node needs a second of the processor to start, nearly all of it for imports and for kernels from
disk. Here one process, the fork server of ``multiprocessing``, does this once. It does not start
ROS, so that a forked node does everything else as one from a shell does, beginning with ``main``.
"""

import multiprocessing
import os
import subprocess
import sys
from importlib import import_module
from multiprocessing import forkserver
from pathlib import Path
from unittest import mock

OF_A_TEST = ('ROS_DOMAIN_ID', 'PYTEST_CURRENT_TEST')
CONTEXT = multiprocessing.get_context('forkserver')
RUNNING = []  # what was forked and has not ended, as far as it is known


def _environment():
    """Return the environment without what differs from test to test."""
    return {name: value for name, value in os.environ.items() if name not in OF_A_TEST}


USUAL = _environment()


def is_possible():
    """Return whether the environment is that with which the imports were made."""
    return _environment() == USUAL


def forked_in(domain):
    """Return the process ids of forked programs that run in a ROS domain."""
    RUNNING[:] = [one for one in RUNNING if one.poll() is None]
    return [one.pid for one in RUNNING if one.domain == str(domain)]


class Forked:
    """A program in a forked process, with what tests use of ``subprocess.Popen``."""

    def __init__(self, module, arguments, out):
        """Run ``main()`` of *module*; both output streams go to the open file *out*."""
        _serve()
        path = f'/proc/{os.getpid()}/fd/{out.fileno()}'
        receiver, sender = CONTEXT.Pipe(duplex=False)
        # As a daemon it ends with the tests, should one of them leave it running.
        self._process = CONTEXT.Process(
            target=_run,
            args=(module, arguments, path, dict(os.environ), str(Path.cwd()), sender),
            daemon=True,
        )
        self._process.start()
        sender.close()
        with receiver:
            receiver.recv()  # it has a session of its own
        self.args = [module, *arguments]
        self.pid = self._process.pid
        self.domain = os.environ.get('ROS_DOMAIN_ID')
        RUNNING.append(self)

    def poll(self):
        return self._process.exitcode

    def wait(self, timeout=None):
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(self.args, timeout)
        return self._process.exitcode

    def kill(self):
        self._process.kill()


def _serve():
    """Start the fork server, if it does not run."""
    # Before Python 3.13 it knows no other folders when it imports than those of the environment.
    folders = os.pathsep.join(filter(None, sys.path))
    with mock.patch.dict(os.environ, {**USUAL, 'PYTHONPATH': folders}, clear=True):
        CONTEXT.set_forkserver_preload(['support.imported'])
        forkserver.ensure_running()


def _run(module, arguments, path, variables, folder, sender):
    """Become the program: session, output, environment and folder."""
    os.setsid()
    with Path(path).open('a') as out:
        os.dup2(out.fileno(), 1)
        os.dup2(out.fileno(), 2)
    os.environ.clear()
    os.environ.update(variables)
    os.chdir(folder)
    program = import_module(module)
    sys.argv[:] = [str(Path(program.__file__)), *arguments]
    with sender:
        sender.send(True)
    program.main()
