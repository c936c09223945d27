"""Python threads: the same bits, and at the same time."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from conftest import lifted, sheet
from same import assert_same_batch, assert_same_report

import cloudtouch as ct


def test_many_threads_ask_about_fresh_bodies():
    """What a query computes for the first time, two threads may want at once."""
    query = ct.Query()
    poses = [lifted(z) for z in np.linspace(0.0, 0.05, 24)]

    def bodies():
        return [ct.Cloud(sheet(seed=seed), sensor="iso:0.001") for seed in (1, 2)]

    alone = [query.run(*bodies(), pose) for pose in poses]
    shared = bodies()
    with ThreadPoolExecutor(8) as threads:
        for one, other in zip(alone, threads.map(lambda pose: query.run(*shared, pose), poses)):
            assert_same_report(one, other)
        whole = query.run_batch(*shared, poses)
        for batch in threads.map(lambda _: query.run_batch(*shared, poses), range(8)):
            assert_same_batch(batch, whole)


def test_other_threads_run_while_a_batch_does(floor, plate):
    """The counter would stand still if the batch held the interpreter."""
    poses = np.stack([lifted(z) for z in np.linspace(-0.02, 0.05, 400)])
    done, counted = threading.Event(), []

    def count():
        while not done.is_set():
            counted.append(None)
            done.wait(1e-4)

    counter = threading.Thread(target=count)
    counter.start()
    before = len(counted)
    ct.Query().run_batch(floor, plate, poses)
    during = len(counted) - before
    done.set()
    counter.join()
    assert during > 3, during
