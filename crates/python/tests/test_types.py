"""Single values of another type are refused by the name of their argument."""

import numpy as np
import pytest
from conftest import lifted

import cloudtouch as ct

URDF = """<robot name='r'><link name='a'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>
  <link name='b'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>"""


@pytest.fixture
def robot(tmp_path):
    (tmp_path / "r.urdf").write_text(URDF)
    return ct.Robot(tmp_path / "r.urdf")


def refused(cases, kind=TypeError):
    for ask, says in cases:
        with pytest.raises(kind, match=says):
            ask()


def test_a_truth_value_counted_as_the_number_one(table, parcel, robot):
    query, pose = ct.Query(), lifted(0.2)
    refused(
        [
            (lambda: ct.Query(deadline=True), "^deadline is True: give a number"),
            (lambda: ct.Query(accept=np.True_), "^accept is True: give a number"),
            (lambda: ct.Query(max_contacts=True), "^max_contacts is True: give a whole number, 0 or more"),
            (lambda: query.within(table, parcel, pose, True), "^margin is True: give a number"),
            (lambda: ct.Cloud(parcel.points, sensor="iso:0.002", max_range=False), "^max_range is False: give a number"),
            (lambda: robot.seen([0.0], padding=True), "^padding is True: give a number"),
        ]
    )


def test_numbers_too_large_for_the_compiled_half_were_told_in_its_words(table, parcel):
    page = ct.Query().page(table, parcel, lifted(0.2))
    many = {"sensor": "iso:0.002", "outliers": (2**70, 3.0)}
    refused(
        [
            (lambda: ct.Query(max_contacts=2**70), "^max_contacts is a whole number of 71 bits: give at most"),
            (lambda: ct.Cloud(parcel.points, **many), r"^outliers\[0\] is a whole number of 71 bits: give at most"),
            (lambda: page.frame(2**32), "^height is 4294967296: give at most 4294967295"),
        ],
        ValueError,
    )
    refused([(lambda: ct.Query(accept=10**400), "^accept is a whole number of 1329 bits: give a number")])
    for deadline in (-1.0, np.inf, np.nan, 1e300):
        with pytest.raises(ct.CloudtouchError, match="^deadline is .*: give seconds, 0 or more, or None"):
            ct.Query(deadline=deadline)
    everything = 2**63 - 1
    assert ct.Query(max_contacts=np.int64(everything)).run(table, parcel, lifted(0.2)).verdict == "free"


def test_what_a_query_is_asked_was_told_without_its_name(table, parcel):
    query, pose = ct.Query(), lifted(0.2)
    path = [lifted(0.2), lifted(0.3)]
    refused(
        [
            (lambda: query.clearance_interval(table, parcel, pose, "most"), "^share is 'most': give a number"),
            (lambda: query.penetration(table, parcel, pose, None), "^probability is None: give a number"),
            (lambda: query.sweep(table, parcel, path, tolerance="fine"), "^tolerance is 'fine': give a number"),
            (lambda: query.sweep(table, parcel, path, screw=1), "^screw is 1: give True or False"),
            (lambda: query.page(table, parcel, pose, title=5), "^title is 5: give a str"),
            (lambda: query.page(table, pose, pose), "^b is of the type ndarray: give a cloudtouch.Cloud"),
            (lambda: query.page(table, parcel, pose).frame(-1), "^height is -1: give a whole number, 0 or more"),
        ]
    )


def test_what_a_robot_is_asked_was_told_without_its_name(robot, floor):
    checker, query = ct.RobotChecker(robot, floor), ct.Query()
    refused(
        [
            (lambda: ct.RobotChecker("arm.urdf", floor), "^robot is 'arm.urdf': give a cloudtouch.Robot"),
            (lambda: checker.check_path(query, [[0.0], [1.0]], tolerance="fine"), "^tolerance is 'fine'"),
            (lambda: robot.seen([0.0], padding="1 cm"), "^padding is '1 cm': give a number"),
            (lambda: ct.RobotChecker(robot, floor, self_collision="no"), "^self_collision is 'no': give True or False"),
            (lambda: robot.may_touch("a", None), "^b is None: give a str"),
            (lambda: checker.check_path(query, None), "^path is None: give .M, J., or a list of positions"),
            (lambda: checker.check_path(query, {"j": 0.0}), "^path is of the type dict: give"),
            (lambda: checker.check_path(query, "path.csv"), "^path is 'path.csv': give"),
        ]
    )


def test_names_of_files_of_another_kind_were_told_without_their_argument(tmp_path):
    urdf = tmp_path / "r.urdf"
    refused(
        [
            (lambda: ct.Robot(5), "^urdf is 5: give the path of a file"),
            (lambda: ct.Robot(urdf, srdf=5), "^srdf is 5: give the path of a file"),
            (lambda: ct.Robot(urdf, packages=tmp_path), "^packages is of the type .*Path: give folders by name"),
            (lambda: ct.Robot(urdf, packages={"parts": 5}), r"^packages\['parts'\] is 5: give the path of a folder"),
            (lambda: ct.Robot(urdf, packages={5: tmp_path}), "^a name of packages is 5: give a str"),
            (lambda: ct.Cloud.read(5, sensor="iso:0.002"), "^path is 5: give the path of a file"),
            (lambda: ct.Cloud.read("a.pcd", sensor="iso:0.002", unit=5), "^unit is 5: give a str"),
            (lambda: ct.Mesh.read(None), "^path is None: give the path of a file"),
            (lambda: ct.Mesh.read("a.stl", unit=None), "^unit is None: give a str"),
        ]
    )


def test_what_makes_no_array_was_told_without_its_name(table, parcel):
    ragged, query = [[1.0, 2.0], [1.0]], ct.Query()
    refused(
        [
            (lambda: query.page(table, parcel, ragged), "^poses makes no array"),
            (lambda: query.run_uncertain(table, parcel, lifted(0.2), ragged), "^covariance makes no array"),
        ],
        ValueError,
    )


def test_a_link_of_another_kind_was_told_in_words_of_the_compiled_half(table, floor):
    def seen(mesh, padding):
        return ct.Cloud(floor.points, sensor="iso:0.001", robot=[ct.SeenLink(mesh, np.eye(4), padding)])

    refused(
        [
            (lambda: seen("link.stl", 0.01), "^robot has a link of the type str: give a cloudtouch.Mesh"),
            (lambda: seen(floor, 0.01), "^robot has a link of the type Cloud: give a cloudtouch.Mesh"),
            (lambda: seen(table, "1 cm"), "^robot: padding is '1 cm': give a number"),
        ]
    )


def test_what_is_under_a_mask_counted_as_an_index(table, parcel):
    masked = np.ma.masked_array(table.triangles, mask=False)
    masked[0] = np.ma.masked
    with pytest.raises(ValueError, match="^triangles is a masked array: give the rows of it that count"):
        ct.Mesh(table.vertices, masked)
    with pytest.raises(ValueError, match="^which is a masked array"):
        ct.Cloud(parcel.points, sensor="iso:0.002").remove(np.ma.masked_array([1, 2], mask=[True, False]))
