"""Answers: batches, margins, settings, words."""

import numpy as np
import pytest
from conftest import lifted
from same import assert_same_batch

import cloudtouch as ct

HEIGHTS = np.linspace(-0.02, 0.06, 41)


@pytest.mark.parametrize("bodies", [("floor", "plate"), ("table", "parcel")])
def test_a_batch_says_what_single_queries_say(bodies, request):
    a, b = (request.getfixturevalue(name) for name in bodies)
    query = ct.Query()
    poses = np.stack([lifted(z) for z in HEIGHTS])
    batch = query.run_batch(a, b, poses)
    assert len(batch) == len(poses) and len(set(batch.verdict)) > 1
    for row, pose in enumerate(poses):
        report = query.run(a, b, pose)
        for name in ("probability", "lower", "upper", "verdict", "clearance_is_bound"):
            assert getattr(batch, name)[row] == getattr(report, name), name
        for name in ("log_likelihood_ratio", "clearance", "clearance_std", "clearance_at_least"):
            told = getattr(report, name)
            np.testing.assert_array_equal(getattr(batch, name)[row], np.nan if told is None else told)
        assert batch.undecided_by[row] == (report.undecided_by or "")
        assert batch.contact_count[row] == len(report.contacts)
        assert batch.warning_count[row] == len(report.warnings)
        first = report.contacts[0] if report.contacts else None
        nowhere = np.full(3, np.nan)
        np.testing.assert_array_equal(batch.contact_point[row], nowhere if first is None else first.point)
        np.testing.assert_array_equal(batch.contact_normal[row], nowhere if first is None else first.normal)


@pytest.mark.parametrize("bodies", [("floor", "plate"), ("table", "parcel")])
def test_poses_that_are_free_are_those_of_a_batch(bodies, request):
    a, b = (request.getfixturevalue(name) for name in bodies)
    poses = np.stack([lifted(z) for z in np.tile(HEIGHTS, 30)])
    free = ct.Query().are_free(a, b, poses)
    assert free.dtype == np.bool_
    np.testing.assert_array_equal(free, ct.Query().run_batch(a, b, poses).verdict == "free")
    assert 0 < free.sum() < len(poses)
    assert len(ct.Query().are_free(a, b, np.empty((0, 4, 4)))) == 0
    poses[1050, 2, 3] = 1e11
    with pytest.raises(ct.CloudtouchError, match=r"^poses\[1050\]: "):
        ct.Query().are_free(a, b, poses)


def test_more_poses_than_are_asked_about_at_once(floor, plate):
    heights = np.tile(np.linspace(0.006, 0.3, 110), 10)
    poses = np.stack([lifted(z) for z in heights])
    batch = ct.Query().run_batch(floor, plate, poses)
    few = ct.Query().run_batch(floor, plate, poses[:110])
    np.testing.assert_array_equal(batch.clearance_at_least.reshape(10, -1), np.tile(few.clearance_at_least, (10, 1)))
    poses[1050, 2, 3] = 1e11
    with pytest.raises(ct.CloudtouchError, match=r"^poses\[1050\]: "):
        ct.Query().run_batch(floor, plate, poses)


def test_a_margin_is_monotone_and_begins_with_the_collision(table, parcel):
    query = ct.Query()
    for height in (0.0, 0.02, 0.07):
        pose = lifted(0.05 + height)
        known = query.run(table, parcel, pose).probability
        margins = [0.0, 0.003, 0.01, 0.03, 0.1, 1.0]
        near = [query.within(table, parcel, pose, margin)[1] for margin in margins]
        assert near[0].probability == known
        assert all(a.probability <= b.probability for a, b in zip(near, near[1:]))
        assert all(w.lower <= w.probability <= w.upper for w in near)
        assert [w.margin for w in near] == margins
    assert near[-1].probability > 0.99 > 0.01 > known
    for margin in (-0.1, np.nan, np.inf):
        with pytest.raises(ct.CloudtouchError, match="the margin is"):
            query.within(table, parcel, np.eye(4), margin)


