"""Rows of tables whose pose is masked, or of truth values."""

import numpy as np
import pytest
from conftest import lifted, sheet
from test_files import write_points

import cloudtouch as ct


@pytest.mark.parametrize("pose", [np.ma.masked_array(lifted(0.1), mask=True), np.eye(4, dtype=bool)])
def test_what_is_under_a_mask_was_the_pose_of_a_row(tmp_path, pose):
    for seed, name in enumerate(("floor.xyz", "plate.xyz")):
        write_points(tmp_path / name, sheet(seed=seed))
    poses = np.empty(2, dtype=object)
    poses[:] = [pose, lifted(0.1)]
    rows = {"scene": ["floor.xyz"] * 2, "object": ["plate.xyz"] * 2, "pose": poses}
    answers = ct.PoseChecker(tmp_path, sensor="iso:0.001")(rows)
    assert list(answers["verdict"]) == ["error", "free"]
    assert answers["error"][0] == "pose is not 16 numbers: give those of a 4 x 4 matrix, row by row"
