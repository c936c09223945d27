"""Clouds that change in their place answer as those made anew of the same points."""

import pickle
import threading

import hypothesis.extra.numpy as arrays
import numpy as np
import pytest
from cloudtouch.demo import table_top
from conftest import lifted, sheet
from hypothesis import given, settings
from hypothesis import strategies as st
from same import assert_same_report
from test_arrays import LAYOUTS, anything

import cloudtouch as ct

POINTS = sheet(seed=5)
#: With a point at each end of the box around all, whose middle then stays.
ENDS = np.unique(np.concatenate([POINTS.argmin(axis=0), POINTS.argmax(axis=0)]))


def cloud(points=POINTS, **others):
    return ct.Cloud(points, sensor="iso:0.001", **others)


def assert_same_answers(changed, made, plate):
    for height in (0.0, 0.004, 0.012):
        reports = [ct.Query().run(body, plate, lifted(height)) for body in (changed, made)]
        assert abs(reports[0].probability - reports[1].probability) < 1e-2
    assert changed.rebuild().is_rebuilt
    for height in (0.0, 0.004, 0.012):
        assert_same_report(ct.Query().run(changed, plate, lifted(height)), ct.Query().run(made, plate, lifted(height)))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_inserted_points_are_as_if_given_at_once(layout, dtype, plate):
    points = np.concatenate([POINTS[ENDS], np.delete(POINTS, ENDS, axis=0)]).astype(dtype)
    changed = cloud(points[:200], refined=True)
    change = changed.insert(LAYOUTS[layout](points[200:]))
    assert change == ct.Change(200, 0, 0, change.surfaces_kept, 200 - change.surfaces_kept, False, change.is_rebuilt)
    assert len(changed) == 400 and changed.rows.tolist() == list(range(400))
    np.testing.assert_array_equal(changed.points, points)
    assert_same_answers(changed, cloud(points, refined=True), plate)


def test_points_go_by_index_or_by_truth_value(plate):
    goes = np.zeros(400, dtype=bool)
    goes[50:90] = True
    goes[ENDS] = False
    by_index, by_truth = cloud(), cloud()
    assert by_index.remove(np.flatnonzero(goes)[::-1]).removed == by_truth.remove(goes).removed == goes.sum()
    for changed in (by_index, by_truth):
        np.testing.assert_array_equal(changed.points, POINTS[~goes])
        assert_same_answers(changed, cloud(POINTS[~goes]), plate)
    # Backwards to where it was: the order of the points is another.
    by_index.insert(POINTS[goes])
    assert_same_answers(by_index, cloud(np.concatenate([POINTS[~goes], POINTS[goes]])), plate)


def test_points_move(plate):
    which = np.setdiff1d(np.arange(100, 140), ENDS)
    places = POINTS[which] + [0.0, 0.0, 0.0005]
    places.flags.writeable = False
    changed, moved = cloud(), POINTS.copy()
    moved[which] = places
    assert changed.move_points(which, places).moved == len(which)
    np.testing.assert_array_equal(changed.points, moved)
    assert_same_answers(changed, cloud(moved), plate)


def image(distance):
    """A wall seen by a camera with a box in the middle, (30, 40, 3)."""
    rows, columns = np.mgrid[0:30, 0:40]
    z = np.full((30, 40), 1.0)
    z[10:20, 15:25] = distance
    return np.stack([(columns - 20) * 0.01 * z, (rows - 15) * 0.01 * z, z], axis=-1)


def test_a_camera_sees_that_something_is_gone():
    world = ct.Cloud(image(0.7), sensor="kinect")
    vertices, triangles = table_top()
    block, at_the_box = ct.Mesh(vertices * [0.1, 0.1, 2.0], triangles), lifted(0.73)
    assert ct.Query(max_unseen=1.0).run(world, block, at_the_box).verdict == "in_collision"
    change = world.replace_frame(image(1.0))
    assert change.removed >= 100 and change.inserted == 1200
    assert ct.Query(max_unseen=1.0).run(world, block, at_the_box).verdict == "free"
    with pytest.raises(ct.CloudtouchError, match="no depth image"):
        world.replace_frame(image(1.0).reshape(-1, 3))


