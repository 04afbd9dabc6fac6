# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What decides is few numbers, each with its reason."""

from dataclasses import FrozenInstanceError, fields

import pytest
from scipy.stats import chi2

from pam_ros.identification.search.criteria import BUDGET, CRITERIA, Budget, Criteria


@pytest.mark.parametrize('kind', [Criteria, Budget])
def test_each_number_is_named_with_its_reason(kind):
    for item in fields(kind):
        assert f'``{item.name}``' in kind.__doc__
    assert len(fields(kind)) <= 12


def test_they_cannot_change_while_a_search_runs():
    for one in (CRITERIA, BUDGET):
        with pytest.raises(FrozenInstanceError):
            setattr(one, fields(one)[0].name, 0.0)


def test_the_strain_of_one_specimen_in_180():
    assert 1.0 / chi2.sf(CRITERIA.strain, 7) == pytest.approx(180.0, rel=0.02)
