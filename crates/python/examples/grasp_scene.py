"""A table with boxes as exact solids, as a depth camera saw it, and grasps to try on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

#: Width and height of the image, and its focal length, pixels.
IMAGE, FOCAL = (320, 240), 285.0


@dataclass(frozen=True)
class Box:
    """A solid box: half sides, m, and the pose of its middle."""

    half: Floats
    pose: Floats

    def mesh(self) -> tuple[Floats, npt.NDArray[np.int64]]:
        """Vertices and triangles, anticlockwise from outside."""
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        return signs * self.half @ self.pose[:3, :3].T + self.pose[:3, 3], np.array(triangles)

    def depth(self, rays: Floats) -> Floats:
        """How far along each ray from the origin the box is, infinite where it is not."""
        turn, middle = self.pose[:3, :3], self.pose[:3, 3]
        with np.errstate(divide="ignore"):
            inverse = 1.0 / (rays @ turn)
        ends = np.stack([(sign * self.half + middle @ turn) * inverse for sign in (-1, 1)])
        near, far = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
        return np.where((near < far) & (near > 0), near, np.inf)


def pose(turn: Floats, place: Floats) -> Floats:
    """A 4 x 4 matrix."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn, place
    return matrix


def scene(random: np.random.Generator, boxes: int = 8) -> list[Box]:
    """A table half a metre before the camera, tilted as one looks down at it, with boxes on it."""
    # Camera: x right, y down, z forward. The table's normal points up and back at it.
    tilt = np.radians(50)
    up, ahead = np.array([0, -np.sin(tilt), -np.cos(tilt)]), np.array([0, -np.cos(tilt), np.sin(tilt)])
    frame = np.stack([[1, 0, 0], ahead, up], axis=1)
    top = np.array([0, 0.05, 0.75])
    solids = [Box(np.array([0.4, 0.3, 0.01]), pose(frame, top - 0.01 * up))]
    # The floor, so that something comes back beside the table too.
    solids.append(Box(np.array([3.0, 3.0, 0.01]), pose(frame, top - 0.7 * up)))
    for _ in range(boxes):
        half = random.uniform([0.015, 0.015, 0.02], [0.05, 0.05, 0.09])
        angle = random.uniform(0, np.pi)
        c, s = np.cos(angle), np.sin(angle)
        turn = frame @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        at = top + frame[:, :2] @ random.uniform([-0.28, -0.2], [0.28, 0.2]) + half[2] * up
        solids.append(Box(half, pose(turn, at)))
    return solids


def mesh(solids: list[Box]) -> tuple[Floats, npt.NDArray[np.int64]]:
    """All of them as one."""
    vertices, triangles = zip(*(solid.mesh() for solid in solids))
    starts = np.cumsum([0, *(len(v) for v in vertices[:-1])])
    return np.concatenate(vertices), np.concatenate([t + start for t, start in zip(triangles, starts)])


def seen(solids: list[Box], random: np.random.Generator) -> Floats:
    """The depth image of a Kinect as points (height, width, 3), m, NaN where nothing came back."""
    width, height = IMAGE
    u, v = np.meshgrid(np.arange(width) - width / 2 + 0.5, np.arange(height) - height / 2 + 0.5)
    rays = np.stack([u / FOCAL, v / FOCAL, np.ones_like(u)], axis=-1).reshape(-1, 3)
    depth = np.min([solid.depth(rays) for solid in solids], axis=0)
    depth[np.isinf(depth)] = np.nan
    # Axial noise of a Kinect at right angles to the surface (Nguyen, Izadi and Lovell 2012).
    depth += random.normal(size=depth.shape) * (0.0012 + 0.0019 * (depth - 0.4) ** 2)
    return (rays * depth[:, None]).reshape(height, width, 3)


def gripper(opening: float = 0.08) -> list[Box]:
    """Palm and two fingers, reaching from the origin 6 cm along z."""
    finger = np.array([0.005, 0.01, 0.03])
    at = opening / 2 + finger[0]
    palm = Box(np.array([at + finger[0], 0.02, 0.02]), pose(np.eye(3), np.array([0, 0, -0.02])))
    return [palm, *(Box(finger, pose(np.eye(3), np.array([side * at, 0, 0.03]))) for side in (-1, 1))]


def grasps(points: Floats, count: int, random: np.random.Generator) -> Floats:
    """Poses (count, 4, 4) of a gripper about measured points: from the side of the camera, rolled at random."""
    at = points[random.integers(len(points), size=count)]
    forward = at / np.linalg.norm(at, axis=1, keepdims=True) + random.normal(scale=0.4, size=(count, 3))
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    side = np.cross(forward, random.normal(size=(count, 3)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = np.stack([side, np.cross(forward, side), forward], axis=2)
    # How far the finger tips are beyond the point.
    poses[:, :3, 3] = at - (0.06 - random.uniform(-0.05, 0.04, size=(count, 1))) * forward
    return poses
