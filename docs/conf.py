# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How Sphinx makes a site of the pages: ``make docs``.

The pages are those that are read in the repository; nothing is written for the site alone but
``api.rst``, which is filled here from the docstrings of the public names. The top folder of the
repository is the source folder, so that links between pages are right as they are written. A link
to another file of the repository becomes a download.
"""

import dataclasses
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

import pam_ros  # noqa: E402
from pam_ros.parameters import described  # noqa: E402

# The order of the pages at the side. Sphinx refuses a page that is missing here, or is not there.
NAVIGATION = {
    'Tutorials': (
        'docs/tutorials/muscle_in_ten_minutes',
        'docs/notebooks/muscle',
        'docs/tutorials/your_own_rig',
        'docs/tutorials/your_own_controller',
        'docs/tutorials/your_own_muscle_and_joint',
        'docs/tutorials/add_an_effect',
    ),
    'Programs': (
        'docs/simulator',
        'docs/controller',
        'docs/controller_faults',
        'docs/controller_disturbances',
        'docs/controller_results',
        'docs/bench',
        'docs/cluster',
        'docs/command',
        'docs/plot',
        'docs/recordings',
        'docs/identification',
        'docs/identification_trials',
        'docs/report',
        'docs/time',
        'docs/ros2_control',
        'docs/security',
    ),
    'Physics': (
        'docs/model',
        'docs/effects',
        'docs/joints',
    ),
    'Python': (
        'docs/python',
        'docs/api',
    ),
    'More': (
        'All pages <docs/README>',
        'docs/results',
        'docs/glossary',
        'ARCHITECTURE',
        'CONTRIBUTING',
        'QUALITY_DECLARATION',
        'Change log <CHANGELOG>',
    ),
}
# The pages below that of the effects.
EFFECTS = [f'/docs/effects/{effect.name}' for effect in pam_ros.EFFECTS]
START = 'README'

project = 'pam_ros'
version = release = pam_ros.__version__
extensions = ['sphinx.ext.autodoc', 'myst_nb']
root_doc = START
include_patterns = ['*.md', '*.rst', 'docs/*.md', 'docs/*.rst', 'docs/tutorials/*.md']
include_patterns += ['docs/effects/*.md', 'docs/notebooks/*.ipynb']
nb_execution_mode = 'off'  # a test has run the cells, whose outputs are stored
myst_heading_anchors = 6  # every heading can be linked to, by the name that it has on GitHub
python_maximum_signature_line_length = 80
toc_object_entries_show_parents = 'hide'
autodoc_default_options = {'members': True, 'member-order': 'bysource'}
autodoc_preserve_defaults = True

html_theme = 'sphinx_rtd_theme'
html_theme_options = {'navigation_depth': 3}
html_title = f'pam_ros {release}'
html_static_path = ['site']
html_css_files = ['site.css']
html_copy_source = False
html_show_copyright = False
templates_path: list[str] = []


def groups_of_names() -> dict[str, list[str]]:
    """Return the public names by what they are for, as the table of docs/python.md has them."""
    page = (ROOT / 'docs' / 'python.md').read_text(encoding='utf-8')
    table = page.partition('|---|---|\n')[2].partition('\n\n')[0]
    rows = [line.strip('| ').split(' | ', 1) for line in table.splitlines()]
    return {what: re.findall(r'`(\w+)`', names) for what, names in rows}


def documented(name: str) -> str:
    """Return the directive that takes the docstring of a public name."""
    public = getattr(pam_ros, name)
    if public in pam_ros.EFFECTS:  # its methods are those of every Effect, which stands above
        return f'.. autoclass:: pam_ros.{name}\n   :no-members:\n'
    if isinstance(public, type):
        return f'.. autoclass:: pam_ros.{name}\n'
    if callable(public):
        return f'.. autofunction:: pam_ros.{name}\n'
    listed = ', '.join(f'``{one.name}``' for one in public)
    return f'.. py:data:: pam_ros.{name}\n\n   In their order: {listed}.\n'


def reference() -> str:
    """Return the sections of the reference as reStructuredText."""
    parts = []
    for what, names in groups_of_names().items():
        title = what[0].upper() + what[1:]
        parts += [f'{title}\n{"-" * len(title)}\n', *map(documented, names)]
    return '\n'.join(parts)


def listed(pages, *options: str) -> str:
    """Return the list of *pages* as Markdown that is not shown on a page itself."""
    return '\n'.join(['```{toctree}', ':hidden:', *options, '', *pages, '```', ''])


def navigation() -> str:
    """Return the lists of pages at the side."""
    return '\n'.join(
        listed(pages, f':caption: {caption}') for caption, pages in NAVIGATION.items()
    )


def add_to_source(app, name, content):
    """Add what the repository need not show to the source of a page."""
    if name == START:
        content[0] += '\n' + navigation()
    if name == 'docs/effects':
        after = '<!-- /effects -->\n'
        content[0] = content[0].replace(after, f'{after}\n{listed(EFFECTS)}\n')
    if name == 'docs/api':
        content[0] += '\n' + reference()


def complete(app, what, name, public, options, lines):
    """Make reStructuredText of a docstring, and add the fields of a dataclass to its own.

    In docstrings ``|`` is an absolute value, but for what stands in code.
    """
    lines[:] = [re.sub(r'(``.*?``)|\|', lambda one: one[1] or r'\|', line) for line in lines]
    if what == 'class' and dataclasses.is_dataclass(public):
        lines += ['', *(f':param {field}: {text}' for field, text in fields(public)), '']


# What types are called in the source, before Python spells them out.
ARRAY_LIKE = re.compile(
    r'_Buffer \| _SupportsArray\[.*?_NestedSequence\[complex \| bytes \| str\]'
)
ARRAY = re.compile(r'ndarray\[tuple\[Any, \.\.\.\], dtype\[float64\]\]')


def shorten(app, what, name, public, options, signature, returned):
    """Return a signature without the modules of its types, and as Sphinx can read it."""
    return tuple(text and short(text) for text in (signature, returned))


def short(text):
    """Return types as they are written in the source."""
    text = re.sub(r'~?\b(?:[A-Za-z_]\w*\.)+(?=[A-Za-z_])', '', text.replace('<factory>', '...'))
    return ARRAY.sub('Array', ARRAY_LIKE.sub('ArrayLike', text.replace('~', '')))


def fields(public):
    """Yield the name of each described field of a dataclass and what is known of it."""
    for name, (kind, _, about) in described(public).items():
        unit = f', {about.unit}' if about.unit else ''
        yield name, f'{about.text}{unit} ({about.allowed(kind)})'


def begin(app, problem):
    """Let the folder of the site begin with the start page."""
    if problem is None and app.builder.name == 'html':
        folder = Path(app.outdir)
        shutil.copyfile(folder / f'{START}.html', folder / 'index.html')


def setup(app):
    """Connect the above to the build."""
    app.connect('source-read', add_to_source)
    app.connect('autodoc-process-docstring', complete)
    app.connect('autodoc-process-signature', shorten)
    app.connect('build-finished', begin)
