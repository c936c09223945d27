"""Robots from URDF: where links are, what they touch, and that a scan does not hold them."""

import pickle

import hypothesis.extra.numpy as arrays
import numpy as np
import pandas as pd
import pytest
from conftest import lifted
from hypothesis import given, settings
from hypothesis import strategies as st
from same import assert_same_report
from test_arrays import anything

import cloudtouch as ct

#: A bar of 1 m on a shoulder half a metre up that turns, and a finger at its end that slides; another follows it.
URDF = """<robot name='arm'><link name='post'><visual><geometry><box size='1 1 1'/></geometry></visual></link>
  <link name='bar'><collision><origin xyz='0.5 0 0'/><geometry><box size='1 0.04 0.04'/></geometry></collision></link>
  <link name='left'><collision><geometry><box size='0.02 0.02 0.02'/></geometry></collision></link>
  <link name='right'><collision><geometry><mesh filename='package://parts/finger.obj'/></geometry></collision></link>
  <joint name='shoulder' type='revolute'><parent link='post'/><child link='bar'/><origin xyz='0 0 0.5'/>
    <axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='1' velocity='1'/></joint>
  <joint name='opening' type='prismatic'><parent link='bar'/><child link='left'/><origin xyz='1.03 0 0'/>
    <axis xyz='0 1 0'/><limit lower='0' upper='0.1' effort='1' velocity='1'/></joint>
  <joint name='follows' type='prismatic'><parent link='bar'/><child link='right'/><origin xyz='1.03 0 0'/>
    <axis xyz='0 1 0'/><limit lower='-0.1' upper='0' effort='1' velocity='1'/>
    <mimic joint='opening' multiplier='-1'/></joint></robot>"""
CUBE = "".join(f"v {x} {y} {z}\n" for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.01, 0.01))
CUBE += "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot")
    (folder / "arm.urdf").write_text(URDF)
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "finger.obj").write_text(CUBE)
    return folder


@pytest.fixture(scope="module")
def robot(folder):
    return ct.Robot(folder / "arm.urdf", packages={"parts": folder / "elsewhere"})


def ground(z=0.0):
    axis = 0.02 * np.arange(70) - 0.1
    x, y = np.meshgrid(axis, axis - 0.6)
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, z)], axis=1)
    return points + np.random.default_rng(3).normal(scale=0.001, size=points.shape)


@pytest.fixture(scope="module")
def floor_under():
    return ct.Cloud(ground(), sensor="iso:0.001", refined=True)


def at(shoulder, opening=0.02):
    return {"shoulder": shoulder, "opening": opening}


def test_a_robot_tells_what_it_is_made_of(robot):
    assert robot.moving == ("shoulder", "opening") and robot.links == ("post", "bar", "left", "right")
    assert robot.unchecked_links == ("post",) and repr(robot) == "<Robot: 4 links, moved by shoulder, opening>"
    shoulder, opening, follows = robot.joints
    assert (shoulder.kind, shoulder.limits, shoulder.mimics) == ("revolute", (-1.5, 1.5), None)
    assert (opening.kind, follows.mimics) == ("prismatic", ("opening", -1.0, 0.0))
    assert robot.may_touch("bar", "left") and not robot.may_touch("left", "right")
    # A slip in a name read as a pair that is asked about.
    with pytest.raises(ct.CloudtouchError, match="^the robot has no link `Bar`: .*: bar, "):
        robot.may_touch("left", "Bar")


def test_links_are_where_the_joints_put_them(robot):
    poses = robot.link_poses(at(0.4, 0.03))
    turn = np.array([[np.cos(0.4), 0, np.sin(0.4)], [0, 1, 0], [-np.sin(0.4), 0, np.cos(0.4)]])
    np.testing.assert_allclose(poses["bar"][:3, :3], turn, atol=1e-12)
    np.testing.assert_allclose(poses["left"][:3, 3], turn @ [1.03, 0.03, 0.0] + [0, 0, 0.5], atol=1e-12)
    np.testing.assert_allclose(poses["right"][:3, 3], turn @ [1.03, -0.03, 0.0] + [0, 0, 0.5], atol=1e-12)


