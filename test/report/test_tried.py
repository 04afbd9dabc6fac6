# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that nearly replaced another are shown as such, and none contradicts the verdict."""

from dataclasses import replace

import pytest

from pam_ros.identification.result import Estimate
from pam_ros.identification.wording import Scale
from pam_ros.report import rows, tried
from pam_ros.report.page import not_excluded

MM = Scale(1e3, 'mm')
LATER = 'not needed in addition to the effects that were found later'


@pytest.fixture
def made(friction):
    """Return a function that makes a result with two effects and the given candidates."""
    result = friction[0]
    template, finding = result.candidates[0], replace(result.effects[0], alternatives=())
    added = ('pressure_lag', 'coulomb_friction')
    last = replace(
        result.stages[-1],
        parameters={f'effects.{name}.x': Estimate(1.0, 0.9, 1.1, '') for name in added},
    )
    findings = tuple(replace(finding, name=name) for name in added)

    def result_with(*given):
        candidates = []
        for effect, parents, fall, decision, reason, unknowns in given:
            values = {str(k): Estimate(1.0, 0.9, 1.1, '') for k in range(unknowns)}
            candidates.append(
                replace(
                    template, effect=effect, parents=parents, score_fall=fall, choose_error=1e-4,
                    decision=decision, reason=reason, parameters=values,
                )
            )  # fmt: skip
        return replace(
            result,
            stages=(*result.stages[:2], last),
            effects=findings,
            candidates=tuple(candidates),
        )

    return result_with


CHOSEN = (
    ('pressure_lag', (), 4000.0, 'chosen', 'lowers the score by 4000', 2),
    ('coulomb_friction', ('pressure_lag',), 2919.0, 'chosen', 'lowers the score by 2919', 1),
)


def test_an_effect_of_a_later_round_is_not_rejected_in_an_earlier_one(made):
    early = ('coulomb_friction', (), 500.0, 'rejected', 'pressure_lag lowers the score more', 1)
    result = made(*CHOSEN, early)
    assert tried.decision_of(result.candidates[-1], result) == (
        'not in this round',
        'chosen in addition to pressure lag; here, pressure_lag lowers the score more',
    )


def test_the_best_of_a_round_is_not_called_needless_if_it_is_in_the_last_model(made):
    detour = ('coulomb_friction', ('creep',), 900.0, 'rejected', LATER, 1)
    result = made(*CHOSEN, detour)
    assert tried.decision_of(result.candidates[-1], result)[1] == (
        'chosen in addition to pressure lag'
    )


def test_a_lower_score_than_that_of_the_chosen_effect_is_a_near_tie_with_its_reason(made):
    near = ('hysteresis', ('pressure_lag',), 2922.0, 'rejected', LATER, 3)
    result = made(*CHOSEN, near)
    decision, reason = tried.decision_of(result.candidates[-1], result)
    assert decision == 'near tie'
    assert reason == (
        'with hysteresis instead of coulomb friction the score of the last model is about the '
        'same; hysteresis contains coulomb friction, which is simpler and explains nearly as much'
    )
    sentences = not_excluded(result, MM)
    assert 'No other effect of the library explains these data as well as pressure lag.' in (
        sentences
    )
    (about,) = (one for one in sentences if 'coulomb' in one)
    assert about.startswith('With hysteresis instead of coulomb friction the score')


def test_scores_of_the_same_effects_are_compared_in_any_order(made):
    first = ('coulomb_friction', (), 600.0, 'rejected', 'x', 1)
    other = ('leak', ('coulomb_friction',), 6340.0, 'rejected', LATER, 3)
    result = made(*CHOSEN, first, other)
    rival = tried.rival_of(result.candidates[-1], result)
    assert rival == tried.Rival('leak', 'pressure_lag', pytest.approx(21.0), is_last=True)
    decision, reason = tried.decision_of(result.candidates[-1], result)
    assert decision == 'lower score'
    assert 'the score of the last model is lower by 21; leak contains pressure lag' in reason


@pytest.mark.parametrize(('fall', 'is_near'), [(2908.0, False), (2910.0, True), (2930.0, True)])
def test_the_margin_of_the_score_decides_what_is_near(made, fall, is_near):
    result = made(*CHOSEN, ('slack', ('pressure_lag',), fall, 'rejected', 'x', 2))
    assert (tried.kind_of(result.candidates[-1], result) == 'near') is is_near


def test_the_reason_is_of_the_fewer_parameters_or_that_of_the_search(made):
    near = ('slack', ('pressure_lag',), 2922.0, 'rejected', 'the error is 40 % larger', 2)
    result = made(*CHOSEN, near)
    assert tried.decision_of(result.candidates[-1], result)[1].endswith(
        '; coulomb friction has fewer parameters (1 instead of 2)'
    )
    result = made(*CHOSEN, (*near[:-1], 1))
    assert tried.decision_of(result.candidates[-1], result)[1].endswith(
        '; the error is 40 % larger'
    )


def test_a_tie_in_one_round_only_is_stated_as_such(made):
    near = ('creep', (), 4003.0, 'rejected', 'the error is 40 % larger', 3)
    result = made(*CHOSEN, near)
    (_, second, *_) = not_excluded(result, MM)
    assert second == (
        'In one round creep lowers the score about as much as pressure lag, but pressure lag has '
        'fewer parameters (2 instead of 3).'
    )


def test_what_was_not_nearly_chosen_is_folded(made):
    others = [
        ('slack', ('pressure_lag',), 3.0, 'untestable', 'x', 1),
        ('payload', ('pressure_lag',), 30.0, 'rejected', 'x', 1),
        ('creep', (*CHOSEN[1][1], 'coulomb_friction'), -5.0, 'rejected', 'x', 1),
        ('payload', (*CHOSEN[1][1], 'coulomb_friction'), -3.0, 'rejected', 'x', 1),
    ]
    first, second, third = rows.rounds(made(*CHOSEN, *others), MM)
    assert [len(one.shown) for one in (first, second, third)] == [1, 1, 1]
    assert first.folded == []
    assert [row.cells['effect'] for row in second.folded] == ['payload', 'slack']
    assert (
        second.summary == '2 more effects, not chosen, 1 of them since these data cannot show it'
    )
    assert third.shown[0].cells['effect'] == 'payload'  # the best of those that were rejected
    assert third.summary == '1 more effect, not chosen'


def test_a_simpler_effect_is_no_reason_where_it_explains_less(made):
    first = ('coulomb_friction', (), 600.0, 'rejected', 'x', 1)
    other = ('leak', ('coulomb_friction',), 6340.0, 'rejected', 'the error is 40 % larger', 3)
    result = made(*CHOSEN, first, other)
    smaller = replace(result.candidates[-1], choose_error=0.9e-4)
    result = replace(result, candidates=(*result.candidates[:-1], smaller))
    assert tried.decision_of(smaller, result) == (
        'lower score',
        'with leak instead of pressure lag the score of the last model is lower by 21; the error '
        'is 40 % larger',
    )
