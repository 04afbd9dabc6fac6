# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a person is told if the rig is not found: what was found instead, and where to look."""

from collections.abc import Sequence

from pam_ros.errors import PamError

SHOWN = 8  # nodes in a message


class AbsentError(PamError):
    """A node, topic or service that was not found, or that did not answer; exit code 1."""


def absent(missing: str, waited: float, nodes: Sequence[str], domain: str, alike: str) -> str:
    """Return the sentence on what is *missing* after *waited* s.

    *nodes* were found in the ROS *domain*. *alike* is the name of what is there in another
    namespace, '' if there is none.
    """
    shown = ', '.join(nodes[:SHOWN]) + (' and others' if len(nodes) > SHOWN else '')
    found = f'the nodes there are {shown}' if nodes else 'no other node is there'
    space = alike.rpartition('/')[0] or '/'
    advice = (
        f'{alike} exists: give its namespace with --ros-args -r __ns:={space}'
        if alike
        else 'start pam_sim, pam_control or the rig, with the same ROS_DOMAIN_ID'
    )
    return f'{missing} after {waited:g} s in ROS_DOMAIN_ID {domain}, and {found}: {advice}'


def in_another_namespace(name: str, names: Sequence[str]) -> str:
    """Return the first of *names* that ends like *name*, the full name of what is missing."""
    last = '/' + name.rpartition('/')[2]
    return next((one for one in sorted(names) if one.endswith(last) and one != name), '')
