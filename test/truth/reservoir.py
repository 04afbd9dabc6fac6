# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A reservoir from which two muscles fill: its pressure falls while they do.

The air that a muscle takes is missing in the reservoir, and a compressor refills it:

    dp_s/dt = (level - p_s)/recovery - share sum of dp_i/dt over the chambers that it feeds.

It feeds a chamber that rises, and one whose regulator wants more than the reservoir has: from that
one, air may also flow back. A chamber that vents gives its air to the atmosphere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .compiled import jit
from .layout import ENOUGH
from .pneumatics import chamber, regulated

RESERVOIR = ('supply', 'level', 'share', 'recovery')


@dataclass(frozen=True)
class Reservoir:
    """A reservoir that is full at the start.

    level     its pressure at rest, gauge Pa
    share     volume of a muscle divided by that of the reservoir
    recovery  time constant of the compressor, s
    """

    level: float
    share: float
    recovery: float

    def put_into(self, G: Any) -> None:
        """Give the record *G* of a joint this reservoir."""
        G.level, G.share, G.recovery = self.level, self.share, self.recovery
        G.supply = self.level


@jit
def taken(P, S, t, d):
    """Advance a chamber by d seconds from t; return the Pa that it took from the reservoir."""
    wants_more = regulated(P, S, t + 0.5 * d) >= S.supply_pa
    before = S.p
    chamber(P, S, t, d)
    rise = S.p - before
    return rise if wants_more or rise > 0.0 else 0.0


@jit
def fill(P1, S1, P2, S2, G, t, d):
    """Advance both chambers and the reservoir of a joint by d seconds from t."""
    S1.supply_pa = S2.supply_pa = G.supply if G.level > 0.0 else ENOUGH
    took = taken(P1, S1, t, d) + taken(P2, S2, t, d)
    if G.level > 0.0:
        G.supply += (G.level - G.supply) * -math.expm1(-d / G.recovery) - G.share * took
