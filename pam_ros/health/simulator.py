# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What ``pam_sim`` says of itself on ``/diagnostics``."""

import numpy as np

from pam_ros.health.health import Health, Level
from pam_ros.simulator.plant import Plant


def commands(plant: Plant, last: int) -> Health:
    """Return the health of the commands, *last* being the muscle that had a bad one last."""
    inputs = plant.inputs
    heard = plant.heard[~np.isnan(plant.heard)]
    age = plant.time - float(heard.min()) if heard.size else None
    values = {
        'command age (s)': age,
        'last command (Pa)': inputs[0].last if len(inputs) == 1 else None,
        'accepted': sum(given.accepted for given in inputs),
        'clamped': sum(given.clamped for given in inputs),
        'refused': sum(given.refused for given in inputs),
        'last reason': inputs[last].reason,
    }
    if len(inputs) > 1:
        del values['last command (Pa)']
        values['muscles commanded'] = int(heard.size)
    if age is None:
        return Health(Level.OK, 'no command yet', values)
    if np.any(plant.is_silent):
        did = {'vent': 'vented', 'hold': 'held'}[plant.told.settings.on_timeout]
        whose = ''
        if len(inputs) > 1:
            silent = np.flatnonzero(plant.is_silent)
            names = [plant.told.muscle_names[i] for i in silent[:5]]
            whose = f' for {", ".join(names)}' + (' and others' if len(silent) > 5 else '')
        return Health(Level.WARN, f'no command{whose} for {age:.3g} s: {did}', values)
    return Health(Level.OK, 'commanded', values)