def test_the_link_that_touches_is_told(robot, floor_under):
    checker = ct.RobotChecker(robot, floor_under)
    assert checker.robot is robot and checker.check(ct.Query(), at(0.3)).verdict == "free"
    assert repr(checker) == f"<RobotChecker of {robot!r}>"
    found = checker.check(ct.Query(), at(0.5))
    assert found.verdict == "in_collision" and found.pairs[0].b in ("left", "right")
    assert {(pair.a, pair.b) for pair in found.pairs} >= {("surroundings", "left"), ("surroundings", "right")}
    assert abs(found.pairs[0].report.contacts[0].point[2]) < 0.01
    assert checker.check(ct.Query(), at(0.6)).pairs[0].b == "bar"
    assert [checker.is_free(ct.Query(), at(height)) for height in (0.3, 0.5, 0.6)] == [True, False, False]
    # Lifted by its base it is free.
    assert ct.RobotChecker(robot, floor_under, lifted(0.4)).check(ct.Query(), at(0.6)).verdict == "free"


def test_a_page_shows_the_robot_in_the_scan(robot, floor_under):
    text = ct.RobotChecker(robot, floor_under).page(ct.Query(), at(0.6), title="<arm>").html
    assert "All in all: in collision" in text and "surroundings / bar" in text and "&lt;arm&gt;" in text


def test_boxes_show_where_the_base_is(robot, floor_under):
    boxes = ct.RobotChecker(robot, floor_under, base_pose=lifted(1.0)).boxes(at(0.0))
    np.testing.assert_allclose(boxes["bar"], [[0, -0.02, 1.48], [1, 0.02, 1.52]], atol=1e-9)
    assert boxes["surroundings"].shape == (2, 3)


def test_links_touch_one_another_where_that_is_asked(robot, folder, floor_under):
    closed = at(0.0, 0.005)
    assert ct.RobotChecker(robot, floor_under).check(ct.Query(), closed).verdict == "free"
    (pair,) = ct.RobotChecker(robot, floor_under, self_collision=True).check(ct.Query(), closed).pairs
    assert {pair.a, pair.b} == {"left", "right"}
    (folder / "arm.srdf").write_text("<robot name='arm'><disable_collisions link1='left' link2='right'/></robot>")
    parts = {"parts": folder / "elsewhere"}
    tolerant = ct.Robot(folder / "arm.urdf", packages=parts, srdf=folder / "arm.srdf")
    assert tolerant.unknown_links == ()
    (folder / "slip.srdf").write_text("<robot name='arm'><disable_collisions link1='left' link2='rigth'/></robot>")
    assert ct.Robot(folder / "arm.urdf", packages=parts, srdf=folder / "slip.srdf").unknown_links == ("rigth",)
    assert ct.RobotChecker(tolerant, floor_under, self_collision=True).check(ct.Query(), closed).verdict == "free"


def test_what_may_touch_and_what_is_held(robot, floor_under):
    checker = ct.RobotChecker(robot, floor_under)
    down = at(0.5)
    touching = {pair.b for pair in checker.check(ct.Query(), down).pairs}
    for link in touching:
        checker.allow(link)
    assert checker.check(ct.Query(), down).verdict == "free"
    # A rod of 60 cm across the bar's end, one half of it below.
    corners = np.array([[x, y, z] for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.3, 0.3)])
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4]]
    rod = ct.Mesh(corners, np.array([*faces, [1, 5, 7], [1, 7, 3]]))
    there = np.eye(4)
    there[0, 3] = 0.9
    checker.hold("rod", rod, "bar", there)
    found = checker.check(ct.Query(), at(0.3))
    assert found.verdict == "in_collision" and {pair.b for pair in found.pairs} == {"rod"}
    path = checker.check_path(ct.Query(), [at(-0.5), at(0.3)])
    assert path.verdict == "in_collision" and 0.0 < path.certified_free_until < 1.0
    with pytest.raises(ct.CloudtouchError, match="`rod`"):
        checker.hold("rod", rod, "bar")
    with pytest.raises(ct.CloudtouchError, match="`nobody`"):
        checker.allow("nobody")
    checker.release("rod")
    assert checker.check(ct.Query(), at(0.3)).verdict == "free"
    with pytest.raises(ct.CloudtouchError, match="`rod`"):
        checker.release("rod")


