# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Whether each topic has the subscribers and the publishers that it must have."""

import struct
from collections.abc import Sequence

from pam_ros.health.health import Health, Level
from pam_ros.health.persistence import Persistence

# Checks in a row, one a second. Nodes that start find each other within this time. A node that is
# restarted appears twice for a while, but its two processes do not send at the same time.
LASTING = 3
_FRAME = 12  # bytes before the length of the frame in a serialized JointState


class Senders:
    """Detects from sequence numbers whether more than one publisher sends messages.

    Each publisher numbers its messages upwards. If the numbers go back, there are two publishers,
    or one that was restarted, which happens once. The ROS graph does not show this: it also
    contains publishers that send nothing, and for some 20 s those of a process that was killed.
    """

    def __init__(self) -> None:
        """Start without a message."""
        self._last: int | None = None
        self._went_back = self._went_back_before = False

    def take(self, number: int | None) -> None:
        """Note the number of a message that arrived, None if the middleware has none."""
        if number is None:
            return
        if self._last is not None and number <= self._last:
            self._went_back = True
        self._last = number

    def are_several(self) -> bool:
        """Return whether numbers went back since the last call or the one before.

        A publisher of one message per second is thus found at each call, if calls are 1 s apart.
        """
        found = self._went_back or self._went_back_before
        self._went_back, self._went_back_before = False, self._went_back
        return found


class TopicHealth:
    """The health of a topic: ``unreceived`` and ``contested`` are lasting faults, '' if none."""

    def __init__(self, topic: str, joints: Sequence[str] = ()) -> None:
        """Check *topic*; of joint states only the messages with one of *joints* count."""
        self.topic, self.joints = topic, joints
        self.unreceived = self.contested = ''
        self._is_unreceived = Persistence(LASTING, 1)
        self._is_contested = Persistence(LASTING, LASTING)

    def look(
        self, publishers: Sequence[str], is_without_subscriber: bool, has_several: bool
    ) -> list[str]:
        """Note the present state; return sentences on faults that begin to last.

        *publishers* are the names of the nodes, '' for an unknown one; *has_several* is whether
        more than one of them sends.
        """
        begins = []
        if self._is_unreceived.look(is_without_subscriber):
            self.unreceived = (
                f'commands on {self.topic} have no subscriber: is the rig or the simulator '
                'running, with the same topic name and namespace?'
            )
            begins.append(self.unreceived)
        if self._is_contested.look(has_several):
            begins.append(self._sentence(publishers))
        if not self._is_unreceived.lasts:
            self.unreceived = ''
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
    """Return whether a serialized JointState has one of *joints* among its names.

    The message is not deserialized: this would cost a loop at 500 Hz several percent of its time.
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
    faults = [one.unreceived for one in each if one.unreceived]
    faults += [one.contested for one in each if one.contested]
    if faults:
        return Health(Level.WARN, '; '.join(faults[:2]), values)
    return Health(Level.OK, 'as expected', values)
