"""Depth images as cameras store them become the clouds that their points would be."""

import numpy as np
import pytest
from conftest import lifted
from same import assert_same_report

import cloudtouch as ct

HEIGHT, WIDTH = 48, 64
CAMERA = (60.0, 62.0, 31.5, 23.5)
MATRIX = [[60.0, 0, 31.5], [0, 62.0, 23.5], [0, 0, 1]]


def steps():
    """A wall at 0.8 m with a box before it, and a hole."""
    depth = np.full((HEIGHT, WIDTH), 800, dtype=np.uint16)
    depth[10:30, 20:40] = 600
    depth[40:45, 5:15] = 0
    depth[0, 0] = 65535
    return depth


def as_points(depth):
    z = np.where((depth == 0) | (depth == 65535), np.nan, 0.001 * depth.astype(float))
    rows, columns = np.indices(depth.shape)
    return np.stack([(columns - 31.5) / 60 * z, (rows - 23.5) / 62 * z, z], axis=-1)


def at(z):
    """In the middle of the view."""
    pose = lifted(z)
    pose[:2, 3] = -0.1
    return pose


def ask(cloud, plate, z):
    return ct.Query().run(cloud, plate, at(z))


def test_steps_and_metres_are_the_cloud_of_their_points(plate):
    given = ct.Cloud(as_points(steps()), sensor="kinect", sensor_pose=np.eye(4))
    metres = 0.001 * steps().astype(float)
    metres[0, 0] = np.inf
    finer = 5 * steps().astype(np.int32)
    finer[0, 0] = 65535
    for seen in (
        ct.Cloud.from_depth(steps(), CAMERA, sensor="kinect"),
        ct.Cloud.from_depth(steps().astype(">u2")[:, :, None], MATRIX, sensor="kinect"),
        ct.Cloud.from_depth(finer, MATRIX, sensor="kinect", depth_scale=0.0002),
        ct.Cloud.from_depth(metres, MATRIX, sensor="kinect"),
    ):
        assert len(seen) == HEIGHT * WIDTH - 51
        np.testing.assert_allclose(seen.points, given.points, atol=1e-15)
        for z in (0.4, 0.6, 0.7):
            report, wanted = ask(seen, plate, z), ask(given, plate, z)
            assert (report.verdict, report.undecided_by) == (wanted.verdict, wanted.undecided_by)
            assert abs(report.probability - wanted.probability) < 1e-9
    assert_same_report(ask(ct.Cloud.from_depth(steps(), CAMERA, sensor="kinect"), plate, 0.6), ask(given, plate, 0.6))


def test_what_is_behind_a_surface_was_not_seen(plate):
    seen = ct.Cloud.from_depth(steps(), CAMERA, sensor="kinect")
    assert ask(seen, plate, 0.3).verdict == "free"
    assert ask(seen, plate, 1.1).undecided_by == "unseen"


def test_a_pose_puts_the_camera_and_what_it_saw(plate):
    """Looking down from a metre."""
    world_from_camera = np.diag([1.0, -1, -1, 1])
    world_from_camera[2, 3] = 1.0
    there = ct.Cloud.from_depth(steps(), CAMERA, sensor="kinect", sensor_pose=world_from_camera)
    here = ct.Cloud.from_depth(steps(), CAMERA, sensor="kinect")
    assert there.points[:, 2].max() == pytest.approx(0.4)
    assert ask(there, plate, 0.6).verdict == "free"
    for z in (0.19, 0.2, 0.05):
        moved = ct.Query().run(here, plate, np.linalg.inv(world_from_camera) @ at(z))
        report = ask(there, plate, z)
        assert (report.verdict, report.undecided_by) == (moved.verdict, moved.undecided_by)
        assert report.probability == pytest.approx(moved.probability, abs=1e-3)


@pytest.mark.parametrize(
    ("depth", "intrinsics", "scale", "message"),
    [
        (np.zeros((4, 5, 3), np.uint8), CAMERA, None, "a depth for each pixel"),
        (np.zeros((4, 5), np.uint8), CAMERA, None, "uint8"),
        (np.ones((4, 5), np.float16), CAMERA, None, "float16"),
        (np.ones((4, 5), bool), CAMERA, None, "bool"),
        (np.ones((4, 5)), CAMERA, 0.001, "leave it out"),
        (np.ma.masked_equal(steps(), 0), CAMERA, None, "filled"),
        (steps(), (60.0, 60.0, 30.0), None, r"shape \(3,\)"),
        (steps(), np.transpose(MATRIX), None, "row by row"),
        (steps(), [[60.0, 2, 31], [0, 60, 23], [0, 0, 1]], None, "skew"),
        (steps(), (0.0, 60.0, 31.5, 23.5), None, "fx is 0"),
        (steps(), (60.0, np.nan, 31.5, 23.5), None, "fy is NaN"),
        (steps(), (600.0, 600.0, 320.0, 240.0), None, "cx is 320"),
        (steps(), CAMERA, 5000, "0.0002 for 5000"),
        (np.zeros((48, 64), np.uint16), CAMERA, None, "no"),
    ],
)
def test_what_is_no_depth_image_is_refused(depth, intrinsics, scale, message):
    with pytest.raises(ValueError, match=message):
        ct.Cloud.from_depth(depth, intrinsics, sensor="kinect", depth_scale=scale)


def test_files_in_the_place_of_arrays_are_named():
    for depth, intrinsics, scale, message in [
        (steps(), "cam.json", None, r"^intrinsics is 'cam.json': give the numbers, \(fx, fy, cx, cy\)"),
        (steps(), None, None, "^intrinsics is None"),
        ("depth.png", CAMERA, None, r"^depth is 'depth.png', the name of a file: .* cv2.imread\('depth.png'"),
        (steps(), CAMERA, "0.001", "^depth_scale is '0.001': give a number"),
    ]:
        with pytest.raises(TypeError, match=message):
            ct.Cloud.from_depth(depth, intrinsics, sensor="kinect", depth_scale=scale)
    with pytest.raises(ValueError, match="^intrinsics has the type <U2: give numbers"):
        ct.Cloud.from_depth(steps(), ["60", "60", "31", "23"], sensor="kinect")


def test_a_file_of_a_depth_image_is_told_how_to_be_read(tmp_path):
    (tmp_path / "depth.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(ct.CloudtouchError, match="from_depth"):
        ct.Cloud.read(tmp_path / "depth.png", sensor="kinect")
    with pytest.raises(ct.CloudtouchError, match="from_depth"):
        ct.Cloud.read(bytes(tmp_path / "depth.png"), sensor="kinect")


def test_intrinsics_in_another_order_are_warned_of():
    depth = np.full((240, 320), 0.8)
    with pytest.warns(UserWarning, match=r"principal point \(285, 119.5\).* in this order"):
        ct.Cloud.from_depth(depth, (285, 159.5, 285, 119.5), sensor="iso:0.002")