def test_a_path_is_free_up_to_where_it_is_not(robot, floor_under):
    checker = ct.RobotChecker(robot, floor_under)
    path = checker.check_path(ct.Query(), [at(-0.5), at(0.3)])
    assert (path.verdict, path.certified_free_until, path.stopped) == ("free", 1.0, None) and len(path.given) == 2
    # The fingers are at the floor where 1.03 sin + 0.01 cos = 0.5, at 0.496 rad of 1.
    down = checker.check_path(ct.Query(), np.array([[0.0, 0.02], [1.0, 0.02]]), tolerance=0.001)
    assert down.verdict == "in_collision" and 0.46 < down.certified_free_until < 0.496
    assert down.stopped is not None and down.stopped.segment == 0 and down.looked_at > 10
    assert [checked.verdict for checked in down.given] == ["free", "in_collision"]


def test_the_robot_is_removed_from_a_scan_that_shows_it(robot):
    random = np.random.default_rng(4)
    bar = np.stack([random.uniform(0, 1, 800), random.uniform(-0.02, 0.02, 800), np.full(800, 0.52)], axis=1)
    points = np.concatenate([ground(), bar + random.normal(scale=0.002, size=bar.shape)])
    seen = robot.seen(at(0.0), padding=0.02)
    assert [len(link.mesh) for link in seen] == [12, 12, 12] and {link.padding for link in seen} == {0.02}
    with_it = ct.Cloud(points, sensor="iso:0.002")
    without = ct.Cloud(points, sensor="iso:0.002", robot=seen)
    assert without.removed["robot"] == 800 and len(without) == 4900
    assert ct.RobotChecker(robot, with_it).check(ct.Query(), at(0.0)).verdict != "free"
    assert ct.RobotChecker(robot, without).check(ct.Query(), at(0.0)).verdict == "free"
    again = pickle.loads(pickle.dumps(without))
    pose = lifted(0.003)
    assert_same_report(ct.Query().run(again, with_it, pose), ct.Query().run(without, with_it, pose))
    # A scan that is added is filtered by where the robot was then.
    second_look = points + 0.0005
    assert without.insert(second_look, robot=robot.seen(at(0.0), padding=0.02)).inserted == 4900
    with pytest.raises(ct.CloudtouchError, match="rotation"):
        ct.Cloud(points, sensor="exact", robot=[ct.SeenLink(seen[0].mesh, np.diag([2.0, 1, 1, 1]), 0.0)])


def test_a_change_of_the_surroundings_is_seen(robot):
    world = ct.Cloud(ground(), sensor="iso:0.001")
    checker = ct.RobotChecker(robot, world)
    assert checker.check(ct.Query(), at(0.0)).verdict == "free"
    world.insert(ground(0.5))
    assert checker.check(ct.Query(), at(0.0)).verdict == "in_collision"
    world.remove(world.points[:, 2] > 0.4)
    assert checker.check(ct.Query(), at(0.0)).verdict == "free"


@settings(deadline=None, max_examples=150, derandomize=True)
@given(joints=anything | arrays.arrays(st.sampled_from([np.float32, np.float64, np.int8]), 2))
def test_any_array_is_a_position_or_a_value_error(joints, robot):
    for given_joints in (joints, joints[::-1][::-1]) if joints.ndim else (joints,):
        try:
            poses = robot.link_poses(given_joints)
        except ValueError as error:
            assert len(str(error)) > 15
        else:
            shoulder, opening = map(float, given_joints)
            assert abs(shoulder) < 1.51 and -0.01 < opening < 0.11
            np.testing.assert_array_equal(poses["left"], robot.link_poses(at(shoulder, opening))["left"])


def test_positions_of_any_layout(robot, floor_under):
    checker, plain = ct.RobotChecker(robot, floor_under), [[0.1, 0.0], [0.3, 0.05]]
    expected = checker.check_path(ct.Query(), [at(*row) for row in plain]).looked_at
    rows = np.array(plain)
    rows.flags.writeable = False
    for path in (plain, rows, np.asfortranarray(rows), np.repeat(rows, 2, axis=1)[:, ::2], rows.astype(">f8")):
        assert checker.check_path(ct.Query(), path).looked_at == expected


