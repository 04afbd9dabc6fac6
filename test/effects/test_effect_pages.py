# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of the effects are those of the library, with what each effect declares.

The numbers under a picture are those of its simulation, which is made again here. So a page, and
the picture that is written with it, cannot stay behind a change of the equations.
"""

import re
import sys

import numpy as np
import pytest
from PIL import Image

from pam_ros.effects import EFFECTS, PressureLag
from pam_ros.excitation.command import command_line
from support.pages import ROOT, blocks, part, rows, text_of

sys.path.insert(0, str(ROOT / 'tools'))
import effect_pages
import effect_signature

GUIDE, FOLDER, PICTURES = effect_pages.GUIDE, effect_pages.FOLDER, effect_pages.PICTURES
BY_EFFECT = pytest.mark.parametrize('effect', EFFECTS, ids=lambda e: e.name)


def test_the_tables_are_those_of_the_library():
    text = text_of(GUIDE)
    assert text == effect_pages.with_tables(text), 'make pages writes them'


def test_there_is_a_page_and_a_picture_of_each_effect_and_no_other():
    names = {effect.name for effect in EFFECTS}
    assert {path.stem for path in FOLDER.iterdir()} == names
    assert {path.stem for path in PICTURES.iterdir()} == names


@pytest.mark.slow
@pytest.mark.needs_numba
@BY_EFFECT
def test_the_page_is_that_of_the_library_and_of_its_simulation(effect):
    shown = effect_signature.signature_of(effect.example())
    page = text_of(FOLDER / f'{effect.name}.md')
    assert page == effect_pages.page(effect, shown), 'make pages writes it'


def test_the_tables_contain_what_each_effect_declares():
    of_effects, of_experiments = rows(part(GUIDE, 'effects')), rows(part(GUIDE, 'experiments'))
    for effect, row, other in zip(EFFECTS, of_effects, of_experiments, strict=True):
        page = f'[`{effect.name}`](effects/{effect.name}.md)'
        place = 'joint' if effect.acts_on_joint() else 'muscle'
        assert row[:2] == [page, effect.text]
        assert row[2].startswith(f'{place}: ')
        assert row[3:] == [effect.signature]
        assert (other[0], other[2]) == (page, effect.experiment)
        assert re.findall(r'`(\w+)`', other[1]) == list(effect.rivals)


@BY_EFFECT
def test_the_page_contains_what_the_effect_declares(effect):
    page = FOLDER / f'{effect.name}.md'
    text = text_of(page)
    for declared in (effect.source, effect.signature, effect.experiment, repr(effect.example())):
        assert declared in text
    assert blocks(page, 'text') == [f'{effect.equation}\n']
    consoles = ''.join(blocks(page, 'console'))
    for name in effect.example().given:
        assert f' -p effects.{effect.name}.{name}:=' in consoles
    assert ('pam_excite' in consoles) == (effect.excitation is not None)
    if effect.excitation is not None:
        assert f'$ ros2 run pam_ros {command_line(effect.excitation)}\n' in consoles
    parameters = [re.search(r'`effects\.(\w+)\.(\w+)`', row[0]).groups() for row in rows(text)]
    names = [p.name for p in effect.parameters()]
    assert parameters == [(effect.name, name) for name in (*names, 'onset')]


@BY_EFFECT
def test_the_equation_has_every_parameter_by_its_name(effect):
    symbols = set(re.findall(r'[a-z_]+', effect.equation))
    assert {p.name for p in effect.parameters()} <= symbols


def test_the_programme_has_steps_ramps_and_a_chirp():
    t, command = effect_signature.programme()
    np.testing.assert_allclose(np.diff(t), 1.0 / effect_signature.RATE)
    at = dict(zip(np.round(t, 6), command / 1e3, strict=True))
    assert at[-5.0] == at[0.995] == 100.0
    assert (at[1.0], at[2.995], at[3.0]) == (300.0, 300.0, 200.0)
    assert (at[12.5], at[15.5], at[26.5]) == (pytest.approx(250.0), 400.0, 0.0)
    crossings = np.flatnonzero(np.diff(np.sign(command[t >= 29.0] / 1e3 - 250.0)))
    # Half a period at 0.3 Hz and at 2.5 Hz, with a frequency that grows exponentially.
    assert np.diff(crossings)[[0, -1]] / effect_signature.RATE == pytest.approx(
        [1.35, 0.21], abs=0.05
    )


def blurred(path):
    """Return the grey values of a picture, 0 to 255, as the means of blocks of pixels."""
    with Image.open(path) as picture:
        size = picture.width // 8, picture.height // 8
        return np.asarray(picture.convert('L').resize(size, Image.Resampling.BOX), float)


@pytest.mark.slow
@pytest.mark.needs_numba
def test_a_picture_is_drawn_anew_as_it_is_stored(tmp_path):
    """But for what a release of matplotlib moves by a pixel: blocks of 8 x 8 are compared."""
    lag = PressureLag.example()
    effect_signature.draw(lag, effect_signature.signature_of(lag), tmp_path / 'lag.png')
    new = blurred(tmp_path / 'lag.png')
    assert np.abs(new - blurred(PICTURES / 'pressure_lag.png')).mean() < 1.5
    assert np.abs(new - blurred(PICTURES / 'leak.png')).mean() > 2.5
