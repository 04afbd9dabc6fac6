# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Good files with some of their bytes changed: read, or refused with a sentence of the package."""

import contextlib
import io
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from pam_ros.errors import PamError
from pam_ros.recording.bag.decode import RosbagsDecoder, Topic
from pam_ros.recording.bag.read import read_bag
from pam_ros.recording.csv_file import read_csv
from pam_ros.recording.mapping import ColumnMapping, read_mapping
from pam_ros.settings.nominal import nominal_joint
from support import bags
from support.assertions import no_error

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
BAG_PARTS = (b'\0', b'\xff' * 4, b'\xff' * 8, b'\1\0\0\0', b'\x89MCAP0\r\n')
JOINT = bytes(bags.STORE.serialize_cdr(bags.joint(1, [0.5], [], [2.0]), bags.JOINT))
DECODE = RosbagsDecoder()


def bag():
    """Return the bytes of a small bag."""
    topics, _ = bags.rig_topics(duration=0.6, late=0.0)
    with TemporaryDirectory() as folder:
        return (bags.write_bag(Path(folder) / 'bag', topics) / 'bag.mcap').read_bytes()


def packed(data, compression):
    """Return a bag's bytes with its messages in small chunks that are compressed in this way."""
    file = io.BytesIO()
    writer = Writer(file, chunk_size=4000, compression=compression)
    writer.start(profile='ros2')
    channels = {}
    for schema, channel, message in make_reader(io.BytesIO(data)).iter_messages():
        if channel.id not in channels:
            number = writer.register_schema(schema.name, schema.encoding, schema.data)
            encoding = channel.message_encoding
            channels[channel.id] = writer.register_channel(channel.topic, encoding, number)
        number = channels[channel.id]
        writer.add_message(number, message.log_time, message.data, message.publish_time)
    writer.finish()
    return file.getvalue()


BAG = bag()
BAGS = {one.name: packed(BAG, one) for one in CompressionType} | {'one chunk': BAG}


def edits(parts):
    """Return the strategy of up to four changes: where, how much goes, what takes its place."""
    put = st.sampled_from((b'', *parts)) | st.binary(max_size=8)
    gone = st.sampled_from((0, 1, 2, 9, 10**6))
    return st.lists(st.tuples(st.floats(0.0, 1.0), gone, put), min_size=1, max_size=4)


def spoiled(data, changes):
    for share, gone, put in changes:
        at = round(share * len(data))
        data = data[:at] + put + data[at + gone :]
    return data


QUICK = settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@pytest.fixture(scope='module')
def file(tmp_path_factory):
    return tmp_path_factory.mktemp('spoiled') / 'one'


@QUICK
@given(changes=edits(CSV_PARTS), code=st.sampled_from(('utf-8', 'utf-16')))
def test_csv(file, changes, code):
    file.write_bytes(spoiled(CSV.decode().encode(code), changes))
    with no_error(), contextlib.suppress(PamError):
        read_csv(file, ColumnMapping())


@QUICK
@given(changes=edits(YAML_PARTS))
def test_yaml(file, changes):
    file.write_bytes(spoiled(YAML, changes))
    with no_error(), contextlib.suppress(PamError):
        nominal_joint(file)
    with no_error(), contextlib.suppress(PamError):
        read_mapping(file=file)


@QUICK
@pytest.mark.parametrize('data', BAGS.values(), ids=BAGS)
@given(changes=edits(BAG_PARTS))
def test_bag(file, data, changes):
    mcap = file.with_suffix('.mcap')
    mcap.write_bytes(spoiled(data, changes))
    with no_error(), contextlib.suppress(PamError):
        read_bag(mcap, ColumnMapping())


@QUICK
@given(changes=edits(BAG_PARTS))
def test_messages(changes):
    with contextlib.suppress(PamError):
        assert DECODE(Topic(bags.JOINT), spoiled(JOINT, changes)).position.dtype == np.float64
