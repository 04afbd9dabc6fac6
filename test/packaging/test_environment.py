# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The set-up script, with a stand-in for Python that notes what it is asked to do."""

import os
import shutil
import signal
import subprocess
from pathlib import Path
from time import monotonic

import pytest

SHELL_TOOLS = ('cat', 'cut', 'dirname', 'env', 'flock', 'mkdir', 'rm', 'sed', 'sh', 'sha256sum')
SHELL_TOOLS += ('cp', 'sleep', 'touch')
# In a folder of its own it is `python3`; the environment it makes has a copy of it. Its version,
# and what it cannot do, are in files next to the checkout. It hangs without starting a program:
# dash loses a signal that comes to its child between `vfork` and `exec`.
STAND_IN = """#!/bin/sh
case "$*" in
    -V) echo "Python $(cat "$NOTES/version")" ;;
    *sys.version_info*) exit "$(cat "$NOTES/out_of_range")" ;;
    *ensurepip*) exit "$(cat "$NOTES/no_ensurepip")" ;;
    '-m venv '*) echo venv >>"$NOTES/asked"; mkdir -p "$3/bin"; cp "$0" "$3/bin/python" ;;
    *'install --upgrade pip'*) ;;
    *' install '*)
        echo "install ${*##*install }" >>"$NOTES/asked"
        if [ -e "$NOTES/hang" ]; then : >"$NOTES/hanging"; exec sleep 600; fi
        exit "$(cat "$NOTES/no_network")" ;;
    *) echo "unexpected: $*" >&2; exit 99 ;;
esac
"""
ALL = 'install -r requirements.txt -e .[fast,test]'
AGAIN = 'install --no-deps --no-build-isolation -e .'


class Checkout:
    """A checkout with little in it, on a machine with nothing but a shell and `python3`."""

    def __init__(self, folder: Path, root: Path):
        self.folder = folder / 'checkout'
        self.notes = folder / 'notes'
        self.tools = folder / 'bin'
        for made in (self.folder / 'tools', self.notes, self.tools):
            made.mkdir(parents=True)
        shutil.copy(root / 'tools' / 'environment', self.folder / 'tools')
        for name in ('requirements.txt', 'setup.py', 'setup.cfg', 'pyproject.toml'):
            (self.folder / name).write_text('one\n')
        for name in SHELL_TOOLS:
            (self.tools / name).symlink_to(shutil.which(name))
        (self.tools / 'python3').write_text(STAND_IN)
        (self.tools / 'python3').chmod(0o755)
        self.set(version='3.11.2', out_of_range='0', no_ensurepip='0', no_network='0')

    def set(self, **notes):
        for name, text in notes.items():
            (self.notes / name).write_text(text)

    def start(self):
        return subprocess.Popen(
            ['tools/environment', '--package', '.venv', 'requirements.txt'],
            cwd=self.folder,
            env={'PATH': str(self.tools), 'NOTES': str(self.notes)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def set_up(self):
        """Run the script; return its exit code, what it asked Python for, and its complaint."""
        (self.notes / 'asked').unlink(missing_ok=True)
        running = self.start()
        _, complaint = running.communicate(timeout=60)
        return running.returncode, self.asked(), complaint.strip()

    def asked(self):
        asked = self.notes / 'asked'
        return asked.read_text().splitlines() if asked.exists() else []


@pytest.fixture
def checkout(tmp_path, root):
    return Checkout(tmp_path, root)


def test_sets_up_once(checkout):
    assert checkout.set_up() == (0, ['venv', ALL], '')
    assert (checkout.folder / '.venv' / 'COLCON_IGNORE').is_file()
    assert checkout.set_up() == (0, [], '')


@pytest.mark.parametrize(
    ('changed', 'asked'),
    [
        ('requirements.txt', [ALL]),
        ('setup.py', [ALL]),
        ('setup.cfg', [AGAIN]),
        ('pyproject.toml', [AGAIN]),
    ],
)
def test_a_changed_input_installs_what_depends_on_it(checkout, changed, asked):
    checkout.set_up()
    (checkout.folder / changed).write_text('two\n')
    assert checkout.set_up() == (0, asked, '')
    assert checkout.set_up() == (0, [], '')


def test_a_touched_input_is_no_change(checkout):
    checkout.set_up()
    for name in ('requirements.txt', 'setup.py'):
        (checkout.folder / name).touch()
    assert checkout.set_up() == (0, [], '')


def test_another_python_makes_a_new_environment(checkout):
    checkout.set_up()
    checkout.set(version='3.12.0')
    assert checkout.set_up() == (0, ['venv', ALL], '')


def test_a_moved_checkout_makes_a_new_environment(checkout):
    checkout.set_up()
    moved = checkout.folder.with_name('moved')
    checkout.folder.rename(moved)
    checkout.folder = moved
    assert checkout.set_up() == (0, ['venv', ALL], '')


@pytest.mark.parametrize('kind', [signal.SIGINT, signal.SIGKILL], ids=lambda kind: kind.name)
def test_an_interrupted_set_up_is_repeated(checkout, kind):
    checkout.set(hang='')
    running = checkout.start()
    end = monotonic() + 60
    while not (checkout.notes / 'hanging').exists():
        assert running.poll() is None
        assert monotonic() < end
        os.sched_yield()
    os.killpg(running.pid, kind)
    running.communicate(timeout=60)
    assert running.returncode != 0
    (checkout.notes / 'hang').unlink()
    assert checkout.set_up() == (0, ['venv', ALL], '')


def test_a_failed_installation_is_continued(checkout):
    checkout.set(no_network='1')
    code, asked, complaint = checkout.set_up()
    assert (code, asked) == (1, ['venv', ALL])
    assert complaint.startswith('pip could not install requirements.txt into .venv')
    checkout.set(no_network='0')
    assert checkout.set_up() == (0, [ALL], '')


def test_two_at_once_set_up_once(checkout):
    both = [checkout.start(), checkout.start()]
    for running in both:
        running.communicate(timeout=60)
    assert [running.returncode for running in both] == [0, 0]
    assert checkout.asked() == ['venv', ALL]


def test_a_python_out_of_range_is_refused_with_its_version(checkout):
    checkout.set(out_of_range='1')
    code, asked, complaint = checkout.set_up()
    assert (code, asked) == (1, [])
    assert complaint == (
        'No Python 3.10 to 3.13 was found: sudo apt install python3 python3-venv, '
        'or name one with PYTHON=<interpreter>.'
    )


def test_a_missing_ensurepip_names_the_package(checkout):
    checkout.set(no_ensurepip='1')
    code, asked, complaint = checkout.set_up()
    assert (code, asked) == (1, [])
    assert complaint == 'python3 lacks ensurepip: sudo apt install python3-venv'
