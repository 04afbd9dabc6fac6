# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The effect of sensors on the measured state: latency, offset, noise, resolution."""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pam_ros.constructors import RefusesUnknownNames
from pam_ros.parameters import check_all, parameter_field

Array = NDArray[np.float64]
POSITION, VELOCITY, PRESSURE, FORCE, ACCELERATION = range(5)


@dataclass(frozen=True)
class Sensors(metaclass=RefusesUnknownNames):
    """The faults of the sensors, all absent by default.

    Noise is white and Gaussian, and independent for every reading; the same seed and the same
    readings give the same noise. A resolution of 0 means no rounding. Values of the position and
    the force are in m and N, or in rad and N m for a revolute joint.

    Raises ParameterError for a value out of range.
    """

    latency: float = parameter_field(
        0.0, 'age of the feedback when it is published', 's', low=0.0, high=1.0
    )
    position_offset: float = parameter_field(
        0.0, 'constant error of the position sensor', 'm', low=-1.0, high=1.0
    )
    position_noise: float = parameter_field(
        0.0, 'standard deviation of the noise of position', 'm', low=0.0, high=0.1
    )
    velocity_noise: float = parameter_field(
        0.0, 'standard deviation of the noise of velocity', 'm/s', low=0.0, high=10.0
    )
    pressure_noise: float = parameter_field(
        0.0, 'standard deviation of the noise of pressure', 'Pa', low=0.0, high=1e6
    )
    force_noise: float = parameter_field(
        0.0, 'standard deviation of the noise of force', 'N', low=0.0, high=1e4
    )
    position_resolution: float = parameter_field(
        0.0, 'step of the position sensor, 0 for none', 'm', low=0.0, high=0.1
    )
    pressure_resolution: float = parameter_field(
        0.0, 'step of the pressure sensor, 0 for none', 'Pa', low=0.0, high=1e6
    )
    force_resolution: float = parameter_field(
        0.0, 'step of the force sensor, 0 for none', 'N', low=0.0, high=1e4
    )
    seed: int = parameter_field(0, 'seed of the noise', '', low=0, high=2**31 - 1)

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)

    @property
    def noise(self) -> tuple[float, float, float, float]:
        """Standard deviations in the order of a reading."""
        return self.position_noise, self.velocity_noise, self.pressure_noise, self.force_noise

    @property
    def resolution(self) -> tuple[float, float, float, float]:
        """Steps in the order of a reading."""
        return self.position_resolution, 0.0, self.pressure_resolution, self.force_resolution


class Feedback:
    """The sensors of a rig in operation.

    Samples are arrays (5, muscles): position m, velocity m/s, pressure Pa, force N, acceleration
    m/s^2. Readings are arrays (4, muscles) in the same order, without the acceleration.
    """

    def __init__(self, sensors: Sensors, muscles: int = 1) -> None:
        """Start without past samples: before one latency has passed, the oldest one is used."""
        self._past: deque[tuple[float, Array]] = deque()
        self._muscles = muscles
        self.sensors = sensors
        self._random = np.random.default_rng(sensors.seed)
        self.change(sensors)

    def change(self, sensors: Sensors) -> None:
        """Continue with other faults; the noise starts again if its seed has changed."""
        if sensors.seed != self.sensors.seed:
            self._random = np.random.default_rng(sensors.seed)
        self.sensors = sensors
        self._noise = np.array(sensors.noise)[:, None]
        self._resolution = np.array(sensors.resolution)[:, None]
        self._is_noisy = any(sensors.noise)
        self._is_stepped = any(sensors.resolution)
        self.is_ideal = not (
            self._is_noisy or self._is_stepped or sensors.latency or sensors.position_offset
        )

    def read(self, t: float, sample: Array) -> Array:
        """Return the readings of the sensors at *t* s, when the rig's state is *sample*.

        Call it in the order of time: samples are stored for the latency.
        """
        reading: Array = self._late(t, sample) if self.sensors.latency else sample[:4].copy()
        reading[POSITION] += self.sensors.position_offset
        if self._is_noisy:
            # All are drawn always, so that the noise of one sensor does not depend on another one.
            reading += self._noise * self._random.standard_normal((4, self._muscles))
        if self._is_stepped:
            for row, step in zip(reading, self._resolution[:, 0], strict=True):
                if step:
                    row[:] = np.round(row / step) * step
        return reading

    def _late(self, t: float, sample: Array) -> Array:
        """Store the sample; return the reading of one latency ago, interpolated."""
        past, wanted = self._past, t - self.sensors.latency
        if past and past[-1][0] == t:  # time has not advanced
            past.pop()
        past.append((t, sample.copy()))
        while len(past) > 1 and past[1][0] <= wanted:
            past.popleft()
        t0, a = past[0]
        if len(past) == 1 or wanted <= t0:
            return np.array(a[:4])
        t1, b = past[1]
        return between(a, b, t1 - t0, (wanted - t0) / (t1 - t0))


def between(a: Array, b: Array, h: float, share: float) -> Array:
    """Interpolate two samples *h* s apart at *share* (0: a, 1: b); return a reading.

    Position and velocity by cubic Hermite polynomials, whose slopes are velocity and
    acceleration: 2 ms apart this is exact to nanometres. Pressure and force linearly.
    """
    reading: Array = a[:4] + share * (b[:4] - a[:4])
    rest = 1.0 - share
    for row, slope in ((POSITION, VELOCITY), (VELOCITY, ACCELERATION)):
        chord = b[row] - a[row]
        bend_a, bend_b = h * a[slope] - chord, chord - h * b[slope]
        reading[row] += share * rest * (rest * bend_a + share * bend_b)
    return reading
