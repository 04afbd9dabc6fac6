# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""``report.html``: a page that needs no other files, for the owner of the rig."""

from itertools import pairwise
from pathlib import Path

import jinja2
import numpy as np

from pam_ros.identification.fit.places import effect_of
from pam_ros.identification.identification import Identification
from pam_ros.identification.result import Verdict
from pam_ros.identification.wording import (
    Scale,
    interval,
    listed,
    name_in_words,
    number,
    percent,
    scale_for,
    spoken,
)
from pam_ros.recording.warning_list import warning_list
from pam_ros.report import plots, rows, style
from pam_ros.report.numbers import Table
from pam_ros.report.provenance import Provenance
from pam_ros.report.remainder import remainder_of, structure_in_words
from pam_ros.report.runs import STAGES, Run
from pam_ros.report.time_plots import Curve
from pam_ros.report.tried import rivals_of, why_not
from pam_ros.report.use import uses_of

CONTENTS = (
    ('use', 'Use this result'),
    ('error', 'Error'),
    ('simulated', 'Measured and simulated'),
    ('residual', 'Noise'),
    ('shape', 'Residual'),
    ('candidates', 'Effects tried'),
    ('parameters', 'Parameters'),
    ('data', 'Data'),
    ('next', 'Next experiment'),
    ('provenance', 'Provenance'),
)
LONGEST_LABEL = 30  # most characters of the names of effects above a plot


def page(
    result: Identification,
    runs: list[Run],
    source: Provenance,
    content: Table,
    file: Path,
    no_file: str = '',
) -> str:
    """Return the page as HTML, with its styles, plots and a short script; it loads no files.

    *runs* and *content* are those of the result, see ``runs.py`` and ``numbers.py``. *file* is the
    path of ``identified.yaml``, and *no_file* the reason why there is none, empty if there is one.
    """
    curves = curves_of(result, runs)
    scale = scale_for(result.unit, result.stages[-1].fit_error)
    environment = environment_of('report')
    library = result.stages[0].model.library
    signature = {effect.name: effect.signature for effect in library}
    environment.filters |= {
        'words': name_in_words,
        'number': number,
        'percent': percent,
        'spoken': lambda text: spoken(text, [effect.name for effect in library]),
    }
    return environment.get_template('report.html.j2').render(
        result=result,
        verdict=f'{"" if result.is_complete else "Incomplete: "}{result.verdict.heading}',
        remainder=remainder_of(result, scale),
        not_excluded=not_excluded(result, scale),
        signatures=[signature[effect_of(finding.name)] for finding in result.effects],
        structure=structure_in_words(result.structure, result.regressors),
        contents=CONTENTS,
        curves=curves,
        style=style,
        interval=interval,
        scale=scale,
        held_out='test recordings' if result.test else 'a part of each recording',
        errors=rows.errors(content, scale, {curve.stage: curve.label for curve in curves}),
        pictures=plots.pictures(result, runs, content, curves, scale),
        rounds=rows.rounds(result, scale),
        parameters=rows.parameters(result, source.nominal),
        recordings=rows.recordings(content),
        configuration=rows.configuration(source),
        warnings=warnings_of(result, source),
        inputs=inputs_of(result, source),
        content=content,
        source=source,
        uses=[] if no_file else uses_of(file),
        no_file=no_file,
    )


def environment_of(*folders: str) -> jinja2.Environment:
    """Return the environment of the templates in these *folders* of the package."""
    return jinja2.Environment(
        loader=jinja2.ChoiceLoader(
            [jinja2.PackageLoader('pam_ros', folder) for folder in folders]
        ),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def inputs_of(result: Identification, source: Provenance) -> str:
    """Return the names of the signals that a free run receives."""
    if result.quantity == 'force':
        return 'pressure and length'
    names = {True: 'command', False: 'measured pressure'}
    return ' or '.join(dict.fromkeys(names[one.command is not None] for one in source.recordings))


def curves_of(result: Identification, runs: list[Run]) -> list[Curve]:
    """Return the models that differ, the nominal one first, each with its label."""
    names = [name_in_words(name) for name in result.added]
    effects = listed(names) or 'configured effects'
    if len(effects) > LONGEST_LABEL:
        effects = f'{len(names)} effects'
    labels = ('nominal', 're-tuned', f're-tuned + {effects}')
    found = [Curve(0, labels[0])]
    for before, stage in pairwise(range(len(STAGES))):
        if not all(np.array_equal(r.simulated[before], r.simulated[stage]) for r in runs):
            found.append(Curve(stage, labels[stage]))
    return found


def warnings_of(result: Identification, source: Provenance) -> list[tuple[str, str]]:
    """Return (names of recordings, warning), with an empty name for those on the whole result."""
    whole = [('', warning) for warning in result.own_warnings]
    return [*whole, *warning_list([*source.recordings, *source.test])]


def not_excluded(result: Identification, scale: Scale) -> list[str]:
    """Return sentences on what the data cannot exclude, for every verdict."""
    floor = f'{scale.text(result.noise.sigma)} {scale.unit}'
    sentences = []
    for finding in result.effects:
        name = name_in_words(finding.name)
        others = [name_in_words(other) for other in finding.alternatives]
        if others:
            sentences.append(
                f'Instead of {name} it could be {" or ".join(others)}: these data do not '
                'distinguish them.'
            )
        elif result.is_complete:
            sentences += _nearest(finding.name, result)
        if finding.or_constants:
            sentences.append(
                f'Instead of {name}, constants a1 to a6 far from the nominal ones explain these '
                'data as well.'
            )
    if not result.is_complete:
        sentences.append(
            'The search was stopped before it ended: effects that it had not tried could be '
            'missing as well, or instead of those that are named. What it does at its end may '
            'not have been done: to confirm the effects with finer steps, and to check the loads '
            'and the clocks of the recordings.'
        )
    elif result.verdict == Verdict.NO_MISSING_EFFECT:
        sentences.append(f'Effects that stay below the noise floor of {floor} could be present.')
    elif result.verdict == Verdict.PARAMETERS_WRONG:
        sentences.append(
            'An effect that is equivalent to a change of the parameters could be present: a '
            'payload changes the weight as the mass does, a pressure offset the force as a6 does.'
        )
    elif result.verdict == Verdict.UNEXPLAINED_STRUCTURE:
        sentences.append(
            f'Any effect other than the {len(result.tested)} effects of the library that were '
            'tested could be the cause.'
        )
    elif result.verdict == Verdict.INSUFFICIENT_DATA:
        sentences.append('No effect can be excluded with these data.')
    if result.untestable:
        names = listed([name_in_words(name) for name in result.untestable])
        sentences.append(f'These data cannot show {names}: the table below states what to record.')
    return sentences


def _nearest(name: str, result: Identification) -> list[str]:
    """Return sentences on how well other effects explain the data instead of *name*."""
    chosen, sentences = name_in_words(name), []
    rivals = rivals_of(name, result)
    if not rivals:
        return [f'No other effect of the library explains these data as well as {chosen}.']
    if not any(rival.is_last for _, rival in rivals):
        sentences.append(
            'In the last model, no other effect of the library explains these data as well as '
            f'{chosen}.'
        )
    for candidate, rival in rivals:
        why = why_not(candidate, rival, result) or 'the table below has the reason for the choice'
        compared = rival.compared()
        sentences.append(f'{compared[0].upper()}{compared[1:]}, but {why}.')
    return sentences
