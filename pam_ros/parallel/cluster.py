# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks on the workers of a Dask cluster."""

import pickle
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack, closing, contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any
from uuid import uuid4

from pam_ros.errors import PamError
from pam_ros.parallel.sources import digest_of_sources
from pam_ros.parallel.tasks import Failure, Prepare, Replies
from pam_ros.parallel.worker import Session, end_session, reply_on_worker

PACKAGE = 'pam_ros'
LOCAL = 'local'  # instead of an address: a cluster on this machine, for as long as it is needed
CONNECT = 10.0  # s within which a scheduler must answer
RECONNECT = 300.0  # s within which a scheduler that was lost must answer again
LOOK = 1.0  # s between two looks at the cluster
IDLE = 10  # looks without a worker after which this is said


class ClusterPool:
    """The workers of a Dask cluster (``distributed``).

    A task that is lost with its worker is repeated by the scheduler. If the scheduler is lost, it
    is awaited, and the tasks without a reply are given to it again.
    """

    def __init__(self, address: str) -> None:
        """Use the scheduler at *address*, or of the scheduler file with this path, or LOCAL.

        Raises PamError if ``distributed`` is not installed.
        """
        try:
            import distributed
        except ModuleNotFoundError:
            raise PamError(
                'Dask is not installed: pip install distributed, here and on the workers'
            ) from None
        self._distributed: Any = distributed
        self._address = address

    def run(self, calls: Sequence[bytes], prepare: Prepare) -> Replies:
        """Yield the number of each of the *calls*, with its reply, as they end; see ``Pool``.

        Raises PamError if no scheduler answers, or a worker cannot run the calls.
        """
        rest = dict(enumerate(calls))
        patience = CONNECT
        with ExitStack() as stack:
            where = self._where(stack)
            while rest:
                with (
                    self._client(where, patience) as client,
                    closing(self._replies(client, rest, prepare)) as replies,
                ):
                    for number, reply in replies:
                        del rest[number]
                        yield number, reply
                if rest:
                    _say(f'{self._address} does not answer: waits up to {RECONNECT:g} s for it')
                patience = RECONNECT

    def _where(self, stack: ExitStack) -> dict[str, str]:
        """Return where the scheduler is, as arguments of a client; start it if it is LOCAL."""
        if self._address == LOCAL:
            # One worker in this process, with a thread for each core: tasks have processes anyway.
            cluster = self._distributed.LocalCluster(
                processes=False, dashboard_address=None, silence_logs='CRITICAL'
            )
            return {'address': stack.enter_context(cluster).scheduler_address}
        if Path(self._address).is_file():
            return {'scheduler_file': self._address}
        return {'address': self._address}

    def _client(self, where: dict[str, str], patience: float) -> Any:
        try:
            return self._distributed.Client(**where, timeout=patience, name='pam_ros')
        except OSError as error:  # also a TimeoutError
            raise PamError(
                f'no scheduler of Dask answers at {self._address} within {patience:g} s'
            ) from error
        except ValueError as error:
            raise PamError(
                f'{self._address} is not an address of a scheduler of Dask: {error}'
            ) from error

    def _replies(self, client: Any, calls: dict[int, bytes], prepare: Prepare) -> Replies:
        """Yield the replies of the workers, until all are there or the scheduler is lost."""
        self._require_package(client)
        ended: SimpleQueue[tuple[int, Any]] = SimpleQueue()
        idle = 0
        with self._submitted(client, calls, prepare) as futures:
            for number in futures:
                futures[number].add_done_callback(lambda one, k=number: ended.put((k, one)))
            while futures:
                try:
                    number, future = ended.get(timeout=LOOK)
                except Empty:
                    if client.status != 'running':
                        return
                    idle = 0 if self._has_workers(client) else idle + 1
                    if idle == IDLE:
                        _say(f'waits for workers of {self._address}: dask worker starts one')
                    continue
                reply = self._reply_of(future)
                if reply is None:
                    return
                # Without a future the result is forgotten: it need not be computed again if the
                # worker that has it is lost.
                del futures[number], future
                yield number, reply

    @contextmanager
    def _submitted(
        self, client: Any, calls: dict[int, bytes], prepare: Prepare
    ) -> Iterator[dict[int, Any]]:
        """Give the *calls* to the scheduler; in the end, what still runs of them is ended."""
        session = Session(uuid4().hex, digest_of_sources(), prepare)
        futures = client.map(
            reply_on_worker,
            list(calls.values()),
            session=pickle.dumps(session),
            key=[f'pam_ros-{session.name}-{number}' for number in calls],
            pure=False,
        )
        waiting = dict(zip(calls, futures, strict=True))
        del futures  # a result is kept for as long as there is a future of it
        try:
            yield waiting
        finally:
            # The scheduler may be lost, and with it the workers.
            with suppress(OSError, RuntimeError):
                client.cancel(list(waiting.values()))
                client.run(end_session, session.name, on_error='ignore')

    def _has_workers(self, client: Any) -> bool:
        with suppress(OSError):
            return bool(client.nthreads())
        return False

    def _reply_of(self, future: Any) -> bytes | None:
        """Return the reply of a task that has ended, None if it is lost with the scheduler.

        It is a Failure if its workers died, or could not start it.
        """
        try:
            if future.status == 'finished':
                return bytes(future.result())
            error = future.exception() if future.status == 'error' else None
        except (OSError, CancelledError):
            error = None
        if error is None:
            return None
        if isinstance(error, PamError):
            raise error
        if isinstance(error, RuntimeError) and 'deserialization' in str(error):
            raise PamError(
                f'the scheduler {self._address} has another version of {PACKAGE} than this '
                'machine: install the same on all'
            )
        reason = f'{type(error).__name__}: {error}'
        if isinstance(error, self._distributed.KilledWorker):
            reason = f'{error.allowed_failures + 1} workers of Dask died while they ran it'
        return pickle.dumps(Failure(reason))

    def _require_package(self, client: Any) -> None:
        """Raise PamError if the scheduler or one of its workers lacks this package.

        Dask itself would end such a worker, and the client would wait.
        """
        with suppress(OSError, CancelledError):  # if the scheduler is lost
            found = {'the scheduler': client.run_on_scheduler(find_spec, PACKAGE)}
            found |= client.run(find_spec, PACKAGE)
            for where, spec in found.items():
                if spec is None:
                    raise PamError(f'{where} of {self._address} lacks {PACKAGE}: install it there')


def _say(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)
