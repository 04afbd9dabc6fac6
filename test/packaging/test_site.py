# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The site that ``make docs`` builds: it has every page and every public name.

Sphinx itself refuses a link, an anchor or a page that is not there; that needs an installation, so
the build is a test of a release. What can be seen without Sphinx is tested each time.
"""

import re
import runpy
import subprocess
from html.parser import HTMLParser

import pytest

import pam_ros
from support.pages import DOCS, PAGES, ROOT, anchors, text_of

SITE = ROOT / 'build' / 'docs'
SOURCES = ('.md', '.rst', '.ipynb')
DEADLINE = 900.0  # s; bounds how long an installation that hangs may take
NAMES = set(pam_ros.__all__) - {'__version__'}


@pytest.fixture(scope='module')
def settings():
    return runpy.run_path(str(DOCS / 'conf.py'))


def listed(settings):
    """Return the pages that the site has, in their order."""
    entries = [settings['START']]
    for pages in settings['NAVIGATION'].values():
        entries += [re.sub(r'.*<(.*)>', r'\1', page) for page in pages]
    return [*entries, *(page.lstrip('/') for page in settings['EFFECTS'])]


def source_of(entry):
    (found,) = (path for suffix in SOURCES if (path := ROOT / f'{entry}{suffix}').exists())
    return found


def test_every_page_is_in_the_navigation_once(settings):
    entries = listed(settings)
    assert len(set(entries)) == len(entries)
    expected = {*PAGES, *ROOT.glob('*.rst'), *DOCS.rglob('*.rst')}
    assert {source_of(entry) for entry in entries} == expected


def test_pages_are_among_the_sources(settings):
    patterns = settings['include_patterns']
    found = {path for pattern in patterns for path in ROOT.glob(pattern)}
    assert {source_of(entry) for entry in listed(settings)} <= found


def test_the_pages_of_the_effects_are_listed_after_their_table(settings):
    text = [text_of(DOCS / 'effects.md')]
    settings['add_to_source'](None, 'docs/effects', text)
    (lines,) = re.findall(
        r'<!-- /effects -->\n\n```\{toctree\}\n:hidden:\n\n(.*?)```', text[0], re.S
    )
    assert lines.split() == settings['EFFECTS']


def test_every_public_name_is_in_the_reference(settings):
    named = [name for names in settings['groups_of_names']().values() for name in names]
    assert set(named) == NAMES
    assert len(named) == len(NAMES)
    reference = settings['reference']()
    for name in NAMES:
        assert len(re.findall(rf':: pam_ros\.{name}$', reference, re.MULTILINE)) == 1, name


def test_bars_of_a_docstring_are_escaped_but_in_code(settings):
    lines = ['the error |s| of ``a | b``']
    settings['complete'](None, 'function', '', None, None, lines)
    assert lines == [r'the error \|s\| of ``a | b``']


def test_types_in_signatures_are_short(settings):
    given = '(p: ~numpy._buffer._Buffer | ~numpy._a._SupportsArray[~numpy.dtype[~typing.Any]] | '
    given += (
        '_NestedSequence[complex | bytes | str], rig: pam_ros.rig.Simulation = <factory>, x=1.5)'
    )
    returned = '~numpy.ndarray[tuple[Any, ...], dtype[float64]]'
    shortened = settings['shorten'](None, 'function', '', None, None, given, returned)
    assert shortened == ('(p: ArrayLike, rig: Simulation = ..., x=1.5)', 'Array')


def test_fields_of_a_dataclass_are_described(settings):
    lines = ['An arm.']
    settings['complete'](None, 'class', '', pam_ros.Pulley, None, lines)
    assert ':param radius: radius of the pulley, m (0.0001 to 1 m)' in lines


def test_site_has_no_second_text_of_a_page():
    for page in sorted((DOCS / 'site').iterdir()):
        assert page.suffix == '.css', page


class Page(HTMLParser):
    """What is in a page of the site: its links and images, and the names of its places."""

    def __init__(self, path):
        super().__init__()
        self.targets, self.places = set(), set()
        self.feed(path.read_text(encoding='utf-8'))

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        self.places.add(found.get('id'))
        if tag in ('a', 'img', 'link', 'script'):
            self.targets.add(found.get('href') or found.get('src'))


@pytest.mark.release
def test_site_is_built_without_a_warning(clean_environment):
    built = subprocess.run(
        ['make', 'docs'],
        cwd=ROOT,
        env=clean_environment,
        capture_output=True,
        text=True,
        timeout=DEADLINE,
        check=False,
    )
    assert built.returncode == 0, built.stdout + built.stderr
    pages = {path: Page(path) for path in SITE.rglob('*.html') if '_static' not in path.parts}
    assert len(pages) > len(PAGES)
    for path, page in pages.items():
        for target in page.targets - {None}:
            if re.match(r'[a-z]+:', target):
                continue
            file, _, place = target.partition('#')
            there = (path.parent / file.partition('?')[0]).resolve() if file else path
            assert there.exists(), f'{path.name}: {target}'
            if place and there in pages:
                assert place in pages[there].places, f'{path.name}: {target}'
    reference = pages[SITE / 'docs' / 'api.html']
    assert {f'pam_ros.{name}' for name in NAMES} <= reference.places
    for source in PAGES:
        built_page = pages[SITE / source.relative_to(ROOT).with_suffix('.html')]
        assert anchors(source) <= built_page.places, source
    # A link to a file that is no page.
    assert [*(SITE / '_downloads').rglob('control.yaml')]
