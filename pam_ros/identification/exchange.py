# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that were chosen when others were still missing, each against its rivals once more."""

from collections.abc import Sequence
from dataclasses import replace

from pam_ros.effects.base import Effect
from pam_ros.identification.admission import ABOUT, Tried
from pam_ros.identification.candidate import EARNED, Fit, released
from pam_ros.identification.elimination import became, dropped
from pam_ros.identification.evidence import SIGNIFICANCE
from pam_ros.identification.round import NEAR, Setting, try_effects, weighed

NEARLY = 0.5  # share of the fall that an effect brought from which others came near it


def exchanged(
    fit: Fit, rounds: Sequence[tuple[Tried, ...]], setting: Setting
) -> tuple[Fit, list[tuple[Tried, ...]]]:
    """Return *fit* with each effect but the last exchanged for a rival that explains more.

    Or for one that came near it in its round, when others were still missing and many parameters
    could make up for them; or begun anew, where that leads to a better place; or, the last one
    too, exchanged for one that it contains and that explains about as much. And the *rounds* with
    the candidates of each exchange behind them.
    """
    model, rounds = setting.model, list(rounds)
    for name in fit.effects if len(fit.effects) > 1 else ():
        effect = next(e for e in model.library if e.name == name)
        is_near = fit.fit_error < NEAR * setting.noise.sigma
        is_settled = is_near or name == fit.effects[-1]
        others = {*effect.contains, *_near(name, fit, rounds)}
        if not is_settled:
            others |= {name, *effect.rivals}
        there = {*fit.effects, *(e.name for e in model.all_present)} - {name}
        rivals = [e for e in model.library if e.name in others and e.name not in there]
        if not rivals:
            continue
        base = dropped(fit, name, model, setting.pool)
        _, tried = try_effects(base, rivals, setting)
        tried = tuple(_from_container(t, fit, base, effect, setting) for t in tried)
        for one in sorted(tried, key=lambda t: t.fit.score):
            is_plainer = one.effect.name in effect.contains
            explains = one.fit.score < fit.score - EARNED or (
                is_plainer and one.fit.held_error < (1.0 + ABOUT) * fit.held_error
            )
            clear = one.evidence.interval_clear and one.evidence.p < SIGNIFICANCE
            if explains and clear:
                if one.effect is not effect:
                    chosen = replace(one, chosen=True)
                    rounds.append(tuple(chosen if t is one else t for t in tried))
                fit = released(one.fit, model, one.effect, setting.pool)
                break
    return fit, rounds


def _near(name: str, fit: Fit, rounds: Sequence[tuple[Tried, ...]]) -> list[str]:
    """Return what came near effect *name* in its round; nothing for the last one of *fit*.

    That one was chosen with all others in their places.
    """
    if name == fit.effects[-1]:
        return []
    for tried in rounds:
        chosen = next((t for t in tried if t.chosen and t.effect.name == name), None)
        if chosen is not None and chosen.evidence.gain > 0.0:
            least = NEARLY * chosen.evidence.gain
            return [
                t.effect.name
                for t in tried
                if t is not chosen
                and t.evidence.gain > least
                and t.evidence.interval_clear
                and t.evidence.p < SIGNIFICANCE
            ]
    return []


def _from_container(tried: Tried, fit: Fit, base: Fit, effect: Effect, setting: Setting) -> Tried:
    """Return *tried* as it is, or as it is where *fit* has it in *effect*, if that is better."""
    if tried.effect.name not in effect.contains:
        return tried
    same = became(fit, effect.name, tried.effect, setting.model, setting.pool)
    if same.score > tried.fit.score:
        return tried
    return replace(weighed(base, same, tried.effect.name, setting), chosen=False)
