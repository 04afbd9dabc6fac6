# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Good files with some of their bytes changed: read, or refused with a sentence of the package."""

import contextlib

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pam_ros.errors import PamError
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from pam_ros.settings.rig import load_rig

ROWS = [f'{k / 100},{100 + k % 7},{k / 8}' for k in range(12)]
CSV = '\n'.join(['# a rig', 't_s,pressure_command_kPa,position_mm', *ROWS, '']).encode()
# What is special to a format stands among any other bytes.
CSV_PARTS = (b'"', b',', b';', b'\n', b'\r', b'\0', b'nan', b'1e999', b'\xff\xfe', b'\x1b[2J')
YAML = b"""# a rig
/**:
  ros__parameters:
    mass: 20.0
    source: 'a: text'
    effects: {creep: {gain: 5e-2}, payload.mass: -1}
columns:
  adc: force_N*0.4
"""
YAML_PARTS = (
    *(
        b': ',
        b'- ',
        b'[',
        b'{',
        b']',
        b'}',
        b',',
        b'"',
        b"'",
        b'#',
        b'\n',
        b'\t',
        b'|',
        b'? ',
        b'<<',
    ),
    *(
        b'&a ',
        b'*a',
        b'!',
        b'!!int ',
        b'!!python/name:x ',
        b'2020-13-45',
        b'0x_',
        b'1:99',
        b'---\n',
    ),
)


@st.composite
def spoiled(draw, good, parts):
    """Return the bytes *good* with up to four stretches replaced, removed or put in."""
    data = good
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(data)))
        gone = draw(st.sampled_from((0, 1, 2, 9, len(data))))
        put = draw(st.one_of(st.sampled_from((b'', *parts)), st.binary(max_size=8)))
        data = data[:at] + put + data[at + gone :]
    return data


QUICK = settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@pytest.fixture(scope='module')
def file(tmp_path_factory):
    return tmp_path_factory.mktemp('spoiled') / 'one'


@QUICK
@given(data=spoiled(CSV, CSV_PARTS) | spoiled(CSV.decode().encode('utf-16'), CSV_PARTS))
def test_csv(file, data):
    file.write_bytes(data)
    with contextlib.suppress(PamError):
        read_csv(file, ColumnMapping())


@QUICK
@given(data=spoiled(YAML, YAML_PARTS))
def test_yaml(file, data):
    file.write_bytes(data)
    with contextlib.suppress(PamError):
        load_rig(file)
    with contextlib.suppress(PamError):
        read_mapping(file=file)
