# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Stand-ins for ``launch``, which no wheels have: what a launch file declares and starts."""

import runpy
import sys
from types import ModuleType, SimpleNamespace

MODULES = (
    'launch',
    'launch.actions',
    'launch.substitutions',
    'launch_ros',
    'launch_ros.actions',
    'launch_ros.parameter_descriptions',
)


class Configuration:
    """As LaunchConfiguration: looks its name up in the context."""

    def __init__(self, name):
        self.name = name

    def perform(self, context):
        return context[self.name]


class Argument:
    """As DeclareLaunchArgument: refuses a value that is none of its choices."""

    def __init__(self, name, *, default_value, description, choices=None):
        self.name, self.default, self.text = name, default_value, description
        self.choices = choices
        self.check(default_value)

    def check(self, value):
        if self.choices is not None and value not in self.choices:
            raise RuntimeError(f'{self.name} {value}: valid options are {self.choices}')


class Loaded:
    """A launch file: its arguments by name, and the nodes that it starts."""

    def __init__(self, monkeypatch, path):
        stand_ins = {
            'LaunchConfiguration': Configuration,
            'Node': SimpleNamespace,
            'Shutdown': SimpleNamespace,
            'ParameterValue': lambda value, value_type: (value, value_type),
            'DeclareLaunchArgument': Argument,
            'OpaqueFunction': lambda function: function,
            'LaunchDescription': list,
            'LaunchContext': dict,
        }
        for name in MODULES:
            module = ModuleType(name)
            for stand_in, value in stand_ins.items():
                setattr(module, stand_in, value)
            monkeypatch.setitem(sys.modules, name, module)
        self._path, self._monkeypatch = path, monkeypatch
        *arguments, self._start = runpy.run_path(str(path))['generate_launch_description']()
        self.arguments = {argument.name: argument for argument in arguments}

    def nodes(self, *words, started=''):
        """Return what ``ros2 launch pam_ros <file> words`` starts, by the names of programs.

        *started* is another launch file, which includes this one.
        """
        argv = ['ros2', 'launch', 'pam_ros', started or self._path.name, *words]
        self._monkeypatch.setattr(sys, 'argv', argv)
        context = {name: argument.default for name, argument in self.arguments.items()}
        context |= dict(word.split(':=') for word in words)
        for name, argument in self.arguments.items():
            argument.check(context[name])
        return {node.executable: node for node in self._start(context)}
