# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""The library that draws in the browser, from the Python package bokeh."""

from pathlib import Path

from pam_ros.errors import PamError

OLDEST = (3, 4)
# What page.html needs; nothing in them is changed.
NAMES = ('bokeh.min.js', 'bokeh-api.min.js')
_INSTALL = "install it with pip install 'bokeh>=3.4', or draw with --png FILE, which works without"


def bokeh_files() -> dict[str, bytes]:
    """Return the scripts of the installed BokehJS by their names.

    Raises PamError, with a sentence for the user, if there is none or if it is too old.
    """
    try:
        import bokeh
    except ImportError as error:
        raise PamError(
            f'the page is drawn by the Python package bokeh, which is not installed: {_INSTALL}'
        ) from error
    major, minor = (int(part) for part in bokeh.__version__.split('.')[:2])
    if (major, minor) < OLDEST:
        raise PamError(f'bokeh {bokeh.__version__} is too old for the page: {_INSTALL}')
    folder = Path(bokeh.__file__).parent / 'server' / 'static' / 'js'
    try:
        return {name: (folder / name).read_bytes() for name in NAMES}
    except OSError as error:
        raise PamError(
            f'{error.filename} of the Python package bokeh cannot be read '
            f'({error.strerror}): {_INSTALL}'
        ) from error
