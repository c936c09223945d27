"""Scenes of many bodies, ways out and gradients."""

import numpy as np
import pytest
from conftest import lifted
from same import assert_same_report

import cloudtouch as ct

#: Turned by some 37° about x, so that the plate goes through the floor.
CROSSING = np.array([[1, 0, 0, 0], [0, 0.8, -0.6, 0.05], [0, 0.6, 0.8, -0.05], [0, 0, 0, 1.0]])


@pytest.fixture
def scene(floor, plate, table):
    scene = ct.Scene()
    scene.add("floor", floor)
    scene.add("plate", plate, lifted(0.1))
    scene.add("table", table, lifted(1.0))
    return scene


def test_pairs_that_may_touch_are_told_with_their_report(scene, floor, plate):
    assert scene.check(ct.Query()).verdict == "free" and scene.check_first(ct.Query()) is None
    scene.set_pose("plate", CROSSING)
    found = scene.check(ct.Query())
    (pair,) = found.pairs
    assert {pair.a, pair.b} == {"floor", "plate"} and found.verdict == pair.verdict == pair.report.verdict
    assert (found.count, found.allowed, found.ruled_out + found.asked) == (3, 0, 3)
    assert scene.check_first(ct.Query()).report.probability == pair.report.probability
    alone = [ct.Query().run(floor, plate, CROSSING), ct.Query().run(plate, floor, np.linalg.inv(CROSSING))]
    assert min(abs(report.probability - pair.report.probability) for report in alone) < 1e-3


def test_where_bodies_are_and_what_is_to_be_said_of_them_is_told_where_all_is_free(scene, plate):
    low, high = scene.boxes()["plate"]
    scene.set_pose("plate", lifted(0.6))
    moved = scene.boxes()["plate"] - [low, high]
    np.testing.assert_allclose(moved, [[0, 0, 0.5]] * 2, atol=1e-9)
    assert scene.check(ct.Query()).warnings == ()
    ahead = np.random.default_rng(5).uniform([-0.5, -0.5, 1.0], [0.5, 0.5, 1.001], size=(2000, 3))
    scene.add("scan", ct.Cloud(ahead, sensor="kinect"), lifted(3.0))
    found = scene.check(ct.Query())
    assert [warning.name for warning in found.warnings] == ["scan"] and found.verdict == "free"
    assert "no rows and columns" in found.warnings[0].words


def test_what_is_attached_moves_along(scene):
    scene.attach("plate", "table")
    scene.set_pose("table", lifted(0.9))
    assert [{pair.a, pair.b} for pair in scene.check(ct.Query()).pairs] == [{"floor", "plate"}]
    scene.allow("floor", "plate")
    found = scene.check(ct.Query())
    assert found.verdict == "free" and found.allowed == 1 and found.unchecked == ()
    scene.allow("floor", "table")
    assert scene.check(ct.Query()).unchecked == ("floor",)
    scene.allow("floor", "table", False)
    scene.allow("plate", "floor", False)
    scene.detach("plate")
    scene.set_pose("table", lifted(2.0))
    assert scene.check(ct.Query()).verdict != "free"
    scene.remove("plate")
    assert scene.names == ["floor", "table"] and len(scene) == 2 and repr(scene) == "<Scene: floor, table>"


def test_wrong_names_and_poses_are_told(scene, floor):
    with pytest.raises(ct.CloudtouchError, match="floor"):
        scene.add("floor", floor)
    with pytest.raises(ct.CloudtouchError, match="nobody"):
        scene.set_pose("nobody", lifted(0))
    with pytest.raises(ct.CloudtouchError, match="rotation"):
        scene.set_pose("floor", np.diag([2.0, 1, 1, 1]))
    with pytest.raises(ValueError, match="pose has the shape"):
        scene.add("other", floor, np.eye(3))
    for add in [scene.add, scene.replace]:
        with pytest.raises(TypeError, match="body is of the type ndarray: give a cloudtouch.Cloud"):
            add("floor", np.zeros((5, 3)))


def test_a_body_that_was_to_be_moved_to_no_pose_went_to_the_origin(scene):
    """As what was looked up and not found is handed on."""
    before = scene.boxes()["plate"]
    with pytest.raises(TypeError, match="^pose is None: give an array"):
        scene.set_pose("plate", None)
    assert (scene.boxes()["plate"] == before).all()


def test_arguments_of_another_type_are_named(scene, floor):
    query = ct.Query()
    for ask, says in [
        (lambda: scene.add(5, floor), "^name is 5: give a str"),
        (lambda: scene.replace(None, floor), "^name is None: give a str"),
        (lambda: scene.set_pose(5, np.eye(4)), "^name is 5"),
        (lambda: scene.attach("plate", 5), "^to is 5"),
        (lambda: scene.allow("plate", ["floor"]), "^b is of the type list"),
        (lambda: scene.allow("plate", "floor", "no"), "^may_touch is 'no': give True or False"),
        (lambda: scene.check(None), "^query is None: give a cloudtouch.Query"),
        (lambda: scene.check_first({"reject": 0.1}), "^query is of the type dict"),
        (lambda: scene.page(None), "^query is None"),
        (lambda: scene.page(query, title=5), "^title is 5"),
    ]:
        with pytest.raises(TypeError, match=says):
            ask()


def test_a_scene_in_which_all_may_touch_read_as_free(floor, plate):
    scene = ct.Scene()
    assert scene.check(ct.Query()).verdict == "undecided"
    scene.add("floor", floor)
    scene.add("plate", plate, lifted(0.5))
    assert scene.check(ct.Query()).verdict == "free" and scene.is_free(ct.Query())
    scene.allow("floor", "plate")
    found = scene.check(ct.Query())
    assert found.verdict == "undecided" and found.pairs == () and not scene.is_free(ct.Query())


@pytest.mark.parametrize("height", [0.056, 0.058])
def test_a_gradient_is_that_of_differences(table, parcel, height):
    query, step = ct.Query(), 1e-6
    report, slope = query.gradient(table, parcel, lifted(height))
    assert report.probability == query.run(table, parcel, lifted(height)).probability
    above, below = (query.run(table, parcel, lifted(height + sign * step)).probability for sign in (1, -1))
    assert slope.probability[2] == pytest.approx((above - below) / (2 * step), rel=1e-3)
    by_odds = slope.log_odds * report.probability * (1 - report.probability)
    assert slope.probability == pytest.approx(by_odds, rel=1e-9)


def test_a_way_out_leads_out(table, parcel):
    query, pose = ct.Query(), lifted(0.03)
    report, out = query.penetration(table, parcel, pose)
    assert report.verdict == "in_collision" and out is not None and 0.01 < out.depth <= out.distance < 0.05
    moved = pose.copy()
    moved[:3, 3] += out.distance * out.direction
    assert query.run(table, parcel, moved).probability < 0.11
    with pytest.raises(ct.CloudtouchError, match="probability"):
        query.penetration(table, parcel, pose, 2.0)
