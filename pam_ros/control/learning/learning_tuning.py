# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The tuning numbers of learning (:mod:`.learner`), each with its source."""

from dataclasses import dataclass

from pam_ros.control.tuning import number


@dataclass(frozen=True)
class LearningTuning:
    """How fast to learn, when to trust the result, and the bound of the feed-forward."""

    fast: float = number(
        60.0,
        'rad/s',
        'bandwidth of the fast observer and of the features: half of the velocity bandwidth, so '
        'that its noise stays below that of the law',
    )
    every: float = number(
        0.01, 's', 'between two samples of the regressions: enough for the fast observer'
    )
    noise: float = number(
        1.0, 'N^2', 'variance of the missing force from the fast observer by the noise of position'
    )
    first: float = number(
        1.0,
        'N^2',
        'first value of mean squares of forces, which the first second of motion replaces',
        along_muscle=False,
    )
    forgotten: float = number(
        0.02,
        '1/s',
        'share of the prior variance a second: a muscle warms in minutes; with half as much, '
        'control, friction, has errors 1.1 times as large',
    )
    early: float = number(
        0.3,
        '1/s',
        'additional share for a lag at the beginning, since its sensitivities depend on its '
        'estimate (Ljung & Soderstrom 1983, section 5.5): without it pair_control, lag, has '
        'errors 1.5 times as large, and so has control, all, with three times as much',
    )
    settled: float = number(
        2.0, 's', 'of motion in which it falls to 1/e: if longer, control, friction is worse'
    )
    lag_spread: float = number(0.05, 's', 'expected lag: servo valves have 20 to 130 ms')
    lag_alike: float = number(
        0.9,
        '',
        'correlation of the lags at filling and at venting, which are of one tube and one valve: '
        'a long motion in one direction shows only one of them',
    )
    lag_high: float = number(0.2, 's', 'largest lag that is inverted: longer ones prevent control')
    judge: float = number(1.0, 's', 'average of prediction errors: half a period of control')
    centre: float = number(2.0, 's', 'average of the mean force: a period of control')
    convinced: float = number(
        1.5, 's', 'of motion until the learned parameters have 63 % of their weight: control, lag'
    )
    floor: float = number(1.0, 'N^2', 'missing force that explains nothing: that of the noise')
    worse: float = number(0.7, '', 'ratio of errors at which a lag is doubted: control, all')
    lost: float = number(0.6, '', 'ratio of errors at which it is reset to 0: control, friction')
    doubt: float = number(0.5, 's', 'of motion below *worse* after which a lag is dropped')
    restart: float = number(2.0, 's', 'of motion between two resets of the lag')
    blend: float = number(0.2, 's', 'from one hypothesis to the other: slow compared to the loop')
    grow: float = number(0.2, 's', 'time constant with which the bandwidth approaches its value')
    margin: float = number(
        3.0, '', 'ratio of the decay time 1/bandwidth to a lag: a phase margin of some 60 degrees'
    )
    most: float = number(200.0, 'N', 'that is fed forward at most: the disturbance bound')
