# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster of real processes: a scheduler, and workers that come and go."""

import os
import signal
import socket
import subprocess
import sys


class DaskCluster:
    """A scheduler at a port of its own, and workers; all end with the context."""

    def __init__(self, folder):
        """Keep files of Dask, and what it prints, in *folder*."""
        self._folder = folder
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            self._port = free.getsockname()[1]
        self.address = f'tcp://127.0.0.1:{self._port}'
        self._log = (folder / 'dask.log').open('w', encoding='utf-8')
        self.scheduler, self.workers = None, []

    def __enter__(self):
        """Return the cluster, which is empty."""
        return self

    def __exit__(self, *_):
        """End all."""
        for process in (*self.workers, self.scheduler):
            if process is not None:
                kill(process)
        self._log.close()

    def start_scheduler(self):
        """Start a scheduler at the address of the cluster."""
        port = ['--port', str(self._port), '--host', '127.0.0.1', '--no-dashboard']
        self.scheduler = self._started('dask_scheduler', *port)

    def start_worker(self):
        """Start a worker with one thread, and return its process, that of its nanny."""
        place = ['--local-directory', str(self._folder), '--no-dashboard']
        worker = self._started('dask_worker', self.address, '--nthreads', '1', *place)
        self.workers.append(worker)
        return worker

    def _started(self, program, *arguments):
        return subprocess.Popen(
            [sys.executable, '-m', f'distributed.cli.{program}', *arguments],
            stdout=self._log,
            stderr=self._log,
            env={**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))},
            start_new_session=True,
        )


def kill(process):
    """Kill a process, and those in its session."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        return
    process.wait()