def test_contacts_and_points_are_in_the_frame_of_a(table, parcel):
    pose = lifted(0.045)
    report = ct.Query().run(table, parcel, pose)
    assert report.verdict == "in_collision" and report.contacts
    for contact in report.contacts:
        assert np.linalg.norm(contact.normal) == pytest.approx(1.0, abs=1e-9)
        assert 0 < contact.probability <= report.probability and abs(contact.point[2]) < 0.02
    indices, probabilities = report.points_b
    assert len(report.points_a.indices) == 0 < len(indices)
    assert (parcel.points[indices] + pose[:3, 3])[probabilities.argmax(), 2] < 0.02


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"accept": 0.2, "reject": 0.8}, "thresholds accept = 0.2, reject = 0.8"),
        ({"prior": 0.0}, "prior"),
        ({"prior": float("nan")}, "prior"),
        ({"max_unseen": 1.5}, "max_unseen"),
        ({"stop_above": 0.0}, "stop_above"),
        ({"deadline": -1.0}, "deadline"),
        ({"deadline": float("nan")}, "deadline"),
    ],
)
def test_settings_out_of_range_are_named(settings, says):
    with pytest.raises(ct.CloudtouchError, match=says):
        ct.Query(**settings)


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"reject": "0.1"}, "reject is '0.1': give a number"),
        ({"prior": None}, "prior is None: give a number"),
        ({"deadline": [1.0, 2.0]}, "deadline is of the type list: give a number"),
        ({"max_contacts": -1}, "max_contacts is -1: give a whole number"),
        ({"doubt_units": "no"}, "doubt_units is 'no': give True or False"),
    ],
)
def test_settings_of_another_type_are_named(settings, says):
    with pytest.raises(TypeError, match=says):
        ct.Query(**settings)


def test_filters_of_another_type_are_named():
    points = np.random.default_rng(0).normal(size=(50, 3))
    for arguments, says in [
        ({"outliers": 8}, r"outliers is 8: give two numbers, such as \(8, 3.0\)"),
        ({"outliers": (-1, 1.0)}, r"outliers\[0\] is -1: give a whole number"),
        ({"keep_veil": 1}, "keep_veil is 1: give True or False"),
        ({"max_range": "far"}, "max_range is 'far': give a number"),
        ({"refined": None}, "refined is None: give True or False"),
        ({"robot": [points]}, "robot has a ndarray: give what Robot.seen returns"),
    ]:
        with pytest.raises(TypeError, match=says):
            ct.Cloud(points, sensor="exact", **arguments)
    # As numpy has them.
    ct.Cloud(points, sensor="exact", outliers=(np.int64(8), np.float32(3)), keep_veil=np.True_, max_range=np.float32(9))


def test_sensors_and_filters_out_of_range_are_named():
    points = np.random.default_rng(0).normal(size=(50, 3))
    for arguments, says in [
        ({"sensor": "sonar"}, "`sonar`"),
        ({"sensor": "iso:-1"}, "not negative"),
        ({"sensor": "per-point"}, "no covariance per point"),
        ({"sensor": "per-point", "covariances": np.tile(-np.eye(3), (50, 1, 1))}, r"covariances\[0\]: "),
        ({"sensor": "exact", "normals": np.zeros((50, 3))}, r"normals\[0\]: .*has no direction"),
        ({"sensor": "exact", "sensor_pose": np.diag([1.0, 1, -1, 1])}, "sensor_pose: .*mirrors"),
        ({"sensor": "exact", "min_range": 2.0, "max_range": 1.0}, "range"),
        ({"sensor": "exact", "outliers": (0, 1.0)}, "neighbo"),
        ({"sensor": "exact", "collision_map": 0.0}, "collision_map: cells of 0 m"),
    ]:
        with pytest.raises(ct.CloudtouchError, match=says):
            ct.Cloud(points, **arguments)
    for arguments in ({"covariances": np.eye(3)}, {"normals": np.ones((49, 3))}, {"sensor_pose": np.eye(3)}):
        with pytest.raises(ValueError, match=f"{next(iter(arguments))} has the shape"):
            ct.Cloud(points, sensor="exact", **arguments)


def test_a_sensor_that_is_a_number_is_told_what_to_be():
    with pytest.raises(TypeError, match='sensor is 0.002: give a str .* "kinect", or "iso:0.002"'):
        ct.Cloud(np.zeros((3, 3)), sensor=0.002)
    with pytest.raises(TypeError, match='sensor is NoneType: .* "iso:0.002"'):
        ct.Cloud(np.zeros((3, 3)), sensor=None)


def test_a_sensor_that_only_the_tool_chooses_was_unknown_without_a_remedy():
    with pytest.raises(ct.CloudtouchError, match="^sensor: `auto` .*cloudtouch info FILE"):
        ct.Cloud(np.zeros((3, 3)), sensor="auto")