def test_wrong_positions_and_files_are_told(robot, folder, floor_under):
    checker = ct.RobotChecker(robot, floor_under)
    for joints, says in [
        ({}, "no position is given for `opening`, `shoulder`"),
        (at(np.nan), "joint `shoulder` is at NaN"),
        (at(2.0), "beyond its limits -1.5 .. 1.5"),
        ({**at(0.0), "elbow": 0.0}, "no joint `elbow` that moves"),
        ({**at(0.0), "follows": 0.05}, "`follows` mimics `opening`"),
    ]:
        with pytest.raises(ct.CloudtouchError) as error:
            checker.check(ct.Query(), joints)
        assert says in str(error.value)
    for joints, says in [
        ([0.0], r"joints has the shape \(1,\): give \(2,\)"),
        (np.zeros((2, 2)), "joints has the shape"),
        ({"shoulder": "up", "opening": "no"}, "joints has the type"),
    ]:
        with pytest.raises(ValueError, match=says):
            checker.check(ct.Query(), joints)
    for ask, name in [
        (lambda: ct.RobotChecker(robot, floor_under, base_pose=2 * np.eye(4)), "base_pose"),
        (lambda: robot.seen(at(0.0), base_pose=2 * np.eye(4)), "base_pose"),
        (lambda: checker.hold("cup", floor_under, "bar", 2 * np.eye(4)), "link_from_body"),
    ]:
        with pytest.raises(ct.CloudtouchError, match=f"^{name}: "):
            ask()
    for padding in [-1, np.nan]:
        with pytest.raises(ValueError, match=f"padding is {padding}: give metres, 0 or more"):
            robot.seen(at(0.0), padding=padding)
    with pytest.raises(TypeError, match="surroundings is of the type ndarray"):
        ct.RobotChecker(robot, np.zeros((5, 3)))
    with pytest.raises(ct.CloudtouchError, match="too few positions .1.:"):
        checker.check_path(ct.Query(), [at(0.0)])
    with pytest.raises(ct.CloudtouchError, match="position 2 of the path: joint `shoulder`"):
        checker.check_path(ct.Query(), [at(0.0), at(9.0)])
    with pytest.raises(ValueError, match=r"path\[1\] has the shape"):
        checker.check_path(ct.Query(), [[0.0, 0.0], [0.0]])
    with pytest.raises(ct.CloudtouchError, match="tolerance is 0"):
        checker.check_path(ct.Query(), [at(0.0), at(0.1)], tolerance=0.0)
    with pytest.raises(ct.CloudtouchError, match="package `parts` is not known"):
        ct.Robot(folder / "arm.urdf")
    with pytest.raises(ct.CloudtouchError, match="gone.urdf: cannot be read"):
        ct.Robot(folder / "gone.urdf")
    for ask, says in [
        (lambda: checker.check(None, at(0.0)), "^query is None: give a cloudtouch.Query"),
        (lambda: checker.page(None, at(0.0)), "^query is None"),
        (lambda: checker.check_path("q", [at(0.0), at(0.1)]), "^query is 'q'"),
        (lambda: checker.allow(5), "^a is 5: give a str"),
        (lambda: checker.release(None), "^name is None: give a str"),
    ]:
        with pytest.raises(TypeError, match=says):
            ask()
    with pytest.raises(TypeError, match="does not pickle"):
        pickle.dumps(robot)


def test_a_row_of_a_joint_log_lost_the_names_of_its_joints(robot, floor_under):
    """A pandas row was taken as numbers in the order of ``Robot.moving``, whatever its columns are."""
    log = pd.DataFrame([{"opening": 0.02, "shoulder": 0.1}, {"opening": 0.03, "shoulder": 0.7}])
    assert list(log.columns) != list(robot.moving)
    checker, query = ct.RobotChecker(robot, floor_under), ct.Query()
    for _, row in log.iterrows():
        wanted = checker.check(query, row.to_dict())
        assert checker.check(query, row).verdict == wanted.verdict
        assert robot.link_poses(row)["left"].tolist() == robot.link_poses(row.to_dict())["left"].tolist()
    by_names = checker.check_path(query, log.to_dict("records"))
    assert checker.check_path(query, log).certified_free_until == by_names.certified_free_until
    in_order = pd.Series([0.1, 0.02])
    assert robot.link_poses(in_order)["left"].tolist() == robot.link_poses([0.1, 0.02])["left"].tolist()