def test_scenes_see_the_change(plate):
    changed = cloud()
    scene = ct.Scene()
    scene.add("floor", changed)
    scene.add("plate", plate, lifted(0.1))
    assert scene.check(ct.Query()).verdict == "free"
    changed.insert(sheet(z=0.1, seed=6))
    assert [{pair.a, pair.b} for pair in scene.check(ct.Query()).pairs] == [{"floor", "plate"}]


def test_what_cannot_be_changed_is_told_and_left_as_it_was(plate):
    changed = cloud()
    for change, says in [
        (lambda: changed.remove([400]), "there is no point 400"),
        (lambda: changed.remove([3, 3]), "point 3 is named twice"),
        (lambda: changed.remove(np.ones(400, dtype=bool)), "all 400 points"),
        (lambda: changed.move_points([0], [[0.0, 0.0, np.nan]]), "point 0 would get the coordinate NaN"),
        (lambda: changed.insert(np.empty((0, 3))), "the cloud has no points"),
        (lambda: changed.insert(np.full((5, 3), np.nan)), "no point is left of 5"),
        (lambda: changed.insert(POINTS, sensor="nothing"), "nothing"),
    ]:
        with pytest.raises(ct.CloudtouchError) as error:
            change()
        assert says in str(error.value)
    for change, says in [
        (lambda: changed.remove([[1]]), r"which has the shape \(1, 1\)"),
        (lambda: changed.remove([-1]), "counted from 0"),
        (lambda: changed.remove([True]), r"truth values \(400,\)"),
        (lambda: changed.remove([0.5]), "type float64"),
        (lambda: changed.move_points([0, 1], np.zeros((1, 3))), r"places has the shape \(1, 3\): give \(2, 3\)"),
        (lambda: changed.insert(np.zeros((4, 2))), r"points has the shape \(4, 2\)"),
    ]:
        with pytest.raises(ValueError, match=says):
            change()
    copy = pickle.loads(pickle.dumps(changed))
    for same in (changed, copy):
        assert_same_answers(same, cloud(), plate)


@settings(deadline=None, max_examples=150, derandomize=True)
@given(which=anything | arrays.arrays(st.sampled_from([np.int64, np.uint8, np.bool_]), st.integers(0, 400)))
def test_any_array_names_points_or_is_a_value_error(which):
    changed = cloud()
    named = np.zeros(400, dtype=bool)
    try:
        change = changed.remove(which)
    except ValueError as error:
        assert len(str(error)) > 15 and len(changed) == 400
    else:
        # A truth value for each was all false, or indices named so many.
        named[which if which.size else []] = True
        assert change.removed == named.sum() == 400 - len(changed)
        np.testing.assert_array_equal(changed.points, POINTS[~named])


@settings(deadline=None, max_examples=150, derandomize=True)
@given(places=anything | arrays.arrays(st.sampled_from([np.float32, np.float64]), (2, 3)))
def test_any_array_is_a_place_or_a_value_error(places):
    changed = cloud()
    try:
        changed.move_points([7, 3], places)
    except ValueError as error:
        assert len(str(error)) > 15
        np.testing.assert_array_equal(changed.points, POINTS)
    else:
        np.testing.assert_array_equal(changed.points[[7, 3]], places)


def test_a_changed_cloud_does_not_pickle():
    changed = cloud()
    changed.remove([0])
    with pytest.raises(TypeError, match="changed does not pickle"):
        pickle.dumps(changed)


def test_a_cloud_that_is_asked_about_does_not_change(plate):
    changed, query = cloud(), ct.Query()
    poses = np.tile(lifted(0.003), (2000, 1, 1))
    asks = threading.Thread(target=lambda: query.run_batch(changed, plate, poses))
    asks.start()
    refused = 0
    while asks.is_alive():
        try:
            changed.move_points([7], POINTS[[7]])
        except ct.CloudtouchError as error:
            assert "asked about by another thread" in str(error)
            refused += 1
    assert refused and changed.move_points([7], POINTS[[7]]).moved == 1
    assert_same_answers(changed, cloud(), plate)
