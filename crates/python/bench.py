"""What Python costs: ``python bench.py`` prints what a call and a pose of a batch cost, and what two threads gain.

Rust's own time of a query is what a report or a batch says (`seconds`); the rest is what Python costs. Others who use the
machine add to both. Two threads are compared with two processes, which share no interpreter: what these gain is what the
machine has to give.
"""

import multiprocessing
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np

import cloudtouch as ct
from cloudtouch.demo import box, table_top

#: Seconds are told in whole microseconds, rounded down: what is missing on average.
ROUNDED = 0.5e-6


def bodies():
    points = box((0.12, 0.08, 0.10))
    points += np.random.default_rng(2011).normal(scale=0.002, size=points.shape)
    return ct.Mesh(*table_top()), ct.Cloud(points, sensor="iso:0.002", refined=True)


def poses(count, low, high):
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, 2, 3] = 0.05 + np.random.default_rng(1).uniform(low, high, size=count)
    return poses


def call(query, a, b, pose):
    """What a call takes, and what Rust takes of it, s."""
    start = time.perf_counter()
    inside = query.run(a, b, pose).seconds
    return time.perf_counter() - start, inside + ROUNDED


def batch(query, a, b, poses):
    """The same for a pose of a batch."""
    start = time.perf_counter()
    inside = query.run_batch(a, b, poses).seconds
    return (time.perf_counter() - start) / len(poses), inside.mean() + ROUNDED


def costs():
    """On one thread, for times of queries to add up to the time of a batch."""
    a, b = bodies()
    query = ct.Query()
    for name, low, high, count in [("10 to 30 cm off", 0.1, 0.3, 20_000), ("-1 to 3 cm off", -0.01, 0.03, 3_000)]:
        many = poses(count, low, high)
        query.run_batch(a, b, many)
        calls = np.array([call(query, a, b, pose) for pose in many[:2000]])
        batches = np.array([batch(query, a, b, many) for _ in range(9)])
        beside, beside_batch = np.median(calls[:, 0] - calls[:, 1]), np.median(batches[:, 0] - batches[:, 1])
        print(
            f"{name}: a query takes {1e6 * np.median(calls[:, 1]):.1f} us in Rust, a call {1e6 * beside:.1f} us more, "
            f"a pose of a batch {1e6 * beside_batch:.2f} us more"
        )


JOB = {}


def prepare():
    a, b = bodies()
    JOB.update(query=ct.Query(), a=a, b=b, poses=poses(60, -0.01, 0.03))
    work(0)


def work(_):
    for pose in JOB["poses"]:
        JOB["query"].run(JOB["a"], JOB["b"], pose)


def gains(rounds=80):
    """The best of several rounds each, in turns: others who use the machine only ever add."""
    prepare()
    spawn = multiprocessing.get_context("spawn")
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(2) as two, ProcessPoolExecutor(2, spawn, prepare) as apart:
        ways = {"one": one, "two threads": two, "two processes": apart}
        best = dict.fromkeys(ways, float("inf"))
        for _ in range(rounds + 1):
            for way, workers in ways.items():
                start = time.perf_counter()
                list(workers.map(work, range(2)))
                best[way] = min(best[way], time.perf_counter() - start)
    for way in ("two threads", "two processes"):
        print(f"{way}: {best['one'] / best[way]:.2f} x one thread")


if __name__ == "__main__":
    if "--costs" in sys.argv:
        costs()
    else:
        environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
        subprocess.run([sys.executable, __file__, "--costs"], env=environment, check=True)
        gains()
