# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""What a page of the documentation shows: commands, names in code, tables, links, headings.

A notebook is a page whose cells of code are blocks of Python.
"""

import json
import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / 'README.md'
DOCS = ROOT / 'docs'
SIMULATOR, CONTROLLER = DOCS / 'simulator.md', DOCS / 'controller.md'
AT_THE_TOP = [
    README,
    *(ROOT / f'{name}.md' for name in ('ARCHITECTURE', 'CONTRIBUTING', 'QUALITY_DECLARATION')),
]
NOTEBOOKS = sorted((DOCS / 'notebooks').glob('*.ipynb'))
PAGES = [*AT_THE_TOP, *sorted(DOCS.rglob('*.md')), *NOTEBOOKS]
SHELL_WORDS = ('make ', 'ros2 ', 'pam_', '.venv/bin/')


def text_of(page):
    text = page.read_text(encoding='utf-8')
    if page.suffix != '.ipynb':
        return text
    cells = [(cell['cell_type'], ''.join(cell['source'])) for cell in json.loads(text)['cells']]
    return '\n\n'.join(
        f'```python\n{source}\n```\n' if kind == 'code' else source for kind, source in cells
    )


def fences(page):
    """Return what follows each fence of a page: a kind where a block begins, '' at its end."""
    return re.findall(r'^ *```(.*)$', text_of(page), re.MULTILINE)


def blocks(page, kind):
    """Return the contents of a page's code blocks of a kind, such as ``python``."""
    return re.findall(rf'^```{kind}\n(.*?)^```$', text_of(page), re.DOTALL | re.MULTILINE)


def prose(page):
    """Return a page without its code blocks."""
    return re.sub(r'^```.*?^```$', '', text_of(page), flags=re.DOTALL | re.MULTILINE)


def names(page):
    """Return what stands in code within the text."""
    return code(prose(page))


def code(text):
    """Return what stands in code within a text, such as a cell of a table."""
    return re.findall(r'`([^`\n]+)`', text)


def commands(page):
    """Return the commands of a page, in its consoles, scripts and text, as lists of words."""
    shown = [
        line.removeprefix('$ ')
        for block in blocks(page, 'console')
        for line in block.replace('\\\n', ' ').splitlines()
        if line.startswith('$ ')
    ]
    shown += [
        line
        for block in blocks(page, 'bash')
        for line in block.splitlines()
        if line.startswith(SHELL_WORDS)
    ]
    spoken = [name for name in names(page) if ' ' in name and name.startswith(SHELL_WORDS)]
    return [shlex.split(command, comments=True) for command in (*shown, *spoken)]


def part(page, name):
    """Return the part of a page between the comments ``<!-- name -->`` and ``<!-- /name -->``."""
    (found,) = re.findall(rf'<!-- {name} -->\n(.*?)<!-- /{name} -->', text_of(page), re.DOTALL)
    return found


def rows(text):
    """Return the cells of all rows of the tables in a text, but for their headings."""
    found = []
    for table in re.split(r'\n\s*\n', text):
        lines = [line for line in table.splitlines() if line.startswith('|')]
        found += [[cell.strip() for cell in line.strip('|').split('|')] for line in lines[2:]]
    return found


def links(page):
    """Return the targets of a page's links and images that are not on the web."""
    targets = re.findall(r'\]\(([^)\s]+)\)', prose(page))
    return [target for target in targets if '://' not in target]


def anchors(page):
    """Return the names under which a page's headings can be linked to."""
    found = set()
    for heading in re.findall(r'^#+ (.*)$', prose(page), re.MULTILINE):
        plain = re.sub(r'[^\w\- ]', '', heading.lower())
        found.add(plain.strip().replace(' ', '-'))
    return found
