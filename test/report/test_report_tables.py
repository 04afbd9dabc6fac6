# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""residual.csv, read back and compared with the result."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from pam_ros.report.tables import residual_csv


def read(text):
    return list(csv.DictReader(io.StringIO(text)))


@pytest.mark.slow
def test_every_sample_with_its_residuals(tested):
    result, _, runs = tested
    rows = read(residual_csv(runs, result.quantity, result.unit))
    assert len(rows) == sum(run.t.size for run in runs)
    at = 0
    for k, run in enumerate(runs):
        part = rows[at : at + run.t.size]
        at += run.t.size
        assert {(row['recording'], row['segment']) for row in part} == {(run.name, str(k))}
        assert [row['set'] == 'held_out' for row in part] == run.held.tolist()
        columns = {
            't_s': run.t,
            'position_m': run.target,
            **{
                f'position_{name}_m': run.simulated[s]
                for s, name in enumerate(('declared', 'retuned', 'augmented'))
            },
            'residual_augmented_m': run.target - run.simulated[2],
        }
        for name, values in columns.items():
            read_back = np.array([float(row[name]) for row in part])
            assert read_back == pytest.approx(values, rel=1e-8, abs=1e-15), name


def test_held_length_has_forces(held):
    result, _, runs = held
    first = read(residual_csv(runs, result.quantity, result.unit))[0]
    assert float(first['force_N']) == pytest.approx(runs[0].target[0])
    assert float(first['residual_declared_N']) == pytest.approx(
        runs[0].target[0] - runs[0].simulated[0][0], abs=1e-6
    )


def test_a_name_with_a_comma_stays_one_cell(friction):
    result, _, (run,) = friction
    text = residual_csv([replace(run, name='a, "b".csv')], result.quantity, result.unit)
    assert read(text)[3]['recording'] == 'a, "b".csv'
