"""A box seen by a noisy sensor, let down onto a table: ``python -m cloudtouch.demo``."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import cloudtouch as ct

#: Noise of the sensor, m.
STD = 0.002
#: Distance of neighbouring points, m.
SPACING = 0.005


def box(size: tuple[float, float, float], spacing: float = SPACING) -> npt.NDArray[np.float64]:
    """Points on the six sides of a box about the origin, (N, 3), m."""
    sides: list[npt.NDArray[np.float64]] = []
    for axis in range(3):
        u, v = (np.arange(-size[a] / 2, size[a] / 2 + spacing / 2, spacing) for a in range(3) if a != axis)
        grid = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
        sides.extend(np.insert(grid, axis, end * size[axis] / 2, axis=1) for end in (-1, 1))
    return np.concatenate(sides)


def table_top() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Vertices and triangles of a slab of 60 x 40 x 3 cm whose upper side is at z = 0, m."""
    corners = np.array([[x, y, z] for x in (-0.3, 0.3) for y in (-0.2, 0.2) for z in (-0.03, 0.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles)


def main() -> None:
    """Prints what is asked and what is answered."""
    exact = box((0.12, 0.08, 0.10))
    points = exact + np.random.default_rng(2011).normal(scale=STD, size=exact.shape)
    vertices, triangles = table_top()
    table, seen = ct.Mesh(vertices, triangles), ct.Cloud(points, sensor=f"iso:{STD}", refined=True)
    print(f"A: {table}\nB: {seen}\n")

    heights = np.array([0.10, 0.03, 0.01, 0.006, 0.004, 0.002, 0.0, -0.004, -0.01, -0.03])
    poses = np.tile(np.eye(4), (len(heights), 1, 1))
    poses[:, 2, 3] = heights + 0.05
    batch = ct.Query().run_batch(table, seen, poses)
    print("true gap (mm)      P   verdict         clearance (mm)")
    for height, p, verdict, gap, std, is_bound in zip(
        heights, batch.probability, batch.verdict, batch.clearance, batch.clearance_std, batch.clearance_is_bound
    ):
        clearance = "-" if np.isnan(gap) else f"{'<= ' if is_bound else ''}{1e3 * gap:+.1f} +- {1e3 * std:.1f}"
        print(f"{1e3 * height:+13.0f}  {p:.3f}   {verdict:<12}  {clearance:>16}")

    report, near = ct.Query().within(table, seen, poses[1], margin=0.04)
    print(f"\nAt +30 mm: {report}")
    print(f"Within {near.margin} m of the table: P = {near.probability:.3f}")


if __name__ == "__main__":
    main()
