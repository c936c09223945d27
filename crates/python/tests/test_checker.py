"""Tables of poses: the same bits however they are shared out, and no row spoils another."""

import pickle

import numpy as np
import pandas as pd
import pytest
from conftest import lifted, sheet
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_files import write_points, write_table

import cloudtouch as ct

HEIGHTS = (-0.002, 0.0, 0.003, 0.006, 0.03)


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scans")
    for seed in (1, 2):
        write_points(folder / f"floor{seed}.xyz", sheet(seed=seed))
    write_points(folder / "plate.xyz", sheet(seed=3))
    write_table(folder / "table.obj")
    return folder


def table():
    pairs = [(s, o) for s in ("floor1.xyz", "floor2.xyz") for o in ("plate.xyz", "table.obj")]
    rows = [(s, o, lifted(z)) for s, o in pairs for z in HEIGHTS]
    scene, body, pose = zip(*rows)
    return {"scene": np.array(scene), "object": np.array(body), "pose": np.stack(pose), "id": np.arange(len(rows))}


def taken(rows, places):
    return {name: column[places] for name, column in rows.items()}


def assert_same(one, other):
    assert one.keys() == other.keys()
    for name in one.keys() - {"seconds"}:
        np.testing.assert_array_equal(one[name], other[name], err_msg=name)


@pytest.fixture(scope="module")
def whole(root):
    return ct.PoseChecker(root, sensor="iso:0.001")(table())


def test_rows_are_what_queries_answer(root, whole):
    scene = ct.Cloud.read(root / "floor2.xyz", sensor="iso:0.001", refined=True)
    for row in np.flatnonzero((whole["scene"] == "floor2.xyz") & (whole["object"] == "table.obj")):
        report = ct.Query().run(scene, ct.Mesh.read(root / "table.obj"), whole["pose"][row])
        assert (report.probability, report.verdict) == (whole["probability"][row], whole["verdict"][row])
    assert set(whole["verdict"]) == {"free", "uncertain", "in_collision"} and not any(whole["error"])
    assert whole["id"].tolist() == list(range(20))


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(order=st.permutations(range(20)), cuts=st.sets(st.integers(1, 19), max_size=4), keep=st.integers(1, 3))
def test_any_partition_has_the_same_bits(root, whole, order, cuts, keep):
    checker = ct.PoseChecker(root, sensor="iso:0.001", keep=keep)
    for places in np.split(np.array(order), sorted(cuts)):
        assert_same(checker(taken(table(), places)), taken(whole, places))


def test_a_scene_that_is_a_mesh_is_one_in_a_ply_too(tmp_path):
    """It was the cloud of its vertices, and free between them."""
    corners = "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n"
    header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "table.ply").write_text(header + faces + corners + "3 0 1 2\n3 0 2 3\n")
    write_points(tmp_path / "plate.xyz", sheet(seed=3))
    aslant = lifted(-0.1)
    aslant[1:3, 1:3] = [[0.6, -0.8], [0.8, 0.6]]
    row = {"scene": ["table.ply"], "object": ["plate.xyz"], "pose": [aslant]}
    answer = ct.PoseChecker(tmp_path, sensor="iso:0.001")(row)
    assert list(answer["verdict"]) == ["in_collision"], answer


