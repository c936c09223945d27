"""What Python costs: ``python bench.py`` prints the overhead of a call and of a pose, and what two threads gain.

Rust's own time of a query is what a report says (`seconds`); the rest of a call is overhead. A pose in a batch is
compared with the sum of Rust's own times on one thread (`RAYON_NUM_THREADS=1`, which this script sets for itself).
"""

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import cloudtouch as ct
from cloudtouch.demo import box, table_top


def bodies(spacing=0.005):
    points = box((0.12, 0.08, 0.10), spacing)
    points += np.random.default_rng(2011).normal(scale=0.002, size=points.shape)
    return ct.Mesh(*table_top()), ct.Cloud(points, sensor="iso:0.002", refined=True)


def poses(count, low, high):
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, 2, 3] = 0.05 + np.random.default_rng(1).uniform(low, high, size=count)
    return poses


def median_of(measure, times=7):
    return float(np.median([measure() for _ in range(times)]))


def of_calls(query, a, b, poses):
    """Seconds of a call beyond Rust's own, which are told in whole microseconds, rounded down."""
    start = time.perf_counter()
    inside = sum(query.run(a, b, pose).seconds for pose in poses)
    return (time.perf_counter() - start - inside) / len(poses) - 0.5e-6


def of_batch(query, a, b, poses):
    start = time.perf_counter()
    query.run_batch(a, b, poses)
    return (time.perf_counter() - start) / len(poses)


def single_thread():
    a, b = bodies()
    query = ct.Query()
    for name, low, high in [("far (10 to 30 cm)", 0.1, 0.3), ("near (-1 to 3 cm)", -0.01, 0.03)]:
        few, many = poses(2000, low, high), poses(8000, low, high)
        # Once, for what is computed on the way.
        query.run_batch(a, b, few)
        alone = np.mean([query.run(a, b, pose).seconds for pose in many]) + 0.5e-6
        call = median_of(lambda: of_calls(query, a, b, few))
        pose = median_of(lambda: of_batch(query, a, b, many))
        print(f"{name}: Rust {1e6 * alone:.2f} us a query; a call costs {1e6 * call:.2f} us more,")
        print(f"    a pose of a batch on one thread takes {1e6 * pose:.2f} us: {1e6 * (pose - alone):+.2f} us")


def two_threads():
    a, b = bodies()
    query = ct.Query()
    half = poses(3000, -0.01, 0.03)
    [query.run(a, b, pose) for pose in half]

    def work(_):
        for pose in half:
            query.run(a, b, pose)

    def timed(threads, jobs):
        with ThreadPoolExecutor(threads) as pool:
            start = time.perf_counter()
            list(pool.map(work, range(jobs)))
            return time.perf_counter() - start

    gains = [timed(1, 2) / timed(2, 2) for _ in range(5)]
    print(f"two Python threads: {np.median(gains):.2f} x one (five runs: {', '.join(f'{g:.2f}' for g in gains)})")


if __name__ == "__main__":
    if "--inside" in sys.argv:
        single_thread()
    else:
        environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
        subprocess.run([sys.executable, __file__, "--inside"], env=environment, check=True)
        two_threads()
