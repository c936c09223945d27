"""Copies of scenes and checkers: what changes by itself, and what is shared."""

import copy
import pickle

import numpy as np
import pytest
from conftest import lifted, sheet
from test_scene import CROSSING

import cloudtouch as ct

ARM = """<robot name='arm'><link name='post'/>
  <link name='bar'><collision><geometry><box size='0.4 0.02 0.02'/></geometry></collision></link>
  <link name='tool'><collision><origin xyz='0 0 0.5'/><geometry><box size='0.02 0.02 0.02'/></geometry></collision></link>
  <joint name='lift' type='prismatic'><parent link='post'/><child link='bar'/><axis xyz='0 0 1'/>
    <limit lower='-1' upper='1' effort='1' velocity='1'/></joint>
  <joint name='grip' type='fixed'><parent link='bar'/><child link='tool'/></joint></robot>"""


@pytest.fixture
def scene(floor, plate):
    scene = ct.Scene()
    scene.add("floor", floor)
    scene.add("plate", plate, CROSSING)
    return scene


@pytest.fixture
def checker(tmp_path, floor):
    (tmp_path / "arm.urdf").write_text(ARM)
    return ct.RobotChecker(ct.Robot(tmp_path / "arm.urdf"), floor)


def test_a_body_moved_in_a_copy_moved_in_the_scene_too(scene):
    """A planner that tried a place in a copy left the scene itself there, and a collision read as free."""
    query, tried = ct.Query(), copy.copy(scene)
    assert scene.check(query).verdict == tried.check(query).verdict == "in_collision"
    tried.set_pose("plate", lifted(0.3))
    assert tried.is_free(query) and not scene.is_free(query)
    tried.remove("plate")
    scene.attach("plate", "floor")
    assert tried.names == ["floor"] and scene.names == ["floor", "plate"]


def test_what_a_copy_of_a_checker_allows_and_holds_is_its_own(checker, plate):
    query, tried = ct.Query(), copy.copy(checker)
    assert checker.check(query, [0.0]).verdict == tried.check(query, [0.0]).verdict == "in_collision"
    tried.allow("bar")
    tried.hold("plate", plate, "tool", lifted(0.8))
    assert tried.is_free(query, [0.0]) and not checker.is_free(query, [0.0])
    assert "plate" not in checker.boxes([0.0]) and tried.robot is checker.robot


def test_a_copy_shares_its_bodies_and_is_of_the_same_class():
    class Cell(ct.Scene):
        pass

    cell, scan = Cell(), ct.Cloud(sheet(seed=1), sensor="iso:0.001")
    cell.name = "north"
    cell.add("scan", scan)
    again = copy.copy(cell)
    before = again.boxes()["scan"]
    scan.move_points([0], [[0.0, 0.0, 1.0]])
    assert type(again) is Cell and again.name == "north"
    assert not np.array_equal(again.boxes()["scan"], before)
    np.testing.assert_array_equal(again.boxes()["scan"], cell.boxes()["scan"])


@pytest.mark.parametrize("take", [copy.deepcopy, pickle.dumps])
def test_what_neither_pickles_nor_copies_its_bodies_says_what_to_do(take, scene, checker):
    for what, kind in ((scene, "a scene"), (checker, "a robot checker")):
        with pytest.raises(TypeError, match=f"{kind} does not pickle.*copy.copy"):
            take(what)
