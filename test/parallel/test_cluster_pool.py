# Copyright 2026 The pam_ros authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks on a Dask cluster of real processes, of which some are killed in the middle."""

import gc
import warnings
from contextlib import closing

import pytest

from pam_ros.errors import PamError
from pam_ros.parallel import cluster as cluster_module
from pam_ros.parallel.cluster import ClusterPool
from pam_ros.parallel.tasks import run_tasks
from support.dask_cluster import DaskCluster, kill
from support.tasks import (
    Task,
    all_replies,
    expected,
    noted,
    refuse,
    wait_until,
    work,
)

pytest.importorskip('distributed', reason='without Dask there is no cluster')


@pytest.fixture(autouse=True)
def sockets_that_dask_leaves_open():
    """Collect them here, where the warning on each is ignored: a client leaves lost ones open."""
    yield
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', ResourceWarning)
        gc.collect()


@pytest.fixture
def dask(tmp_path):
    folder = tmp_path / 'dask'
    folder.mkdir()
    with DaskCluster(folder) as made:
        made.start_scheduler()
        yield made


def test_each_task_has_a_result_or_a_reason_and_the_same_as_anywhere(tmp_path, dask):
    for _ in range(2):
        dask.start_worker()
    kinds = ('good', 'raises', 'kills once', 'kills', 'refuses', 'good', 'good')
    tasks = [Task(tmp_path, number, kind) for number, kind in enumerate(kinds)]
    pool = ClusterPool(dask.address)
    assert all_replies(pool, tasks) == expected(tasks)
    assert noted(tmp_path, 'begun') == {0: 1, 1: 1, 2: 2, 3: 3, 4: 1, 5: 1, 6: 1}
    with pytest.raises(PamError, match='no domain is free'):
        all_replies(pool, [Task(tmp_path, 7)], refuse)


def test_a_worker_that_is_killed_loses_nothing(tmp_path, dask):
    first = dask.start_worker()
    tasks = [Task(tmp_path, number, seconds=0.5 * (number > 0)) for number in range(5)]
    running = run_tasks(work, tasks, ClusterPool(dask.address))
    found = dict([next(running)])
    wait_until(lambda: len(noted(tmp_path, 'begun')) > len(noted(tmp_path, 'ended')))
    kill(first)
    dask.start_worker()
    for number, result in running:
        assert number not in found
        found[number] = result
    assert [found[number] for number in range(5)] == expected(tasks)
    # The process of the task does not go on by itself.
    interrupted = noted(tmp_path, 'interrupted')
    assert interrupted.total() == 1
    (again,) = interrupted
    assert noted(tmp_path, 'begun') == {number: 1 + (number == again) for number in range(5)}


def test_a_scheduler_that_is_restarted_loses_nothing(tmp_path, dask, capfd):
    worker = dask.start_worker()
    tasks = [Task(tmp_path, number, seconds=0.2 * (number > 0)) for number in range(4)]
    running = run_tasks(work, tasks, ClusterPool(dask.address))
    found = dict([next(running)])
    kill(dask.scheduler)
    kill(worker)
    dask.start_scheduler()
    dask.start_worker()
    for number, result in running:
        assert number not in found
        found[number] = result
    assert [found[number] for number in range(4)] == expected(tasks)
    assert noted(tmp_path, 'ended') == {0: 1, 1: 1, 2: 1, 3: 1}
    assert f'{dask.address} does not answer: waits up to 300 s' in capfd.readouterr().err


def test_the_end_of_the_iterator_interrupts_what_runs(tmp_path, dask):
    dask.start_worker()
    tasks = [Task(tmp_path, 0), *(Task(tmp_path, k, seconds=600.0) for k in (1, 2))]
    with closing(run_tasks(work, tasks, ClusterPool(dask.address))) as running:
        next(running)
        wait_until(lambda: len(noted(tmp_path, 'begun')) == 2)
    wait_until(lambda: noted(tmp_path, 'interrupted').total() == 1)
    assert len(noted(tmp_path, 'begun')) == 2


def test_workers_must_have_the_same_version(tmp_path, dask, monkeypatch):
    dask.start_worker()
    monkeypatch.setattr(cluster_module, 'digest_of_sources', lambda: '123456789abc')
    with pytest.raises(PamError, match=r'another version of pam_ros .* 123456789abc'):
        all_replies(ClusterPool(dask.address), [Task(tmp_path, 0)])


def test_the_package_must_be_on_all_machines(tmp_path, dask, monkeypatch):
    dask.start_worker()
    monkeypatch.setattr(cluster_module, 'PACKAGE', 'absent')
    with pytest.raises(PamError, match=f'the scheduler of {dask.address} lacks absent'):
        all_replies(ClusterPool(dask.address), [Task(tmp_path, 0)])


def test_without_workers_the_program_waits_and_says_so(tmp_path, dask, monkeypatch, capfd):
    monkeypatch.setattr(cluster_module, 'IDLE', 1)
    said = []

    def say(sentence):
        said.append(sentence)
        dask.start_worker()

    monkeypatch.setattr(cluster_module, '_say', say)
    tasks = [Task(tmp_path, 0)]
    assert all_replies(ClusterPool(dask.address), tasks) == expected(tasks)
    assert said == [f'waits for workers of {dask.address}: dask worker starts one']


@pytest.mark.parametrize(
    ('address', 'sentence'),
    [
        ('tcp://127.0.0.1:9', 'no scheduler of Dask answers at tcp://127.0.0.1:9 within 1 s'),
        ('smoke://here', 'smoke://here is not an address of a scheduler of Dask'),
    ],
)
def test_an_address_without_a_scheduler_is_a_sentence(tmp_path, monkeypatch, address, sentence):
    monkeypatch.setattr(cluster_module, 'CONNECT', 1.0)
    with pytest.raises(PamError, match=sentence):
        all_replies(ClusterPool(address), [Task(tmp_path, 0)])
