# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The table of all rigs: a CSV file, a page, and a summary in a few lines."""

import csv
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, fields

from pam_ros.batch.row import NOT_IDENTIFIED, RigRow
from pam_ros.identification.result import Verdict
from pam_ros.report import style
from pam_ros.report.page import environment_of
from pam_ros.report.provenance import versions

HEADINGS = {
    **{str(verdict): verdict.heading for verdict in Verdict},
    NOT_IDENTIFIED: 'Not identified',
}


def csv_text(rows: Sequence[RigRow]) -> str:
    """Return the table as CSV with a line of names; errors are in SI, and empty if not known."""
    file = io.StringIO()
    writer = csv.DictWriter(file, [field.name for field in fields(RigRow)], lineterminator='\n')
    writer.writeheader()
    writer.writerows(asdict(row) for row in rows)
    return file.getvalue()


def page(rows: Sequence[RigRow], command: str, date: str) -> str:
    """Return the table as HTML, with a link to the report of each rig."""
    environment = environment_of('batch', 'report')
    return environment.get_template('index.html.j2').render(
        rows=rows,
        headings=HEADINGS,
        headline=f'{len(rows)} rigs' if len(rows) > 1 else '1 rig',
        summary=summary(rows),
        command=command,
        date=date,
        versions=versions(),
        style=style,
    )


def summary(rows: Sequence[RigRow]) -> list[str]:
    """Return how many rigs have each verdict, and each set of effects, most frequent first."""
    lines = []
    for verdict, count in Counter(row.verdict for row in rows).most_common():
        effects = Counter(row.effects for row in rows if row.verdict == verdict and row.effects)
        found = ', '.join(f'{name} {n}' for name, n in effects.most_common())
        lines.append(f'{HEADINGS[verdict]}: {count}{f" ({found})" if found else ""}')
    return lines
