# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What users give stands in sentences so that no terminal or log takes harm."""

import os
import pickle

from hypothesis import given
from hypothesis import strategies as st

from pam_ros.errors import LONGEST_TEXT, LONGEST_WORD, PamError, RecordingError, printable, shown


def test_a_plain_sentence_is_left_as_it_is():
    sentence = "rig.csv: position = 20 µm at 3.2·10⁻⁴ s, l0 = 'größe'"
    assert shown(sentence) == str(PamError(sentence)) == sentence


def test_control_characters_are_escaped():
    name = 'a\x1b[31mb\nc\rd\0e\u202ef\udcff'
    assert str(RecordingError(name)) == r'a\x1b[31mb\nc\rd\x00e\u202ef\udcff'


def test_bytes_of_a_file_name_are_its_letters_where_they_are_utf_8():
    name = 'größe'.encode().decode('ascii', 'surrogateescape')  # as the locale C has it
    assert printable(name) == 'größe'
    assert printable(os.fsdecode(b'm\xfcller.csv')) == r'm\udcfcller.csv'
    assert printable('\ud800\n') == r'\ud800\n'
    long = 'x' * 10**4
    assert printable(long) == long


def test_long_names_are_cut_in_their_middle():
    text = str(PamError(f'column {"x" * 10**6}end is not known'))
    assert text.startswith('column xxx')
    assert text.endswith('...' + 'x' * 37 + 'end is not known')
    assert len(text) < 2 * LONGEST_WORD


def test_long_sentences_are_cut_before_their_end():
    text = str(PamError('many words ' * 10**5 + 'end'))
    assert ' [...] ' in text
    assert text.endswith('end')
    assert len(text) <= LONGEST_TEXT


@given(st.text(st.characters(codec=None)) | st.text('a \n', min_size=190, max_size=400))
def test_what_is_shown_is_printable_and_stays(text):
    once = shown(text)
    assert once.isprintable()
    assert shown(once) == once
    assert str(pickle.loads(pickle.dumps(PamError(text)))) == once
