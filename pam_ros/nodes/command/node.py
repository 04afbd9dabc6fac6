# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ``pam_command``: does one thing to a running rig, step by step."""

import argparse
import sys

from rclpy.exceptions import NameValidationException

from pam_ros.command.absence import AbsentError
from pam_ros.command.options import Options, add_arguments, checked
from pam_ros.errors import PamError
from pam_ros.nodes.command.graph import Graph
from pam_ros.nodes.command.parameters import get_parameters, list_parameters, set_parameters
from pam_ros.nodes.command.pressure import command_pressure
from pam_ros.nodes.command.reference import send_position, send_stiffness
from pam_ros.nodes.command.services import call_service
from pam_ros.nodes.common.spin import BAD_INPUT, TickingNode, sentence
from pam_ros.timing.ticker import Ticker

NOT_THERE, INTERRUPTED = 1, 130  # exit codes
LOOK = 50.0  # Hz, of the checks whether what is waited for is there
ACTIONS = {
    'pressure': command_pressure,
    'position': send_position,
    'stiffness': send_stiffness,
    'set': set_parameters,
    'get': get_parameters,
    'list': list_parameters,
    'call': call_service,
}


class PamCommand(TickingNode):
    """The node; its name is hidden, so that other programs do not count it as part of the rig."""

    has_parameters = False

    def __init__(self, options: Options) -> None:
        """Prepare to do what *options* ask for."""
        super().__init__('_pam_command', start_parameter_services=False)
        self.ticker = Ticker(LOOK)
        self._may_stop = False
        self._steps = ACTIONS[options.action](self, Graph(self, options), options)

    @classmethod
    def add_arguments(cls, parser: argparse.ArgumentParser) -> None:
        """Add the actions of the command line."""
        add_arguments(parser)

    @classmethod
    def of_arguments(cls, arguments: argparse.Namespace) -> 'PamCommand':
        """Create the node with the options of the command line."""
        return cls(checked(arguments))

    def tick(self) -> None:
        """Go on until something must be waited for; end after the last step."""
        if self.exit_code is not None:
            return
        try:
            self._may_stop = next(self._steps)
        except StopIteration:
            self.exit_code = 0
        except (PamError, NameValidationException) as error:
            self.exit_code = NOT_THERE if isinstance(error, AbsentError) else BAD_INPUT
            print(f'pam_command: {sentence(error)}', file=sys.stderr, flush=True)

    def finish(self) -> None:
        """Tell that the command is not complete, if a signal has requested the end before."""
        if self.exit_code is None and not self._may_stop:
            self.exit_code = INTERRUPTED
            print('pam_command: interrupted before it was complete', file=sys.stderr, flush=True)
