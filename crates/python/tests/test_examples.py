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
        (["--scan", "gone.pcd"], "gone.pcd: cannot be read"),
        (["--scan", str(FIXTURES / "piano-room/room.pcd"), "--sensor", "knect"], "unknown sensor `knect`"),
        (["--grasps", "9", "--svg", "no/such/folder/grasps.svg"], "--svg no/such/folder/grasps.svg: there is no such folder"),
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


def test_a_scan_that_no_grasp_reaches_is_told_so(tmp_path):
    """Three metres off, or in millimetres, there was a traceback of what chooses the points."""
    rows = [f"{(u - 19.5) / 40 * 3:.4f} {(v - 14.5) / 40 * 3:.4f} 3" for v in range(30) for u in range(40)]
    head = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 40\nHEIGHT 30\nPOINTS 1200\nDATA ascii\n"
    (tmp_path / "far.pcd").write_text(head + "\n".join(rows) + "\n")
    arguments = ["--scan", str(tmp_path / "far.pcd"), "--sensor", "iso:0.01", "--grasps", "9"]
    run = subprocess.run([sys.executable, "grasp_filter.py", *arguments], cwd=EXAMPLES, capture_output=True, text=True)
    assert run.returncode == 2 and "no point nearer to its camera than 1.1 m" in run.stderr, run.stderr
