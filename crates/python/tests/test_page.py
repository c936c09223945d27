"""Pages of answers."""

import numpy as np
import pytest
from conftest import lifted

import cloudtouch as ct


def test_a_page_says_what_a_report_says(tmp_path, floor, table):
    page = ct.Query().page(floor, table, [lifted(z) for z in (0.1, 0.0)], title="a <b> & c")
    page.save(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert text == page.html and text.startswith("<!DOCTYPE html>")
    assert "a &lt;b&gt; &amp; c" in text and "<b> & c" not in text
    assert "free" in text and "pose 1" in text
    frame = page._repr_html_()
    assert frame.startswith("<iframe") and "480" in frame


def test_poses_were_counted_from_0_under_a_slider_that_counts_from_1(floor, table):
    text = ct.Query().page(floor, table, [lifted(z) for z in (0.1, 0.0)]).html
    assert "pose 1" in text and "pose 2" in text and "pose 0" not in text


def test_one_pose_is_a_page_too(floor, table):
    assert "pose 1" in ct.Query().page(floor, table, lifted(0.1)).html


def test_a_page_did_not_say_what_the_bodies_were_taken_for(floor, table):
    text = ct.Query().page(floor, table, lifted(0.1)).html
    assert "cloud of 400 points in m, sensor iso:0.001 (missing removed 0, duplicates removed 0)" in text
    assert f"watertight mesh of {len(table)} triangles in m, " in text and " m across" in text


def test_a_page_of_a_scene_shows_the_pair_that_collides(floor, table):
    scene = ct.Scene()
    scene.add("floor", floor)
    scene.add("table", table, lifted(0.01))
    scene.add("<lamp>", table, lifted(3.0))
    text = scene.page(ct.Query(), title="a scene").html
    assert "All in all: in collision" in text and "table / floor" in text
    assert "&lt;lamp&gt;" in text and "<lamp>" not in text.split("<script")[0]
    assert "cloud of 400 points in m (missing removed 0" in text
    scene.set_pose("table", lifted(1.0))
    assert "All in all: free" in scene.page(ct.Query()).frame(300)


def test_a_page_that_cannot_be_written_named_a_file_that_nobody_asked_for(tmp_path, floor, table):
    page = ct.Query().page(floor, table, lifted(0.1))
    (tmp_path / "folder.html").mkdir()
    (tmp_path / "file").write_text("")
    for place, kind in [
        ("gone/page.html", FileNotFoundError),
        ("folder.html", IsADirectoryError),
        ("file/page.html", NotADirectoryError),
    ]:
        with pytest.raises(kind) as error:
            page.save(tmp_path / place)
        assert error.value.filename == str(tmp_path / place) and ".partial" not in str(error.value)
    assert sorted(found.name for found in tmp_path.iterdir()) == ["file", "folder.html"]
    with pytest.raises(TypeError, match="^path is 5: give the name of a file"):
        page.save(5)


def test_poses_of_a_page(floor, table):
    with pytest.raises(ValueError, match="poses has the shape"):
        ct.Query().page(floor, table, np.eye(3))
    with pytest.raises(ct.CloudtouchError, match="poses are 0: a page shows 1 to 500"):
        ct.Query().page(floor, table, np.empty((0, 4, 4))).frame()
    with pytest.raises(ct.CloudtouchError, match=r"poses\[0\]"):
        ct.Query().page(floor, table, np.full((4, 4), np.nan)).save("never.html")
