# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Comparison of controllers: scenarios, runs of controllers in them, and scores.

A scenario is a YAML file: a rig, what of it is not declared to the controller, and a reference.
A controller is a process that receives joint states and references over topics, and sends
pressures. All of this package except the runs over topics (``pam_ros.nodes.bench``) is free of
ROS.
"""
