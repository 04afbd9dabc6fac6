# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Package pam_ros for pip and for colcon (ament_python)."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'pam_ros'

# Each program is the module of its name in pam_ros/cli/, with a function main().
PROGRAMS = [
    'pam_bench',
    'pam_command',
    'pam_control',
    'pam_demo',
    'pam_excite',
    'pam_identify',
    'pam_plot',
    'pam_record',
    'pam_sim',
]


def shared(folder: str, pattern: str = '**/*') -> list[tuple[str, list[str]]]:
    """Return data_files entries that install the files of a folder, keeping its subfolders."""
    entries: dict[str, list[str]] = {}
    for path in sorted(Path(folder).glob(pattern)):
        if path.is_file():
            target = f'share/{PACKAGE}/{path.parent.as_posix()}'
            entries.setdefault(target, []).append(path.as_posix())
    return sorted(entries.items())


setup(
    name=PACKAGE,
    version='0.1.0',
    description='Pneumatic artificial muscles for ROS 2: simulate, control, identify',
    author='The pam_ros authors',
    maintainer='The pam_ros authors',
    maintainer_email='pam_ros@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    package_data={PACKAGE: ['py.typed', '**/*.html', '**/*.j2', '**/*.pyi']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        *shared('launch', '*.launch.py'),
        *shared('config'),
        *shared('urdf'),
    ],
    python_requires='>=3.10',
    # ROS itself (rclpy, messages, launch) is named in package.xml: it is not on PyPI.
    install_requires=[
        'setuptools',
        'numpy>=1.26',
        'scipy>=1.11',
        'PyYAML',
        'matplotlib',
        'jinja2',
        'bokeh>=3.4',
        'mcap>=1.5',
        'rosbags',
        'tqdm',
    ],
    extras_require={
        'cluster': ['distributed'],
        'excel': ['openpyxl'],
        'fast': ['numba'],
        'test': [
            'pytest',
            'pytest-xdist',
            'distributed',
            'hypothesis',
            'ipykernel',
            'jsonschema',
            'nbclient>=0.10',
            'nbformat>=5.5',
            'openpyxl',
            'pandas',
            'sybil>=9',
            'urdf-parser-py',
        ],
    },
    zip_safe=False,
    entry_points={
        'console_scripts': [f'{name} = {PACKAGE}.cli.{name}:main' for name in PROGRAMS],
    },
)
