# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A rig of which a program moves one joint: which one, and the topics of its muscles."""

from dataclasses import dataclass, replace

from pam_ros.errors import ParameterError
from pam_ros.rig.arrangements import LOAD
from pam_ros.rig.joint import Joint
from pam_ros.settings.rig import RigParameters
from pam_ros.settings.sim import SimSettings
from pam_ros.settings.tables import Table, Values, table_of

NAMES = ('joint', 'muscles', 'joint_names', 'muscle_topics')  # parameters of pam_sim as well


@dataclass(frozen=True)
class MuscleTopics:
    """The topics of the *muscles* of a joint, named as ``pam_sim`` names them.

    ``is_array`` is whether all of them share one topic, ``has_own`` whether each has one below its
    name. Otherwise there is one muscle, with a topic of the plain name.
    """

    muscles: tuple[str, ...]
    is_array: bool
    has_own: bool

    @property
    def commands(self) -> tuple[str, ...]:
        """Topics of the commands: one for the array, or one for each muscle."""
        return self._named('pressure_command', 'pressure_commands')

    @property
    def every_command(self) -> tuple[str, ...]:
        """Every topic on which another program could command one of the muscles."""
        if not self.is_array and not self.has_own:
            return self.commands
        either = (MuscleTopics(self.muscles, array, not array) for array in (True, False))
        return tuple(topic for topics in either for topic in topics.commands)

    @property
    def pressures(self) -> tuple[str, ...]:
        """Topics of the measured pressures: one for the array, or one for each muscle."""
        return self._named('pressure', 'pressures')

    def _named(self, one: str, array: str) -> tuple[str, ...]:
        if self.is_array:
            return (array,)
        return tuple(f'{muscle}/{one}' for muscle in self.muscles) if self.has_own else (one,)


@dataclass(frozen=True)
class OneJoint:
    """One joint of a rig, with its name in ``joint_states`` and the topics of its muscles."""

    joint: Joint
    name: str
    topics: MuscleTopics


class OneJointParameters(RigParameters):
    """The muscles and joints of a rig, one of which a program moves."""

    @property
    def common(self) -> Table:
        """The table of the names; ``muscle_topics`` is described for a program that commands."""
        names = table_of(SimSettings)
        kind, default, about = names['muscle_topics']
        text = (
            'command each muscle on <name>/pressure_command, as pam_sim with muscle_topics expects'
        )
        names['muscle_topics'] = kind, default, replace(about, text=text)
        return {name: names[name] for name in NAMES}

    def one(self, values: Values, name: str) -> OneJoint:
        """Return the joint *name* of checked flat *values*; '' is the only one.

        One muscle with a load of its own may have any name: its values are then the common ones.
        Raises ParameterError if there is no such joint, or if others share its topic of commands.
        """
        has_topics = bool(values['muscle_topics'])
        k = self._number(name, has_topics=has_topics)
        n = self.kind.muscles
        if self.kind is not LOAD and len(self.joints) > 1 and not has_topics:
            raise ParameterError(
                f'pressure_commands has all muscles of {len(self.joints)} joints, and this '
                f'program commands only {self.joints[k or 0]}: set muscle_topics, here and in '
                'pam_sim'
            )
        is_array = self.kind is not LOAD and not has_topics
        topics = MuscleTopics(self.muscles[n * (k or 0) :][:n], is_array, has_topics)
        if k is None:
            return OneJoint(self.build_common(values), name, topics)
        return OneJoint(self.build_joints(values)[k], self.joints[k], topics)

    def _number(self, name: str, *, has_topics: bool) -> int | None:
        """Return the index of the joint; None for a muscle with common values only."""
        if len(self.joints) == 1 and (self.kind is not LOAD or name in ('', *self.joints)):
            return 0
        if name in self.joints:
            return self.joints.index(name)
        if self.kind is LOAD and name and not has_topics:
            return None
        names = ', '.join(self.joints)
        if not name:
            raise ParameterError(
                f'the rig has {len(self.joints)} joints, {names}: choose one with joint_name'
            )
        raise ParameterError(
            f'joint_name = {name} is not one of the joints {names}: give the one that is moved'
        )
