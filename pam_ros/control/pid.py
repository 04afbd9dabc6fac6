# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A PID law behind the same interface, to compare with: simple-pid's, with what it needs here."""

from dataclasses import dataclass
from importlib import import_module
from math import exp
from typing import Any

from pam_ros.control.inner_model import InnerModel
from pam_ros.control.limits import Limiter, Limits
from pam_ros.control.pressure_path import PressurePath
from pam_ros.control.signals import Reference, Terms
from pam_ros.errors import ParameterError
from pam_ros.parameters import check_all, parameter
from pam_ros.rig.model import RigModel


@dataclass(frozen=True)
class PidGains:
    """Gains of the PID law.

    The defaults are the best that one set can be for all rigs of ``benchmarks/control.py`` whose
    lag or load nobody declared: of all gains, by differential evolution, those with the least
    integral of the absolute error after a load of 50 N, at the worst place from 45 to 85 mm,

    - with a largest sensitivity of 1.6 at most on the nominal rig, at each place, and of 2.0 with
      5 kg more, with a lag of 60 ms, and with both and 10 ms of dead time (Astrom & Hagglund,
      Advanced PID Control, 2006: 1.2 to 2.0),
    - and with 400 Pa of noise in the pressure at most, of 20 um in the position at 500 Hz.

    Gains for the nominal rig alone have a third of these errors there, and are unstable with the
    lag.
    """

    proportional: float = parameter(0.82e6, 'pressure per error', 'Pa/m', low=0.0, high=1e9)
    integral: float = parameter(39e6, 'rate of pressure per error', 'Pa/(m s)', low=0.0, high=1e10)
    derivative: float = parameter(
        194e3, 'pressure per rate of the error', 'Pa s/m', low=0.0, high=1e9
    )
    filter_bandwidth: float = parameter(
        282.0, 'bandwidth of the filter of the measured position', 'rad/s', low=1.0, high=1e4
    )

    def __post_init__(self) -> None:
        """Check every field."""
        check_all(self)


class Pid:
    """PID on the error, on top of the pressure that holds the load at the reference.

    The error is filtered twice at the same bandwidth, since its derivative would be noise. The
    static part comes from the same model as that of the sliding-mode law: without it no PID
    follows a muscle's curve.
    """

    def __init__(self, model: RigModel, gains: PidGains, limits: Limits | None = None) -> None:
        """Make it for a declared rig; raises ParameterError where simple-pid is missing."""
        try:
            maker: Any = import_module('simple_pid').PID
        except ImportError as error:
            raise ParameterError('the PID law needs simple-pid: pip install simple-pid') from error
        limits = limits or Limits()
        self.gains = gains
        self.terms = Terms()
        self._rig = InnerModel(model)
        self._path = PressurePath(model, 1.0)
        self._limiter = Limiter(*limits.range_for(model), limits.pressure_rate)
        self._pid = maker(gains.proportional, gains.integral, gains.derivative, sample_time=None)
        self.start(0.0)

    def _static(self, position: float) -> float:
        """Return the command in Pa that holds the load at *position* m, as modelled."""
        chamber = self._rig.pressure_for(self._rig.weight, position)
        return self._path.command_at_rest(chamber)

    def start(self, position: float, pressure: float | None = None) -> None:
        """Begin anew at rest at *position* m, the chamber at *pressure* Pa if that is known."""
        static = self._static(position)
        self._limiter.start(static if pressure is None else pressure)
        self._pid.set_auto_mode(False)
        self._pid.set_auto_mode(True, last_output=self._limiter.last - static)
        self._error = self._filtered = 0.0
        self._seen = position
        self.terms = Terms(reference=position, position=position, pressure=self._limiter.last)

    def update(
        self,
        dt: float,
        reference: Reference,
        position: float | None,
        velocity: float | None = None,
        age: float = 0.0,
    ) -> float:
        """Return the gauge pressure in Pa to command from now on, *dt* s after the last call."""
        if position is not None:
            self._seen = position
        static = self._static(reference.position)
        # What the limits leave of the range: simple-pid stops its integral there.
        self._pid.output_limits = (self._limiter.low - static, self._limiter.high - static)
        share = 1.0 - exp(-self.gains.filter_bandwidth * dt)
        self._error += share * (reference.position - self._seen - self._error)
        self._filtered += share * (self._error - self._filtered)
        wanted = static + self._pid(-self._filtered, dt=dt)
        command = self._limiter.limit(wanted, dt)
        p, i, d = self._pid.components
        gain = self._rig.gain(reference.position)
        self.terms = Terms(
            reference=reference.position,
            speed=reference.velocity,
            position=self._seen,
            error=reference.position - self._seen,
            equivalent=gain * static,
            switching=gain * (p + d),
            observer=gain * i,
            pressure=command,
            cut=gain * (static + p + i + d - command),
        )
        return command
