# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How long an identification takes, and how a single fit compares with plain scipy.

The identification tries every effect of the library, for nominal models that lack one or two of
them. The fit is one candidate, a pressure lag: the nominal parameters, the start and the lag's two
times, once by the package and once by a simple program with ``scipy.integrate.solve_ivp`` inside
``scipy.optimize.least_squares``, on the same recording and from the same start.
"""

import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from benchmarks import tracing_joints
from benchmarks.tracing import blind_trial, nominal_model, recording_of
from pam_ros.identification.data.parts import parts_of
from pam_ros.identification.fit.extend import with_effect
from pam_ros.identification.fit.solve import solve
from pam_ros.identification.identify import identify
from pam_ros.identification.search.criteria import BUDGET, CRITERIA
from pam_ros.identification.search.setting import Setting
from pam_ros.recording.recording import Recording
from pam_ros.rig.joint import Joint
from pam_ros.rig.warm import warm

START = {'fill': 0.02, 'vent': 0.02}
# Missing effects, s, Hz, aim in s. The last is the slowest of all pairs that the trials use.
RUNS = (
    ('pressure_lag', 60.0, 1000.0, 4.0),
    ('pressure_lag', 80.0, 200.0, 4.0),
    ('hysteresis+dead_time', 60.0, 1000.0, 12.0),
    ('hysteresis+pressure_lag', 60.0, 1000.0, 12.0),
)
# The same for joints with two muscles.
OF_JOINTS = (
    ('pressure_lag@one', 60.0, 1000.0, 8.0),
    ('hysteresis@both', 60.0, 1000.0, 40.0),
)
SCIPY_SECONDS = 10.0  # of the recording for scipy's fit: its time grows in proportion


def main() -> None:
    """Print the time of each identification, and of one fit both ways."""
    warm()
    for kind, duration, rate, target in RUNS:
        trial = blind_trial(kind, 3, rate=rate, duration=duration)
        took(kind, duration, rate, target, nominal_model(trial), recording_of(trial))
    for kind, duration, rate, target in OF_JOINTS:
        pair = tracing_joints.pair_trial(kind, 3, rate=rate, duration=duration)
        model, recording = tracing_joints.nominal_model(pair), tracing_joints.recording_of(pair)
        took(kind, duration, rate, target, model, recording)
    compare()


def took(
    kind: str, duration: float, rate: float, target: float, model: Joint, recording: Recording
) -> None:
    """Identify what *recording* shows beyond *model*, and print how long that took."""
    began = time.perf_counter()
    found = identify(model, [recording])
    seconds = time.perf_counter() - began
    print(
        f'{kind}, {duration:g} s at {rate:g} Hz, all candidates: {seconds:5.1f} s (aim '
        f'{target:g}), {found.verdict} {[e.name for e in found.effects]}'
    )


def compare() -> None:
    """Print the time of one fit by the package and by plain scipy."""
    trial = blind_trial('pressure_lag', 3, rate=200.0, duration=80.0)
    model, recording = nominal_model(trial), recording_of(trial)
    parts = parts_of([recording], 1.0, 1.0)
    with ThreadPoolExecutor() as pool:
        setting = Setting(model, parts, CRITERIA, BUDGET, pool)
        problem, added = with_effect(setting.problem, model, setting.places['pressure_lag'], START)
        u = np.concatenate([np.zeros(len(problem.unknowns) - len(added)), added])
        began = time.perf_counter()
        ours = solve(problem, u, pool=pool)
        fast = time.perf_counter() - began

    s = parts[0].segment
    n = int(np.searchsorted(s.t, SCIPY_SECONDS))
    t, target = s.t[:n], s.target[:n]
    began = time.perf_counter()
    theirs = plain_fit(model, t, target, s.drive_t, s.drive[:, 0], (s.y0, s.v0))
    slow = (time.perf_counter() - began) * s.t.size / n
    print(
        f'one candidate, 80 s at 200 Hz: {fast:.2f} s, plain scipy {slow:.0f} s '
        f'(from {SCIPY_SECONDS:g} s of it): {slow / fast:.0f} times faster (at least 100)'
    )
    print(
        f'  fill, vent: {ours.value("effects.pressure_lag.fill"):.4f}, '
        f'{ours.value("effects.pressure_lag.vent"):.4f} s; scipy {theirs[-2]:.4f}, '
        f'{theirs[-1]:.4f} s; truth {trial.effects[0].values}'
    )


def plain_fit(model, t, target, drive_t, drive, start):  # type: ignore[no-untyped-def]
    """Return scipy's fit: factors of a1..a6 and zeta, start, lag times (11,)."""
    a = np.array(model.muscle.si)
    l0, mass, gravity = model.muscle.l0, model.load.mass, model.load.gravity

    def simulated(x):  # type: ignore[no-untyped-def]
        a1, a2, a3, a4, a5, a6 = a * x[:6]
        zeta, fill, vent = model.muscle.zeta * x[6], x[9], x[10]

        def rhs(now, state):  # type: ignore[no-untyped-def]
            y, v, p = state
            u = drive[np.searchsorted(drive_t, now, side='right') - 1]
            kappa = y / l0
            e = np.exp(a3 * kappa)
            force = (a1 * p + a2) * e + a4 * kappa * p + a5 * p + a6
            k = -((a1 * p + a2) * a3 * e + a4 * p) / l0
            c = 2.0 * zeta * np.sqrt(mass * max(k, 0.0))
            lag = fill if u > p else vent
            return v, (force - c * v) / mass - gravity, (u - p) / max(lag, 1e-3)

        run = solve_ivp(
            rhs, (t[0], t[-1]), (x[7], x[8], drive[0]), t_eval=t, rtol=1e-6, max_step=0.01
        )
        # A run that diverges ends early; its last position is far enough from the target.
        return np.pad(run.y[0], (0, t.size - run.t.size), mode='edge')

    first = np.array([1.0] * 7 + [*start, START['fill'], START['vent']])
    scale = np.array([0.05] * 6 + [0.5, 1e-3, 1e-2, 0.02, 0.02])
    found = least_squares(lambda x: simulated(x) - target, first, x_scale=scale, max_nfev=10)
    return found.x


if __name__ == '__main__':
    main()
