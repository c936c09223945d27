"""Labels a table of poses on all machines of a Ray cluster.

python label_with_ray.py POSES SCANS ANSWERS: Parquet with the columns scene, object and pose in, the same with the
answers beside them out. Needs ``pip install "ray[data]"``.
"""

from __future__ import annotations

import sys

import ray

import cloudtouch as ct


def label(poses: str, scans: str, answers: str, *, sensor: str = "kinect", workers: int = 64) -> None:
    """Rows in the order of their scenes are prepared once a worker; an error is a row, never a lost partition."""
    table = ray.data.read_parquet(poses)
    table.map_batches(
        ct.PoseChecker,
        fn_constructor_args=(scans,),
        fn_constructor_kwargs={"sensor": sensor},
        batch_size=4096,
        # A worker takes one core: it is the workers that are many.
        num_cpus=1,
        runtime_env={"env_vars": {"RAYON_NUM_THREADS": "1"}},
        compute=ray.data.ActorPoolStrategy(min_size=1, max_size=workers),
    ).write_parquet(answers)


if __name__ == "__main__":
    label(*sys.argv[1:4])
