# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0

# Which wheels of ROS: those of each distribution have an environment of their own.
DISTRO := jazzy
VENV := $(if $(filter jazzy,$(DISTRO)),.venv,.venv/$(DISTRO))
PY := $(VENV)/bin/python
ifeq ($(wildcard requirements/ros-$(DISTRO).txt),)
$(error DISTRO=$(DISTRO) is not known: it must be jazzy or kilted)
endif

# A ROS that the user's shell has sourced must not mix with the wheels of the environment.
unexport PYTHONPATH PYTHONHOME LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH
unexport ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION RMW_IMPLEMENTATION ROS_SECURITY_ENABLE
# Nothing that is started here needs another machine.
export ROS_AUTOMATIC_DISCOVERY_RANGE := LOCALHOST
export PYTHON

# Files in the order of the folders: the default ends with those that have few tests, but long ones.
PARALLEL := -n auto --dist loadfile --no-loadscope-reorder

.DEFAULT_GOAL := help
.PHONY: help environment warm demo test test-fast test-all platforms faults mutation lint docs
.PHONY: pages notebook bench clean

help:
	@echo 'make demo       the experiment of the paper, controllers and the closed loop, over ROS topics: see demo/'
	@echo 'make test       the tests (make test ARGS="test/muscle -x" for some)'
	@echo 'make test-fast  those of them that start no node and build nothing'
	@echo 'make test-all   before a release: the tests, the demonstration, trials that are drawn'
	@echo 'make platforms  each Python and ROS that this machine can run, and the oldest libraries'
	@echo 'make faults     each fault of a node 20 times, and 1500 examples of generated input'
	@echo 'make mutation   which small changes of the sources the tests notice (ARGS=pam_ros/muscle)'
	@echo 'make lint       style and types'
	@echo 'make docs       the pages and the public names as a site: build/docs/index.html'
	@echo 'make pages      write the pages of the effects again: their tables, texts and pictures'
	@echo 'make notebook   run docs/notebooks/ again, and store what the cells print and draw'
	@echo 'make bench      the speed claims, measured on this machine (ARGS=plant_step for one)'
	@echo 'make clean      remove what these commands made'
	@echo 'The first of them sets up the environment $(VENV); PYTHON=python3.12 chooses its Python,'
	@echo 'and DISTRO=kilted the ROS of make test, make demo and make bench: jazzy, if not given.'

environment:
	@tools/environment --package $(VENV) requirements/ros-$(DISTRO).txt requirements/colcon.txt \
	  requirements/lint.txt requirements/bench.txt requirements/mutation.txt

# Compile the stepping kernels into their cache, so that nodes start at once.
warm: environment
	@$(PY) -m pam_ros.rig.warm

demo: warm
	$(VENV)/bin/pam_demo

test: warm
ifdef ARGS
	$(PY) -m pytest $(ARGS)
else
	$(PY) -m pytest $(PARALLEL) -m 'not keeps_rate and not release'
	$(PY) -m pytest -m 'keeps_rate and not release' test/nodes test/faults
endif

test-fast: warm
	$(PY) -m pytest $(PARALLEL) -m 'pure and not slow' $(ARGS)

test-all: test
	$(PY) -m pytest -m release

# An environment of its own, without a ROS that those of the platforms would inherit.
platforms:
	@tools/environment .venv/nox requirements/nox.txt
	.venv/nox/bin/nox $(ARGS)

# What a user, a machine or a disk can do to the programs, many times; prints each jump of the load.
faults: warm
	$(PY) -m pytest --full -rP test/faults test/settings/test_bad_values.py \
	  test/cli/test_command_lines.py test/recording/test_spoiled.py $(ARGS)

# In a copy of the checkout; the results are kept in build/mutation/.
mutation: environment
	$(PY) -u tools/mutation.py $(ARGS)

lint: environment
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	$(PY) -m mypy

# An environment of its own, so that no other command has to wait for Sphinx.
docs:
	@tools/environment .venv-docs requirements/docs.txt
	.venv-docs/bin/python -m sphinx -W --keep-going -q -E -c docs . build/docs
	@echo 'build/docs/index.html is the start page.'

pages: warm
	$(PY) tools/effect_pages.py

notebook: warm
	$(PY) tools/notebook.py

bench: warm
	$(PY) -m benchmarks $(ARGS)

clean:
	rm -rf .venv .venv-docs demo build install log *.egg-info
	rm -rf .hypothesis .mypy_cache .pytest_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
