# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Takes the messages of all recorded topics, and writes them to the bag with their times."""

import threading
from collections.abc import Callable
from time import monotonic_ns, sleep, time_ns

from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from pam_ros.nodes.common.rclpy_internals import messages_of
from pam_ros.nodes.record.taking import RecordedTopic
from pam_ros.recording.bag.metadata import BagTopic
from pam_ros.recording.bag.writer import BagWriter
from pam_ros.recording.sending_time import LIMIT
from pam_ros.recording.simulated_time import SimulatedTime
from pam_ros.timing.pace import SECOND

TAKE = 0.01  # s between two rounds of taking messages
# ns that the recorder waits for missing messages, also at its end: the middleware sends a lost
# message again after up to 3 s.
PATIENCE = LIMIT
# ns. At the end, a topic with a longer period is not expected to have a later message, and no
# time on /clock is missing that would be so little later than the last one.
STILL = SECOND // 10


class MessageIntake:
    """The recorded topics and their bag. Two threads may use it."""

    def __init__(
        self,
        writer: BagWriter,
        now: Callable[[], int],
        refuses_time: Callable[[Clock], bool],
        *,
        is_simulated: bool,
    ) -> None:
        """Start without topics.

        *now* returns the ROS time in ns, for messages whose times the middleware does not know.
        With *is_simulated* times are those on ``/clock`` that *refuses_time* does not refuse.
        """
        self._writer, self._now, self._refuses_time = writer, now, refuses_time
        self._is_simulated = is_simulated
        self._lock = threading.Lock()  # of the writer and of the recorded topics
        self._recorded: dict[str, RecordedTopic] = {}
        self._clock: Subscription | None = None
        self._time = SimulatedTime()

    def add(self, described: BagTopic, subscription: Subscription) -> None:
        """Record one topic more."""
        with self._lock:
            channel = self._writer.add_topic(described)
            self._recorded[described.name] = RecordedTopic(subscription, channel)

    def follow(self, clock: Subscription) -> None:
        """Take the times on ``/clock``, too."""
        with self._lock:
            self._clock = clock

    @property
    def needs_clock(self) -> bool:
        """Whether times are simulated and ``/clock`` is not followed yet."""
        return self._is_simulated and self._clock is None

    def count_publishers(self, topic: str, count: int) -> None:
        """Note how many publishers a recorded topic has at present; none may be those to come."""
        if count:
            self._recorded[topic].is_sole = count == 1

    def __contains__(self, topic: str) -> bool:
        """Return whether a topic is recorded."""
        return topic in self._recorded

    def __bool__(self) -> bool:
        """Return whether any topic is recorded."""
        return bool(self._recorded)

    def lost(self, topic: str) -> int:
        """Return how many messages of a topic were lost before they were received."""
        return self._recorded[topic].lost

    def take(self) -> None:
        """Take all messages that have arrived, and write those whose times are known."""
        with self._lock:
            self._take()

    def seal(self) -> None:
        """Make the bag on the disk complete, see :class:`BagWriter`."""
        with self._lock:
            self._writer.seal()

    def take_last(self, count_publishers: Callable[[str], int]) -> None:
        """Take what was sent until now, also what the middleware has to send again.

        *count_publishers* returns the number of publishers of a topic.
        """
        until, begun = time_ns(), monotonic_ns()
        is_reported = False
        self._take()
        while missing := self._may_miss(until, count_publishers):
            waited = monotonic_ns() - begun
            if waited > PATIENCE:
                break
            if waited > SECOND // 2 and not is_reported:
                limit = f'waits up to {PATIENCE // SECOND} s for the last messages of '
                print(limit + ', '.join(missing), flush=True)
                is_reported = True
            sleep(TAKE)
            self._take()
        self._take(is_last=True)

    def _take(self, *, is_last: bool = False) -> None:
        """Take all messages that have arrived; write those with a known time, or all if *is_last*.

        The time of a message is the time when it was sent. On the clock of the recorder it is
        known if the topic has one publisher; else it is the time of receipt. In simulated time it
        is the time on ``/clock`` when the message was sent. The time when it is taken is later;
        the faster time is simulated, the greater is this delay.
        """
        for recorded in self._recorded.values():
            self._take_from(recorded)
        if self._clock:
            for message, info in messages_of(self._clock):
                if not self._refuses_time(message):
                    now = message.clock.sec * SECOND + message.clock.nanosec
                    self._time.tell(info['source_timestamp'], now)
        for recorded in self._recorded.values():
            self._write_waiting(recorded, is_last)

    def _take_from(self, recorded: RecordedTopic) -> None:
        """Take the messages of a topic; write them, or let them wait for simulated time."""
        taken = list(messages_of(recorded.subscription))
        stamps = [(info['source_timestamp'], info['received_timestamp']) for _, info in taken]
        has_both = all(sent and received for sent, received in stamps)
        if recorded.is_sole and has_both and not self._is_simulated:
            times = recorded.sending.of(stamps)
        else:
            times = [received for _, received in stamps]
        for (data, info), (sent, _), time in zip(taken, stamps, times, strict=True):
            recorded.count(sent)
            recorded.count_lost(info['publication_sequence_number'])
            if self._is_simulated and sent:
                recorded.waiting.append((data, sent, monotonic_ns()))
            elif self._is_simulated or not time:
                now = self._now()
                self._writer.write(recorded.channel, now, now, data)
            else:
                self._writer.write(recorded.channel, time, sent, data)

    def _write_waiting(self, recorded: RecordedTopic, is_last: bool) -> None:
        """Write the messages of a topic before the first one whose time is not known yet."""
        now, waiting = monotonic_ns(), recorded.waiting
        while waiting:
            data, sent, taken = waiting[0]
            time = self._time.at(sent)
            if time is None:
                if not is_last and now - taken < PATIENCE:
                    return
                time = self._time.before(sent)
            self._writer.write(recorded.channel, time, time, data)
            waiting.popleft()

    def _may_miss(self, until: int, count_publishers: Callable[[str], int]) -> list[str]:
        """Return the topics of which messages that were sent before *until* may still arrive."""
        clock = ['/clock'] if self._misses_times() else []
        return clock + [
            topic
            for topic, one in self._recorded.items()
            if one.may_miss(until, STILL, PATIENCE) and count_publishers(topic)
        ]

    def _misses_times(self) -> bool:
        newest = self._time.newest
        last = max(
            (one.waiting[-1][1] for one in self._recorded.values() if one.waiting), default=0
        )
        return newest is not None and last > newest + STILL
