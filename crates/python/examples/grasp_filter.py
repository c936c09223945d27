"""Which of many grasps of a scan are free? Beside what is usually done, and the truth where it is known.

python grasp_filter.py [--grasps 100000] [--seed 1] [--svg FILE]: on a generated scene whose solids are known.
python grasp_filter.py --scan FILE --sensor SPEC [--svg FILE]: on a depth image of yours, without truth.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Callable

import numpy as np
import numpy.typing as npt
from grasp_picture import draw
from grasp_scene import Box, Floats, grasps, gripper, mesh, scene, seen

import cloudtouch as ct

#: Edge of the cells that a scan is thinned to before points are counted, as graspnet does, m.
CELL = 0.003
#: Grasps are about points no farther from the camera, m.
REACH = 1.1


def distances(points: Floats, solids: list[Box], poses: Floats) -> tuple[Floats, Floats]:
    """For each pose the least signed distance of a point to the gripper, m, and how many are inside of it."""
    least, inside = np.empty(len(poses)), np.empty(len(poses))
    single = points.astype(np.float32)
    reach = max(np.linalg.norm(solid.mesh()[0], axis=1).max() for solid in solids) + 0.05
    for k, pose in enumerate(poses.astype(np.float32)):
        local = single - pose[:3, 3]
        local = local[(local * local).sum(axis=1) < reach * reach] @ pose[:3, :3]
        gap = np.full(len(local), np.inf, dtype=np.float32)
        for solid in solids:
            out = np.abs(local - solid.pose[:3, 3].astype(np.float32)) - solid.half.astype(np.float32)
            outside = np.sqrt((np.maximum(out, 0) ** 2).sum(axis=1))
            gap = np.minimum(gap, outside + np.minimum(out.max(axis=1), 0))
        least[k] = gap.min() if len(gap) else reach
        inside[k] = (gap < 0).sum()
    return least, inside


def thinned(points: Floats) -> Floats:
    """One point a cell."""
    _, kept = np.unique(np.floor(points / CELL).astype(np.int64), axis=0, return_index=True)
    return points[np.sort(kept)]


def auc(scores: Floats, collides: npt.NDArray[np.bool_]) -> float:
    """How often a grasp that collides has the larger score."""
    ranks = np.empty(len(scores))
    values, inverse, counts = np.unique(scores, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[inverse]
    positive = collides.sum()
    above = ranks[collides].sum() - positive * (positive + 1) / 2
    return float(above / (positive * (len(scores) - positive)))


def at_miss_rate(scores: Floats, collides: npt.NDArray[np.bool_], rate: float) -> float:
    """The share of free grasps kept where only so many of those that collide are."""
    limit = np.quantile(scores[collides], rate)
    return float((scores[~collides] < limit).mean())


def main() -> None:
    """Prints a table, and draws one."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--grasps", type=int, default=100_000)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--scan")
    options.add_argument("--sensor", default="kinect")
    options.add_argument("--svg")
    given = options.parse_args()
    if given.grasps < 1:
        options.error(f"--grasps {given.grasps}: try at least one")
    if given.svg and not Path(given.svg).parent.is_dir():
        options.error(f"--svg {given.svg}: there is no such folder: make it first")
    random = np.random.default_rng(given.seed)

    solids = None if given.scan else scene(random)
    try:
        if solids is None:
            scan = ct.Cloud.read(given.scan, sensor=given.sensor, refined=True)
        else:
            scan = ct.Cloud(seen(solids, random), sensor=given.sensor, refined=True)
    except ct.CloudtouchError as error:
        options.error(str(error))
    hand = ct.Mesh(*mesh(gripper()))
    # Of an image alone it is known what it did not see.
    if ct.Query().run(scan, hand, np.eye(4)).unseen is None:
        options.error(
            f"{given.scan} is no depth image: give one with rows and columns, in the frame of its camera, as its driver "
            "publishes it"
        )
    range_of = np.linalg.norm(scan.points, axis=1)
    if not (range_of < REACH).any():
        options.error(
            f"{given.scan} has no point nearer to its camera than {REACH} m, which grasps are about: is it in metres?"
        )
    poses = grasps(scan.points[range_of < REACH], given.grasps, random)
    # All that a gripper there can meet.
    near = scan.points[range_of < REACH + 0.25]
    print(f"scan    {scan}, ready in {scan.prepare_seconds:.2f} s\ngripper {hand}\n")

    start = time.perf_counter()
    batch = ct.Query(reject=0.1).run_batch(scan, hand, poses)
    ours = time.perf_counter() - start
    start = time.perf_counter()
    least, inside = distances(thinned(near), gripper(), poses)
    usual = time.perf_counter() - start

    names, counts = np.unique(batch.verdict, return_counts=True)
    print(", ".join(f"{count} {name}" for name, count in zip(names, counts)))
    rate = f"{len(poses) / ours:.0f} poses/s"
    if solids is None:
        print(f"free by cloudtouch {np.mean(batch.verdict == 'free'):.3f}, without a point inside {np.mean(inside == 0):.3f}; {rate}")
    else:
        exact = ct.Query(doubt_units=False).run_batch(ct.Mesh(*mesh(solids)), hand, poses)
        report(batch, {"points inside (3 mm cells)": inside, "least distance of a point": -least}, exact, (rate, usual))
    if given.svg:
        draw(given.svg, near, poses, batch)
        print(f"picture: {given.svg}")


def report(batch: ct.Batch, others: dict[str, Floats], exact: ct.Batch, times: tuple[str, float]) -> None:
    """A row for each way of telling."""
    collides = exact.probability > 0.5
    rate, usual = times
    print(f"{collides.mean():.3f} of the grasps collide with the exact solids\n")
    kept: dict[str, Callable[[], npt.NDArray[np.bool_]]] = {
        "cloudtouch, verdict free": lambda: batch.verdict == "free",
        "no point inside": lambda: others["points inside (3 mm cells)"] == 0,
        "at most 10 points inside": lambda: others["points inside (3 mm cells)"] <= 10,
        "no point within 5 mm": lambda: others["least distance of a point"] < -0.005,
    }
    print("| kept by | kept | of these collide | of the free ones kept |\n| --- | --- | --- | --- |")
    for name, keep in kept.items():
        chosen = keep()
        print(f"| {name} | {chosen.mean():.3f} | {collides[chosen].mean():.4f} | {(~collides & chosen).sum() / (~collides).sum():.3f} |")
    print("\n| ranked by | AUC | free ones kept at a miss rate of 1 % | at 0.1 % |\n| --- | --- | --- | --- |")
    # P says nothing of what nobody saw: what is undecided may count as in collision.
    doubtful = np.where(batch.verdict == "undecided", 1.0, batch.probability)
    for name, scores in {"P": batch.probability, "P, 1 where undecided": doubtful, **others}.items():
        shares = " | ".join(f"{at_miss_rate(scores, collides, miss):.3f}" for miss in (0.01, 0.001))
        print(f"| {name} | {auc(scores, collides):.4f} | {shares} |")
    print(f"\ncloudtouch {rate} on all cores, one way of the two others in numpy {usual:.0f} s for all")


if __name__ == "__main__":
    main()