def test_what_is_no_body_was_told_to_lack_an_attribute(table, parcel):
    query = ct.Query()
    for ask in [query.run, query.gradient]:
        with pytest.raises(TypeError, match="b is of the type ndarray: give a cloudtouch.Cloud or a cloudtouch.Mesh"):
            ask(table, np.eye(4), parcel)
    with pytest.raises(TypeError, match="b is of the type list"):
        query.run_batch(table, [], np.eye(4)[np.newaxis])
    with pytest.raises(TypeError, match="a is of the type str"):
        query.within("table.pcd", parcel, np.eye(4), 0.1)


def test_covariances_of_the_points_are_those_of_the_sensor_that_has_them(floor, plate):
    points = floor.points
    each = ct.Cloud(points, sensor="per-point", covariances=np.tile(1e-6 * np.eye(3), (len(points), 1, 1)))
    near = ct.Query().run(each, plate, lifted(0.004)).probability
    assert near == pytest.approx(ct.Query().run(floor, plate, lifted(0.004)).probability, abs=1e-9)
    wide = ct.Cloud(points, sensor="per-point", covariances=np.tile(1e-4 * np.eye(3), (len(points), 1, 1)))
    assert abs(ct.Query().run(wide, plate, lifted(0.02)).probability - near) > 0.01
    # They were passed over.
    with pytest.raises(ValueError, match="^covariances are given, and the sensor 'exact' does not use them: give"):
        ct.Cloud(points, sensor="exact", covariances=np.tile(1e-6 * np.eye(3), (len(points), 1, 1)))


def test_a_deadline_that_is_over_decides_nothing(table, parcel):
    pose = lifted(0.08)
    assert ct.Query().run(table, parcel, pose).verdict == "free"
    report = ct.Query(deadline=0.0).run(table, parcel, pose)
    assert (report.verdict, report.undecided_by, report.upper) == ("undecided", "bounds", 1.0)


def test_what_is_printed_is_worth_reading(table, parcel, floor):
    assert repr(table) == "<Mesh: 12 triangles, watertight, 0.6 x 0.4 x 0.03 m about (0, 0, -0.015)>"
    assert repr(floor).startswith("<Cloud: 400 points, sensor 'iso:0.001', 0.19")
    assert "(removed: missing 2)" in repr(
        ct.Cloud(np.vstack([floor.points, np.full((2, 3), np.nan)]), sensor="exact")
    )
    assert repr(ct.Query(prior=0.2)).startswith("Query(accept=0.9, reject=0.1, prior=0.2, ")
    free = ct.Query().run(table, parcel, lifted(0.2))
    assert repr(free).startswith("<Report: free, P = ") and free.probability < 1e-3
    touching = repr(ct.Query().run(table, parcel, lifted(0.05)))
    assert "in_collision, P = " in touching and " mm" in touching and "contact" in touching
    assert "warning: " in repr(ct.Query().run(table, parcel, lifted(500.0)))
    batch = ct.Query().run_batch(table, parcel, [lifted(0.1), lifted(0.6), lifted(0.02)])
    assert repr(batch) == "<Batch: 3 poses: 2 free, 1 in_collision; warnings: 1 outside_scene>"
    assert batch.warnings.tolist() == ["", "outside_scene", ""]


def test_poses_in_millimetres_were_free(table, parcel):
    """Of poses 30 to 300 mm above a table of 70 cm all read as free, and nothing in a batch said why."""
    poses = [lifted(mm) for mm in range(30, 300, 10)]
    batch = ct.Query().run_batch(table, parcel, poses)
    assert set(batch.verdict) == {"undecided"} and set(batch.warnings) == {"far_away"}
    assert not ct.Query().are_free(table, parcel, poses).any()


def test_one_pose_is_free_where_its_verdict_is(table, parcel):
    query = ct.Query()
    for height in (0.02, 0.06, 0.1, 200.0):
        free = query.is_free(table, parcel, lifted(height))
        assert free is (query.run(table, parcel, lifted(height)).verdict == "free")


def test_refining_changes_no_probability(parcel, table):
    refined = ct.Cloud(parcel.points, sensor="iso:0.002", refined=True)
    for height in HEIGHTS[::4]:
        one, other = (ct.Query().run(table, cloud, lifted(0.05 + height)) for cloud in (parcel, refined))
        assert one.probability == pytest.approx(other.probability, abs=1e-3)


def test_turning_a_batch_upside_down_turns_its_answers(floor, plate):
    poses = np.stack([lifted(z) for z in HEIGHTS])
    forth, back = (ct.Query().run_batch(floor, plate, p) for p in (poses, poses[::-1]))
    assert_same_batch(forth, ct.Batch(**{name: column[::-1] for name, column in back.columns().items()}))
