# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Run the notebooks of docs/ and store what their cells print and draw: ``make notebook``.

Neither data about the machine nor the time of the run are stored.
"""

import base64
import io
import os
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbformat import NotebookNode
from PIL import Image

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / 'docs' / 'notebooks').glob('*.ipynb'))
# As in pyproject.toml for the tests: scipy before 1.12 warns of the rounding of its SLSQP solver.
IGNORED = 'ignore:Values in x were outside bounds:RuntimeWarning'
DEADLINE = 300  # s; longest time of a cell
METADATA = {
    'kernelspec': {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'},
    'language_info': {'name': 'python'},
}


def read(path: Path) -> NotebookNode:
    """Return the notebook of a file."""
    return nbformat.read(path, as_version=4)


def executed(notebook: NotebookNode, folder: Path) -> NotebookNode:
    """Return a copy of *notebook* with the outputs of a fresh kernel, which works in *folder*.

    The kernel is of this interpreter, imports the package of this checkout, and has no settings of
    the user. Raises nbclient.exceptions.CellExecutionError where a cell raises.
    """
    copy = nbformat.from_dict(notebook)
    with TemporaryDirectory() as own:
        paths = [str(ROOT), *filter(None, [os.environ.get('PYTHONPATH')])]
        environment = {
            **os.environ,
            'IPYTHONDIR': own,
            'MPLBACKEND': 'module://matplotlib_inline.backend_inline',
            'PYTHONPATH': os.pathsep.join(paths),
            'PYTHONWARNINGS': IGNORED,
        }
        kernel = AsyncKernelManager(
            kernel_name='python3',
            kernel_spec_manager=KernelSpecManager(kernel_dirs=[]),
            connection_file=str(Path(own) / 'kernel.json'),
            transport='ipc',  # no ports, which other programs could take at the same moment
        )
        client = NotebookClient(
            copy,
            km=kernel,
            timeout=DEADLINE,
            resources={'metadata': {'path': str(folder)}},
            record_timing=False,
            coalesce_streams=True,
            shutdown_kernel='immediate',  # it has nothing to save
        )
        client.execute(env=environment, cleanup_kc=True)  # ends the kernel as well
    return clean(copy)


def clean(notebook: NotebookNode) -> NotebookNode:
    """Remove all metadata from *notebook* except those of MyST-NB, and reduce its pictures."""
    notebook.metadata = nbformat.from_dict(METADATA)
    for cell in notebook.cells:
        cell.metadata = nbformat.from_dict(
            {name: value for name, value in cell.metadata.items() if name == 'mystnb'}
        )
        for output in cell.get('outputs', []):
            if 'metadata' in output:
                output.metadata = nbformat.from_dict({})
            data = output.get('data', {})
            if 'image/png' in data:
                data['image/png'] = small(data['image/png'])
    return notebook


def small(picture: str) -> str:
    """Return a picture with 64 colours and without metadata; both are PNG in base64."""
    drawn = Image.open(io.BytesIO(base64.b64decode(picture))).convert('RGB')
    file = io.BytesIO()
    drawn.quantize(64, dither=Image.Dither.NONE).save(file, 'PNG', optimize=True)
    return base64.b64encode(file.getvalue()).decode('ascii')


def main() -> None:
    """Run each notebook in an empty folder and write it with its outputs."""
    for path in NOTEBOOKS:
        with TemporaryDirectory() as folder:
            nbformat.write(executed(read(path), Path(folder)), path)
        print(f'{path.relative_to(ROOT)}: {path.stat().st_size / 1e3:.0f} kB')


if __name__ == '__main__':
    main()