def test_a_poisoned_row_is_an_error_in_its_place(root, whole):
    rows = table()
    poses: list = [pose.tolist() for pose in rows["pose"]]
    poses[3], poses[7], poses[11] = "none", [1.0, 2.0], np.diag([2.0, 1.0, 1.0, 1.0]).tolist()
    rows["pose"] = np.empty(20, dtype=object)
    rows["pose"][:] = poses
    rows["scene"] = rows["scene"].astype(object)
    rows["scene"][15] = "gone.xyz"
    rows["object"] = rows["object"].astype(object)
    rows["object"][18] = "bad.obj"
    (root / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    answers = ct.PoseChecker(root, sensor="iso:0.001")(rows)
    bad = [3, 7, 11, 15, 18]
    assert set(answers["verdict"][bad]) == {"error"} and np.isnan(answers["probability"][bad]).all()
    assert answers["error"][3] == answers["error"][7] and "pose is not 16 numbers" in answers["error"][3]
    assert "rotation" in answers["error"][11] and "gone.xyz" in answers["error"][15]
    assert "bad.obj: line 2" in answers["error"][18] and not answers["error"][11].startswith("poses[")
    good = np.setdiff1d(np.arange(20), bad)
    assert_same(taken({n: c for n, c in answers.items() if n != "pose"}, good), taken({n: c for n, c in whole.items() if n != "pose"}, good))


@pytest.mark.parametrize("name", ["scene", "object"])
@pytest.mark.parametrize("nothing", [None, float("nan"), ""])
def test_a_row_without_a_path_was_told_of_a_file_called_nan(root, name, nothing):
    rows = table()
    rows[name] = rows[name].astype(object)
    rows[name][4] = nothing
    answers = ct.PoseChecker(root, sensor="iso:0.001")(rows)
    assert answers["verdict"][4] == "error" and answers["error"][4].startswith(f"{name} is missing: ")
    assert (answers["verdict"] == "error").sum() == 1


def test_columns_of_no_rows_were_numbers(root):
    pandas = pytest.importorskip("pandas")
    rows = pandas.DataFrame({name: list(column) for name, column in table().items()})
    checker = ct.PoseChecker(root, sensor="iso:0.001")
    none, some = checker(rows.iloc[:0]), checker(rows.iloc[:2])
    assert len(none) == 0 and none.dtypes.to_dict() == some.dtypes.to_dict()


@pytest.mark.parametrize("bad", [None, "none", [1.0] * 15, [[1.0, 0.0], [0.0]], 3.0])
def test_a_pose_that_is_none_among_lists_costs_no_other_row_its_answer(root, whole, bad):
    rows: dict = {name: column.tolist() for name, column in table().items()}
    rows["pose"][4] = bad
    rows["note"] = [[1], None] + [[1, 2, 3]] * 18
    answers = ct.PoseChecker(root, sensor="iso:0.001")(rows)
    assert answers["verdict"][4] == "error" and "pose is not 16 numbers" in answers["error"][4]
    assert answers["pose"].shape == (20,) and answers["pose"][4] == bad and answers["pose"][3] == rows["pose"][3]
    assert answers["note"].tolist() == rows["note"]
    good = np.setdiff1d(np.arange(20), [4])
    handed_on = {"pose", "note"}
    answered = {name: column for name, column in answers.items() if name not in handed_on}
    assert_same(taken(answered, good), taken({n: c for n, c in whole.items() if n not in handed_on}, good))


def test_lists_give_the_columns_that_arrays_give(root, whole):
    rows: dict = {name: column.tolist() for name, column in table().items()}
    assert_same(ct.PoseChecker(root, sensor="iso:0.001")(rows), whole)


def test_it_goes_to_workers(root, whole):
    checker = ct.PoseChecker(root, sensor="iso:0.001", query={"prior": 0.5})
    checker(taken(table(), np.arange(2)))
    assert repr(checker) == f"<PoseChecker: files in {root}, sensors 'iso:0.001' and 'iso:0.001', {ct.Query(prior=0.5)!r}>"
    assert_same(pickle.loads(pickle.dumps(checker))(table()), whole)


def test_an_empty_table_has_all_columns(root, whole):
    empty = ct.PoseChecker(root, sensor="iso:0.001")(taken(table(), np.arange(0)))
    assert empty.keys() == whole.keys() and {len(column) for column in empty.values()} == {0}


def test_wrong_tables_are_told(root):
    rows = table()
    with pytest.raises(ValueError, match="pose is missing"):
        ct.PoseChecker(root, sensor="exact")({name: rows[name] for name in ("scene", "object")})
    with pytest.raises(ValueError, match="columns have different lengths: .*id 3"):
        ct.PoseChecker(root, sensor="exact")({**rows, "id": np.arange(3)})
    with pytest.raises(ValueError, match="keep is 0"):
        ct.PoseChecker(root, sensor="exact", keep=0)
    with pytest.raises(ct.CloudtouchError, match="prior"):
        ct.PoseChecker(root, sensor="exact", query={"prior": 2.0})


def test_what_no_row_can_be_answered_with_was_told_in_each_row(root):
    for arguments, says in [
        ({"sensor": "sonar"}, "^sensor: unknown sensor `sonar`"),
        ({"sensor": "auto"}, "^sensor: `auto` .*cloudtouch info FILE"),
        ({"sensor": "exact", "object_sensor": "iso:-1"}, "^object_sensor: .*not negative"),
        ({"sensor": "exact", "unit": "furlong"}, '^unit: "furlong" is not a unit of length: use m'),
        ({"sensor": "exact", "cloud_unit": "M"}, '^cloud_unit: "M" is not a unit of length: use m'),
    ]:
        with pytest.raises(ct.CloudtouchError, match=says):
            ct.PoseChecker(root, **arguments)
    for given, says in [
        ([1, 2], "^root is of the type list: give the path of a folder"),
        (None, "^root is None: give the path of a folder"),
    ]:
        with pytest.raises(TypeError, match=says):
            ct.PoseChecker(given, sensor="exact")
    with pytest.raises(TypeError, match="^keep is 'all': give a whole number"):
        ct.PoseChecker(root, sensor="exact", keep="all")
    with pytest.raises(TypeError, match="^query is of the type Query: give its settings by name"):
        ct.PoseChecker(root, sensor="exact", query=ct.Query())
    with pytest.raises(TypeError, match="^sensor is 0.002: give a str"):
        ct.PoseChecker(root, sensor=0.002)
    with pytest.raises(ValueError, match="^root is .*gone: there is no such folder"):
        ct.PoseChecker(root / "gone", sensor="exact")


def test_a_batch_keeps_going_where_that_is_asked(floor, plate):
    poses = np.stack([lifted(0.03), np.full((4, 4), np.nan), lifted(0.0)])
    with pytest.raises(ct.CloudtouchError, match=r"poses\[1\]"):
        ct.Query().run_batch(floor, plate, poses)
    batch = ct.Query().run_batch(floor, plate, poses, errors="keep")
    assert batch.verdict.tolist() == ["free", "error", "uncertain"] and batch.error[1].startswith("poses[1]: ")
    with pytest.raises(ValueError, match="errors is 'ignore'"):
        ct.Query().run_batch(floor, plate, poses, errors="ignore")


def test_rows_of_a_shuffled_table_were_asked_about_the_bodies_of_others(root, whole):
    """Columns of pandas go by their labels: a frame in another order than its index had poses of other rows."""
    rows = table()
    frame = pd.DataFrame({name: list(column) for name, column in rows.items()})
    checker = ct.PoseChecker(root, sensor="iso:0.001")
    parts = [frame.sample(frac=1, random_state=1), frame[frame["id"] % 3 == 1], pd.concat([frame, frame]), frame[:0]]
    for part in parts:
        told = checker(part)
        assert isinstance(told, pd.DataFrame) and told.index.equals(part.index)
        as_columns = checker({name: part[name] for name in part})
        for name in ("probability", "lower", "verdict", "error"):
            wanted = whole[name][part["id"].to_numpy()]
            assert told[name].tolist() == as_columns[name].tolist() == wanted.tolist(), name
