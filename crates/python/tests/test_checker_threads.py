"""Threads that call one checker, as those of Dask do."""

import random
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from test_checker import assert_same, root, table, taken, whole

import cloudtouch as ct

#: Fixtures of another file.
__all__ = ["root", "whole"]


@pytest.fixture
def in_turn():
    """Threads give way to one another as often as they can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def test_a_thread_dropped_what_another_was_about_to_use(root, in_turn):
    """It ended with a KeyError, and so did the whole table."""
    scenes = ct.PoseChecker(root, sensor="iso:0.001", keep=2)._scenes

    def ask(seed):
        draw = random.Random(seed)
        names = [draw.randrange(6) for _ in range(6000)]
        return [name == scenes.get(name, lambda name=name: time.sleep(0) or name) for name in names]

    with ThreadPoolExecutor(8) as threads:
        assert all(all(told) for told in threads.map(ask, range(8)))


def test_a_body_was_prepared_once_for_every_thread_that_asked(root, whole, monkeypatch):
    checker, rows, seen = ct.PoseChecker(root, sensor="iso:0.001"), table(), []
    read, together = checker._read, threading.Barrier(6)

    def slow(name, *, is_scene):
        seen.append(name)
        time.sleep(0.3)
        return read(name, is_scene=is_scene)

    def ask(_):
        together.wait(60)
        return checker(rows)

    monkeypatch.setattr(checker, "_read", slow)
    with ThreadPoolExecutor(6) as threads:
        for told in threads.map(ask, range(6)):
            assert_same(told, whole)
    assert sorted(seen) == sorted(set(seen)), seen


def test_tables_of_many_threads_have_the_bits_of_one(root, whole):
    checker, rows = ct.PoseChecker(root, sensor="iso:0.001", keep=1), table()
    orders = [np.random.default_rng(seed).permutation(20)[:7] for seed in range(24)]
    with ThreadPoolExecutor(6) as threads:
        for places, told in zip(orders, threads.map(lambda places: checker(taken(rows, places)), orders)):
            assert_same(told, taken(whole, places))


def test_a_body_that_cannot_be_read_is_tried_again_and_costs_no_other_its_place(root, monkeypatch):
    checker, rows = ct.PoseChecker(root, sensor="iso:0.001", keep=1), taken(table(), [0, 1])
    read, seen = checker._read, []
    monkeypatch.setattr(checker, "_read", lambda name, *, is_scene: seen.append(name) or read(name, is_scene=is_scene))
    gone = {**rows, "scene": np.array(["floor1.xyz", "gone.xyz"])}
    for _ in range(2):
        assert checker(gone)["verdict"].tolist()[1] == "error"
    assert seen.count("gone.xyz") == 2 and seen.count("floor1.xyz") == 1
