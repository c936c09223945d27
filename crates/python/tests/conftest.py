"""Bodies that several tests ask about."""

import numpy as np
import pytest
from cloudtouch.demo import box, table_top

import cloudtouch as ct


def sheet(z=0.0, count=20, seed=0):
    """A square of points 1 cm apart, (N, 3), m, each 1 mm off."""
    axis = 0.01 * np.arange(count)
    x, y = np.meshgrid(axis, axis)
    points = np.stack([x.ravel(), y.ravel(), np.full(count * count, z)], axis=1)
    return points + np.random.default_rng(seed).normal(scale=0.001, size=points.shape)


def lifted(height):
    """The pose that lifts the second body, m."""
    pose = np.eye(4)
    pose[2, 3] = height
    return pose


@pytest.fixture(scope="session")
def floor():
    return ct.Cloud(sheet(seed=1), sensor="iso:0.001")


@pytest.fixture(scope="session")
def plate():
    return ct.Cloud(sheet(seed=2), sensor="iso:0.001")


@pytest.fixture(scope="session")
def table():
    return ct.Mesh(*table_top())


@pytest.fixture(scope="session")
def parcel():
    points = box((0.12, 0.08, 0.10))
    return ct.Cloud(points + np.random.default_rng(7).normal(scale=0.002, size=points.shape), sensor="iso:0.002")
