# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether each topic has the subscribers and the publishers that it must have."""

import struct
from collections.abc import Sequence

from pam_ros.health.health import Health, Level
from pam_ros.health.persistence import Persistence

# Looks in a row, one a second. Nodes that start find each other within this time, and one that is
# restarted is seen twice, but its messages follow each other.
LASTING = 3
_FRAME = 12  # where a serialized JointState has the length of its frame, before the frame


class Senders:
    """Tells from the sequence numbers of messages whether more than one publisher sends them.

    Each publisher numbers its messages upwards. So numbers that go back are of two publishers, or
    of one that was started again, which happens once. The graph of ROS does not say this: it also
    has publishers that send nothing, and for some 20 s those of a process that was killed.
    """

    def __init__(self) -> None:
        """Begin with no message."""
        self._last: int | None = None
        self._went_back = self._went_back_before = False

    def take(self, number: int | None) -> None:
        """Note the number of a message that arrived, None where the middleware has none."""
        if number is None:
            return
        if self._last is not None and number <= self._last:
            self._went_back = True
        self._last = number

    def are_several(self) -> bool:
        """Say whether numbers went back since the last call or the one before.

        So a publisher of one message a second is found at each call, if these are once a second.
        """
        found = self._went_back or self._went_back_before
        self._went_back, self._went_back_before = False, self._went_back
        return found


class TopicHealth:
    """How a topic is: ``unheard`` and ``contested`` say what lasts, '' where it is as it must."""

    def __init__(self, topic: str, joints: Sequence[str] = ()) -> None:
        """Judge *topic*; of joint states only the messages with one of *joints* count."""
        self.topic, self.joints = topic, joints
        self.unheard = self.contested = ''
        self._is_unheard = Persistence(LASTING, 1)
        self._is_contested = Persistence(LASTING, LASTING)

    def look(
        self, publishers: Sequence[str], is_without_subscriber: bool, has_several: bool
    ) -> list[str]:
        """Note how it is now; return the sentences of what begins to last.

        *publishers* are the names of the nodes, '' of one that is unknown; *has_several* says
        whether more than one of them sends.
        """
        begins = []
        if self._is_unheard.look(is_without_subscriber):
            self.unheard = (
                f'commands on {self.topic} have no subscriber: is the rig or the simulator '
                'running, with the same topic name and namespace?'
            )
            begins.append(self.unheard)
        if self._is_contested.look(has_several):
            begins.append(self._sentence(publishers))
        if not self._is_unheard.lasts:
            self.unheard = ''
        if not self._is_contested.lasts:
            self.contested = ''
        elif has_several:
            self.contested = self._sentence(publishers)
        return begins

    def _sentence(self, publishers: Sequence[str]) -> str:
        known = ', '.join(sorted(name for name in publishers if name))
        whose = f' ({known})' if known else ''
        what = ''
        if self.joints:
            kind = 'joint' if len(self.joints) == 1 else 'joints'
            shown = ', '.join(self.joints[:5]) + (' and others' if len(self.joints) > 5 else '')
            what = f' the {kind} {shown}'
        return (
            f'{self.topic} has {len(publishers)} publishers{whose}, and more than one of them '
            f'sends{what}: stop all but one'
        )


def names_one_of(joints: Sequence[str], message: bytes) -> bool:
    """Say whether a serialized JointState has one of *joints* among its names.

    Without making a message of it, which would cost a loop at 500 Hz several percent of its time.
    """
    if len(message) < _FRAME + 4:
        return False
    order = '<' if message[1] & 1 else '>'
    (frame,) = struct.unpack_from(f'{order}I', message, _FRAME)
    for joint in joints:
        name = joint.encode() + b'\0'
        if message.find(struct.pack(f'{order}I', len(name)) + name, _FRAME + 4 + frame) >= 0:
            return True
    return False


def topics(each: Sequence[TopicHealth], publishers: Sequence[int]) -> Health:
    """Return the health of all topics, each with the number of its publishers."""
    values = {
        f'publishers of {one.topic}': count for one, count in zip(each, publishers, strict=True)
    }
    faults = [one.unheard for one in each if one.unheard]
    faults += [one.contested for one in each if one.contested]
    if faults:
        return Health(Level.WARN, '; '.join(faults[:2]), values)
    return Health(Level.OK, 'as expected', values)
