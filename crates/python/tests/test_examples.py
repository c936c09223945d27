"""The examples run, and tell what the page about them says."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
FIXTURES = Path(__file__).parents[3] / "fixtures"


def test_grasps_that_are_kept_are_free(tmp_path):
    picture = tmp_path / "grasps.svg"
    arguments = ["--grasps", "400", "--svg", str(picture)]
    run = subprocess.run(
        [sys.executable, "grasp_filter.py", *arguments], cwd=EXAMPLES, capture_output=True, text=True, check=True
    )
    rows = dict(re.findall(r"^\| ([^|]+?) \| [\d.]+ \| ([\d.]+) \|", run.stdout, re.M))
    # Of those without a point inside every fourth collides: behind what the camera saw, or by its noise.
    assert float(rows["cloudtouch, verdict free"]) < 0.04 < 0.15 < float(rows["no point inside"]), run.stdout
    text = picture.read_text()
    assert "400 grasps tried" in text and text.count("<line") > 40


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--scan", str(FIXTURES / "piano-room/room.pcd"), "--sensor", "iso:0.002"], "room.pcd is no depth image: give one"),
        (["--grasps", "0"], "--grasps 0: try at least one"),
        (["--grasps", "-5"], "--grasps -5: try at least one"),
    ],
)
def test_what_no_grasp_can_be_told_of_was_an_empty_picture_or_a_traceback(tmp_path, arguments, says):
    picture = tmp_path / "grasps.svg"
    run = subprocess.run(
        [sys.executable, "grasp_filter.py", "--svg", str(picture), *arguments], cwd=EXAMPLES, capture_output=True, text=True
    )
    assert run.returncode == 2 and says in run.stderr and "Traceback" not in run.stderr, run.stderr
    assert "Warning" not in run.stderr and not picture.exists()
