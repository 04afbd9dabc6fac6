# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A pool without processes, which cost seconds: ``test/parallel`` is for these."""

import pickle

from pam_ros.errors import PamError
from pam_ros.parallel.tasks import Failure


class HerePool:
    """Runs tasks one after another in this process; errors of users and of the system fail."""

    def run(self, calls, prepare):
        """Yield the number of each call, with its reply; see ``Pool``."""
        for number, call in enumerate(calls):
            function, task = pickle.loads(call)
            try:
                yield number, pickle.dumps(function(task))
            except PamError as error:
                yield number, pickle.dumps(Failure(str(error)))
            except OSError as error:
                yield number, pickle.dumps(Failure(f'OSError: {error}'))
