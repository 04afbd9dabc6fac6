# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Measure which share of small changes of the sources the tests notice: ``make mutation``.

cosmic-ray changes one operator, number, condition or loop at a time in a copy of the checkout:
the result is a *mutant*. The tests of the changed file run on it, then those of its folder. It is
noticed if one fails or if they exceed their time limit. The results are kept in
``build/mutation/``: the same command continues an interrupted run.
"""

import argparse
import ast
import hashlib
import itertools
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import SimpleQueue
from pathlib import Path

from cosmic_ray.commands.init import init
from cosmic_ray.modules import find_modules
from cosmic_ray.mutating import mutate_and_test, mutate_code
from cosmic_ray.plugins import get_operator
from cosmic_ray.testing import run_tests
from cosmic_ray.work_db import WorkDB
from cosmic_ray.work_item import TestOutcome, WorkerOutcome

# One replacement for each arithmetic operator; for comparisons the neighbour and the opposite.
# Others fail wherever they are executed, such as the bits of a float, or change nothing, such as
# 'is' instead of '==' for small integers.
OPERATORS = re.compile(
    'core/(ReplaceBinaryOperator_(Add_Sub|Sub_Add|Mul_Div|Div_Mul|FloorDiv_Mul|Mod_Mul|Pow_Mul'
    '|BitOr_BitAnd|BitAnd_BitOr)'
    '|ReplaceComparisonOperator_(Lt_LtE|LtE_Lt|Gt_GtE|GtE_Gt|Lt_GtE|LtE_Gt|Gt_LtE|GtE_Lt'
    r'|Eq_NotEq|NotEq_Eq|Is_IsNot|IsNot_Is)|ReplaceUnaryOperator_Delete_\w+'
    '|Replace(TrueWithFalse|FalseWithTrue|AndWithOr|OrWithAnd|BreakWithContinue|ContinueWithBreak)'
    '|AddNot|ExceptionReplacer|NumberReplacer|ZeroIterationForLoop)'
)
MARKS = 'pure and not slow and not release'
# The kernels are made of these. The tests of one file run sooner as plain Python than numba
# compiles a mutant; the other tests of kernels, and an independent plant, run compiled.
COMPILED = ('effects', 'muscle', 'rig')
INDEPENDENT = ('rig', 'effects', 'truth')
OWN_LIMIT = 120.0  # s, for the tests of one file
LONGEST = 3600.0  # s, for all tests without a mutant
MEMORY = 8_000_000  # KiB: a mutant may ask for an array of any size


def stop(sentence):
    """End the command: its input is invalid, or tests fail without a mutant."""
    print(f'mutation: {sentence}', file=sys.stderr)
    sys.exit(2)


def files_of(*rooms, names='test_*.py'):
    """Return the test files of some folders, all or those with certain names."""
    return [f'{path}' for room in rooms for path in sorted(room.glob(names))]


def test_command(source, own_limit, limit):
    """Return the shell command that tests a source, first with the tests of its own file."""
    room = Path('test', *source.parts[1:-1])
    files, setting, own_marks = files_of(room), '', MARKS
    if source.parts[1] in COMPILED:
        files += files_of(*(one for r in INDEPENDENT if (one := Path('test', r)) != room))
        setting, own_marks = 'NUMBA_DISABLE_JIT=1 ', f'{MARKS} and not needs_numba'
    # Exit code 5: all tests of these files have marks that are left out. `timeout` also ends
    # the tests of a run that was interrupted.
    steps = [
        f'{{ {setting}timeout -k 5 {limit} {sys.executable} -m pytest -x -q -p no:cacheprovider '
        f'-m "{marks}" {" ".join(files)} || [ $? = 5 ]; }}'
        for setting, limit, marks, files in (
            (setting, own_limit, own_marks, files_of(room, names=f'test_*{source.stem}*.py')),
            ('', limit, MARKS, files),
        )
        if files
    ]
    return 'sh -c ' + shlex.quote(f'ulimit -v {MEMORY}; ' + ' && '.join(steps))


def enter(folders):
    """Work in one of the copies, which has its own cache of compiled code and temporary files."""
    folder = folders.get()
    os.chdir(folder)
    (folder / '.tmp').mkdir()
    os.environ.update(PYTHONPATH=f'{folder}', NUMBA_CACHE_DIR=f'{folder / ".numba"}')
    os.environ.update(TMPDIR=f'{folder / ".tmp"}', CI='true')  # CI: examples are not random


def test_without_mutant(source):
    """Run the tests of a source as it is; return the time in s, and what fails."""
    command = [sys.executable, '-c', 'import pam_ros; print(pam_ros.__file__)']
    imported = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    if not Path(imported).is_relative_to(Path.cwd()):
        return 0.0, f'They import {imported} instead of the copy.'
    began = time.monotonic()
    outcome, output = run_tests(test_command(source, LONGEST, LONGEST), 2 * LONGEST)
    return time.monotonic() - began, '' if outcome is TestOutcome.SURVIVED else output


def meaning(source):
    """Return the program as a text, without what cannot matter or what tests cannot notice.

    These are annotations, the marker of keyword arguments, which cosmic-ray takes for a product,
    and decorators, which mostly state how fast (lru_cache) or strict (frozen) something is.
    """
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.arguments):
            node.args = [*node.posonlyargs, *node.args, *node.kwonlyargs]
            node.defaults = [*node.defaults, *node.kw_defaults]
            node.posonlyargs, node.kwonlyargs, node.kw_defaults = [], [], []
        for name in {'annotation', 'returns', 'decorator_list'}.intersection(node._fields):
            setattr(node, name, [])
    return ast.dump(tree)


def matters(mutation):
    """Return whether a mutant is a program that may behave differently."""
    if not OPERATORS.fullmatch(mutation.operator_name):
        return False
    if mutation.operator_name == 'core/NumberReplacer' and mutation.occurrence % 2:
        return False  # a number has two mutants, one more and one less: they were half of all
    source = mutation.module_path.read_text(encoding='utf-8')
    mutant = mutate_code(source, get_operator(mutation.operator_name)(), mutation.occurrence)
    try:
        return meaning(mutant) != meaning(source)
    except SyntaxError:
        return False


def draw(sources, sample, seed):
    """Return a sample of the mutants of the sources, each of which is as likely as another."""
    every = WorkDB(':memory:', WorkDB.Mode.create)
    init(sources, every, {})
    items = sorted(every.work_items, key=lambda item: str(item.mutations))  # ids are random
    random.Random(seed).shuffle(items)
    kept = (item for item in items if matters(item.mutations[0]))
    return list(itertools.islice(kept, sample))


def run(db, folders):
    """Test the mutants without a result, one at a time in each of the folders."""
    queue = SimpleQueue()
    for folder in folders:
        queue.put(folder)
    pending = {item.job_id: item.mutations[0] for item in db.pending_work_items}
    rooms = {mutation.module_path.parent: mutation.module_path for mutation in pending.values()}
    pool = ProcessPoolExecutor(len(folders), initializer=enter, initargs=(queue,))
    try:
        limit = 0.0
        tested = pool.map(test_without_mutant, rooms.values())
        for room, (seconds, failed) in zip(rooms, tested, strict=True):
            if failed:
                stop(f'the tests of {room} fail without a mutant.\n{failed}')
            # Of the longest: the first room compiles the kernels, as their mutants do again.
            limit = max(limit, 2 * seconds + 60.0)
            print(f'{room}: {seconds:.0f} s without a mutant', flush=True)
        began, jobs = time.monotonic(), {}
        for job_id, mutation in pending.items():
            command = test_command(mutation.module_path, OWN_LIMIT, limit)
            # `timeout` ends the tests; this limit is for what it cannot end.
            longest = OWN_LIMIT + 2 * limit
            jobs[pool.submit(mutate_and_test, [mutation], command, longest)] = job_id
        for number, job in enumerate(as_completed(jobs), 1):
            if job.result().worker_outcome is not WorkerOutcome.NORMAL:
                raise RuntimeError(job.result().output)
            db.set_result(jobs[job], job.result())
            left = (time.monotonic() - began) / number * (len(jobs) - number) / 60
            print(f'{number} of {len(jobs)} tested, {left:.0f} min left', flush=True)
    finally:
        pool.shutdown(cancel_futures=True)


def report(db):
    """Print each mutant that was not noticed as changed lines, and the share of the others."""
    mutations = {item.job_id: item.mutations[0] for item in db.work_items}
    results = [(mutations[job_id], result) for job_id, result in db.results]
    results.sort(key=lambda one: (one[0].module_path, one[0].start_pos, one[0].occurrence))
    for mutation, result in results:
        if not result.is_killed:
            lines = [line for line in result.diff.split('\n')[3:] if line[:1] in ('+', '-')]
            print(f'\n{mutation.module_path}:{mutation.start_pos[0]}', *lines, sep='\n')
    print('\nNoticed by the tests:')
    for folder in [*sorted({f'{one.module_path.parent}' for one, _ in results}), 'all']:
        found = [r.is_killed for m, r in results if folder in ('all', f'{m.module_path.parent}')]
        share = 100 * sum(found) / max(len(found), 1)
        print(f'{folder:<36} {sum(found)} of {len(found)} = {share:.0f} %')
    # pytest names tests that fail; it cannot if it is ended.
    ended = sum(r.is_killed and not re.search('FAILED|ERROR', r.output) for _, r in results)
    print(f'{ended} of these by the time limit or a crash.')
    print(f'{len(mutations) - len(results)} of {len(mutations)} mutants are not yet tested.')


def checkout():
    """Return the names of the files of the checkout, those that are new as well."""
    command = ['git', 'ls-files', '-zco', '--exclude-standard']
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return [name for name in sorted(listed.split('\0')) if name and Path(name).is_file()]


def sources_in(paths):
    """Return the sources that were given by folders and files."""
    root = Path.cwd()
    for path in paths:
        if not Path(path).exists() or root / 'pam_ros' not in (Path(path).resolve() / '_').parents:
            stop(f'{path} is not a file or folder of pam_ros.')
    sources = sorted(set(find_modules(Path(p).resolve().relative_to(root) for p in paths)))
    return sources or stop(f'there is no Python source in {" ".join(paths)}.')


def open_session(sessions, files, *drawn):
    """Return the session of a sample of mutants of these files, with the results so far."""
    digest = hashlib.sha256(repr(drawn).encode())
    for name in files:
        if name.startswith(('pam_ros/', 'test/')):
            digest.update(Path(name).read_bytes())
    sessions.mkdir(parents=True, exist_ok=True)
    db = WorkDB(sessions / f'{digest.hexdigest()[:12]}.sqlite', WorkDB.Mode.create)
    if not db.num_work_items:
        db.add_work_items(draw(*drawn))
    return db


def main():
    """Read the command line; draw, run and report."""
    parser = argparse.ArgumentParser(prog='mutation', description=__doc__.split('\n')[0])
    parser.add_argument('paths', nargs='*', default=['pam_ros'], help='sources, or their folders')
    parser.add_argument('--sample', type=int, default=100, help='number of mutants (100)')
    parser.add_argument('--seed', type=int, default=1, help='of the random sample (1)')
    parser.add_argument('--jobs', type=int, default=1, help='mutants at a time (1)')
    parser.add_argument('--report', action='store_true', help='only print the latest results')
    given = parser.parse_args()
    sessions = Path('build', 'mutation')
    if given.report:
        kept = max(sessions.glob('*.sqlite'), key=lambda path: path.stat().st_mtime, default=None)
        report(WorkDB(kept or stop(f'there are no results in {sessions}.'), WorkDB.Mode.open))
        return
    if min(given.sample, given.jobs) < 1:
        stop('--sample and --jobs must be at least 1.')
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # also ends the processes of a pool
    sources, files = sources_in(given.paths), checkout()
    db = open_session(sessions.absolute(), files, sources, given.sample, given.seed)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary:
        folders = [Path(temporary, f'{number}') for number in range(given.jobs)]
        for folder, name in itertools.product(folders, files):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(name, folder / name)
        try:
            run(db, folders)
        except KeyboardInterrupt:
            print('Interrupted: the same command continues.')
    report(db)


if __name__ == '__main__':
    main()
