# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The part of the diagnostics on muscles that contract beyond their permitted contraction."""

from rclpy.node import Node

from pam_ros.health import simulator as sim_health
from pam_ros.health.health import Health
from pam_ros.simulator.plant import Plant


class ContractionReport:
    """Reports contractions beyond ``kappa_max``, each event once in the log."""

    def __init__(self, node: Node, plant: Plant) -> None:
        """Report the contractions of *plant* in the log of *node*."""
        self._node, self._plant = node, plant

    def health(self) -> Health:
        """Return the health of the contractions now."""
        found = self._plant.contractions.report(self._plant.time)
        for excess in found:
            if excess.is_new:
                sentence = sim_health.sentence_of(self._plant.setup, excess)
                self._node.get_logger().warning(sentence)
        return sim_health.contraction(self._plant, found)
