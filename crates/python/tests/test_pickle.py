"""What goes to workers answers there to the bit as it does here."""

import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import lifted, sheet
from same import assert_same_batch, assert_same_report

import cloudtouch as ct

POSES = np.stack([lifted(z) for z in (0.0, 0.005, 0.01, 0.02, 0.05)])


def turned():
    """A pose whose matrix has bits that a quaternion would not keep."""
    c, s = np.cos(0.3), np.sin(0.3)
    pose = np.eye(4)
    pose[:2, :2] = [[c, -s], [s, c]]
    pose[:3, 3] = 0.1, -0.2, -0.7
    return pose


def clouds():
    points = sheet(seed=4)
    noise = np.random.default_rng(1).uniform(1e-6, 4e-6, size=(len(points), 3))
    yield ct.Cloud(points.astype(np.float32), sensor="iso:0.001", outliers=(8, 2.0))
    yield ct.Cloud(points, sensor="per-point", covariances=noise[:, :, None] * np.eye(3), refined=True)
    yield ct.Cloud(points.reshape(20, 20, 3), sensor="kinect", sensor_pose=turned(), max_range=3.0)
    yield ct.Cloud(points, sensor="exact", normals=np.tile([0.0, 0.0, 2.0], (len(points), 1)))
    yield ct.Cloud(points, sensor="exact", collision_map=0.02)
    yield ct.Cloud(np.vstack([points, np.full((9, 3), np.nan)]), sensor="iso:0.001")


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_bodies_and_queries_pickle(protocol, plate, table):
    query = ct.Query(prior=0.1, max_unseen=1.0, deadline=30.0)
    for body in [*clouds(), table]:
        again, query_again = pickle.loads(pickle.dumps((body, query), protocol))
        assert repr(again) == repr(body) and query_again == query and hash(query_again) == hash(query)
        for pose in POSES:
            assert_same_report(query_again.run(again, plate, pose), query.run(body, plate, pose))


def test_answers_pickle(floor, plate):
    report, near = ct.Query().within(floor, plate, lifted(0.004), 0.01)
    batch = ct.Query().run_batch(floor, plate, POSES)
    report_again, near_again, batch_again = pickle.loads(pickle.dumps((report, near, batch)))
    assert_same_report(report_again, report)
    assert_same_batch(batch_again, batch)
    assert near_again == near and report_again.seconds == report.seconds


def test_errors_pickle():
    with pytest.raises(ct.CloudtouchError) as error:
        ct.Query(prior=2.0)
    again = pickle.loads(pickle.dumps(error.value))
    assert type(again) is ct.CloudtouchError and again.args == error.value.args


def ask(job):
    query, a, b, poses = job
    return query.run_batch(a, b, poses)


def aslant(angle):
    """The pose that turns the second body through the first."""
    pose = lifted(-0.1 * np.sin(angle))
    pose[1:3, 1:3] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return pose


def first_of_a_scene(job):
    query, bodies = job
    scene = ct.Scene()
    for k, body in enumerate(bodies):
        scene.add(f"body {k}", body, aslant(0.7 * k))
    return scene.check_first(query).verdict


@pytest.mark.parametrize("start", multiprocessing.get_all_start_methods())
def test_a_scene_is_checked_in_a_worker(start, floor, plate):
    """It waited for ever there."""
    job = (ct.Query(), [floor, plate, plate])
    here = first_of_a_scene(job)
    with multiprocessing.get_context(start).Pool(1) as pool:
        assert pool.map_async(first_of_a_scene, [job]).get(timeout=120) == [here]


def first_query(job):
    query, cloud, body = job
    return query.run(cloud, body, lifted(0.01)).probability


@pytest.mark.parametrize("start", multiprocessing.get_all_start_methods())
def test_a_blurred_cloud_is_first_asked_in_a_worker(start, plate):
    """What it computes on all threads there would wait for those of its parent."""
    points = sheet(seed=6)
    blurred = ct.Cloud(np.concatenate([points + 0.0001 * k for k in range(40)]), sensor="iso:0.02")
    job = (ct.Query(), blurred, plate)
    with multiprocessing.get_context(start).Pool(1) as pool:
        assert pool.map_async(first_query, [job]).get(timeout=120) == [first_query(job)]


@pytest.mark.parametrize("start", multiprocessing.get_all_start_methods())
def test_workers_answer_as_their_parent_does(start, floor, plate):
    """A forked worker waited for ever for threads that only its parent has."""
    query = ct.Query()
    here = query.run_batch(floor, plate, POSES)
    with multiprocessing.get_context(start).Pool(2) as pool:
        there = pool.map_async(ask, [(query, floor, plate, POSES)] * 3).get(timeout=120)
    for batch in there:
        assert_same_batch(batch, here)
