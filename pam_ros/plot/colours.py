# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The colours of joints and muscles, in a figure and on the page."""

# Distinct for every kind of colour vision (Okabe and Ito), darkened if they are too light on
# white.
COLOURS = (
    *('#0b62a8', '#c8500a', '#007a5a', '#9c4f83'),
    *('#8a6d00', '#3a8fc4', '#59636e', '#000000'),
)
GREY = 6  # for a line that belongs to no joint and no muscle


def colour(number: int) -> str:
    """Return the colour of the joint or the muscle with this *number*; they repeat."""
    return COLOURS[number % len(COLOURS)]
