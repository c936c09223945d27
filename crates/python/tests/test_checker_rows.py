"""Rows of which not all is known, and tables that are none: neither is answered by a guess."""

import numpy as np
import pandas as pd
import pytest
from conftest import lifted
from test_checker import root, table

import cloudtouch as ct

#: A fixture of another file.
__all__ = ["root"]


@pytest.fixture
def checker(root):
    return ct.PoseChecker(root, sensor="iso:0.001")


def one(pose):
    return {"scene": ["floor1.xyz"], "object": ["plate.xyz"], "pose": pose}


def test_what_lies_under_a_mask_was_taken_for_the_pose(checker):
    pose = lifted(0.03)
    assert checker(one([pose]))["verdict"].tolist() == ["free"]
    mask = np.zeros((4, 4), dtype=bool)
    mask[2, 3] = True
    masked = np.ma.masked_array(pose, mask=mask)
    frame = pd.DataFrame({"scene": ["floor1.xyz"], "object": ["plate.xyz"], "pose": pd.Series([masked])})
    for rows in (one([masked]), one(np.ma.stack([masked])), frame):
        told = checker(rows)
        assert list(told["verdict"]) == ["error"] and "16 numbers" in told["error"][0]
    # Nothing is missing where a mask hides nothing.
    assert checker(one(np.ma.masked_array([pose])))["verdict"].tolist() == ["free"]


@pytest.mark.parametrize("pose", [np.ma.masked_array(lifted(0.1), mask=True), np.eye(4, dtype=bool)])
def test_a_pose_that_is_none_beside_one_that_is(checker, pose):
    """What is under a mask was the pose of its row, and truth values were numbers."""
    poses = np.empty(2, dtype=object)
    poses[:] = [pose, lifted(0.1)]
    answers = checker({"scene": ["floor1.xyz"] * 2, "object": ["plate.xyz"] * 2, "pose": poses})
    assert list(answers["verdict"]) == ["error", "free"]
    assert answers["error"][0] == "pose is not 16 numbers: give those of a 4 x 4 matrix, row by row"


def test_a_mask_stays_with_a_column_that_is_handed_on(checker):
    weight = np.ma.masked_array([1.0], mask=[True])
    assert checker({**one([lifted(0.03)]), "weight": weight})["weight"] is weight
    hidden = {**one([lifted(0.03)]), "scene": np.ma.masked_array(["floor1.xyz"], mask=[True])}
    assert checker(hidden)["error"][0].startswith("scene is missing")


def test_the_imaginary_part_of_a_pose_was_dropped(checker):
    told = checker(one([lifted(0.03) + 0.5j]))
    assert told["verdict"].tolist() == ["error"] and "16 numbers" in told["error"][0]


def test_of_two_columns_of_one_name_the_last_was_asked_about(checker):
    rows = [["floor1.xyz", "floor2.xyz", "plate.xyz", lifted(0.03)]]
    frame = pd.DataFrame(rows, columns=["scene", "scene", "object", "pose"])
    with pytest.raises(ValueError, match="scene is there twice"):
        checker(frame)
    # Others may be: they are handed on.
    frame.columns = ["scene", "note", "object", "pose"]
    frame = pd.concat([frame, frame[["note"]]], axis=1)
    assert checker(frame)["verdict"].tolist() == ["free"]


@pytest.mark.parametrize("module", ["pyarrow", "polars"])
def test_a_table_of_another_library_is_refused_with_what_to_do(checker, module):
    library = pytest.importorskip(module, reason=f"{module} is not installed")
    rows = {name: column[:1].tolist() for name, column in table().items()}
    make = library.table if module == "pyarrow" else library.DataFrame
    with pytest.raises(TypeError, match=rf"rows is a {module}.*give columns by their names.*to_(py)?dict\(\)"):
        checker(make(rows))


def test_a_pose_that_is_text_says_who_makes_text_of_it(checker):
    told = checker(one([str(lifted(0.03).ravel().tolist())]))
    assert told["verdict"].tolist() == ["error"] and "dataframe.convert-string" in told["error"][0]


def test_rows_in_memory_and_in_parquet_by_the_partitions_of_dask(checker, tmp_path):
    dask = pytest.importorskip("dask", reason="dask is not installed: pip install 'dask[dataframe]'")
    frames = pytest.importorskip("dask.dataframe", reason="dask is not installed: pip install 'dask[dataframe]'")
    rows = {name: list(column) for name, column in table().items()}
    frame = pd.DataFrame({**rows, "pose": [pose.ravel().tolist() for pose in rows["pose"]]})
    wanted, meta = checker(frame), checker(frame[:0])
    with dask.config.set({"dataframe.convert-string": False}):
        in_memory = frames.from_pandas(frame, npartitions=5).map_partitions(checker, meta=meta)
    frame.to_parquet(tmp_path / "poses.parquet")
    read = frames.read_parquet(tmp_path / "poses.parquet").map_partitions(checker, meta=meta)
    for part in (in_memory, read):
        told = part.compute(scheduler="threads")
        assert told["probability"].tolist() == wanted["probability"].tolist()
        assert told["verdict"].tolist() == wanted["verdict"].tolist()
