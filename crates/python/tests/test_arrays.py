"""Whatever layout and type an array has, it is taken for its numbers, or refused by name."""

import pathlib
import types

import hypothesis.extra.numpy as arrays
import numpy as np
import pandas as pd
import pytest
from conftest import lifted, sheet
from hypothesis import given, settings
from hypothesis import strategies as st
from same import assert_same_report

import cloudtouch as ct

LAYOUTS = {
    "fortran": np.asfortranarray,
    "every other row": lambda a: np.repeat(a, 2, axis=0)[::2],
    "every other column": lambda a: np.repeat(a, 2, axis=1)[:, ::2],
    "backwards": lambda a: a[::-1].copy()[::-1],
    "big endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "unaligned": lambda a: np.frombuffer(b"." + a.tobytes(), dtype=np.uint8)[1:].view(a.dtype).reshape(a.shape),
    "list": lambda a: a.tolist(),
    "object with points": lambda a: types.SimpleNamespace(points=a),
    "fields": lambda a: np.rec.fromarrays([a[:, 1], a[:, 0], a[:, 2], a[:, 0]], names="y,x,z,intensity"),
}


def answer(cloud, other):
    return ct.Query().run(cloud, other, lifted(0.012))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_layouts_change_nothing(layout, dtype, plate):
    points = sheet(seed=3).astype(dtype)
    plain = ct.Cloud(np.array(points, dtype=np.float64), sensor="iso:0.001")
    cloud = ct.Cloud(LAYOUTS[layout](points), sensor="iso:0.001")
    np.testing.assert_array_equal(cloud.points, plain.points)
    assert_same_report(answer(cloud, plate), answer(plain, plate))


def test_files_meshes_and_half_precision_are_refused_with_what_to_give():
    points = sheet(seed=3)
    faces = np.arange(len(points) // 3 * 3).reshape(-1, 3)
    of_trimesh = types.SimpleNamespace(vertices=points)
    for source, error, says in [
        ("scan.pcd", TypeError, "points is 'scan.pcd', the name of a file: give arrays, or call Cloud.read('scan.pcd'"),
        (pathlib.Path("scan.pcd"), TypeError, "call Cloud.read('scan.pcd', sensor=...)"),
        (of_trimesh, TypeError, "points is of the type SimpleNamespace: give its .vertices"),
        (points.astype(np.float16), ValueError, "points has the type float16, of three digits"),
    ]:
        with pytest.raises(error) as refused:
            ct.Cloud(source, sensor="iso:0.001")
        assert says in str(refused.value)
    with pytest.raises(TypeError, match=r"vertices is 'a.stl', the name of a file.* Mesh.read\('a.stl'\)"):
        ct.Mesh("a.stl")
    with pytest.raises(ValueError, match="vertices has the type float16"):
        ct.Mesh(points.astype(np.float16), faces)


def test_what_makes_no_array_was_told_in_words_of_numpy(floor, plate):
    """Neither the argument was named nor what to give."""
    ragged = [[1.0, 2, 3], [1, 2]]
    triangles = [[0, 1, 2], [0, 1]]
    for ask, says in [
        (lambda: ct.Cloud(ragged, sensor="exact"), "^points makes no array .*: give rows of equally many numbers"),
        (lambda: ct.Cloud(sheet(), sensor="exact", normals=ragged), "^normals makes no array"),
        (lambda: ct.Mesh(np.eye(3), triangles), "^triangles makes no array"),
        (lambda: ct.Query().run(floor, plate, ragged), "^pose makes no array"),
        (lambda: ct.Query().sweep(floor, plate, [np.eye(4), np.eye(3)]), "^poses makes no array"),
    ]:
        with pytest.raises(ValueError, match=says):
            ask()
    for ask, says in [
        (lambda: ct.Query().run(floor, plate, "pose.txt"), "^pose is 'pose.txt': give an array of numbers"),
        (lambda: ct.Query().run(floor, plate, None), "^pose is None: give an array of numbers"),
        (lambda: ct.Cloud(None, sensor="exact"), "^points is None"),
    ]:
        with pytest.raises(TypeError, match=says):
            ask()


def test_read_only_arrays_are_read_and_arrays_are_not_kept(plate):
    points = sheet(seed=3)
    points.flags.writeable = False
    pose = lifted(0.012)
    pose.flags.writeable = False
    cloud = ct.Cloud(points, sensor="iso:0.001", sensor_pose=np.eye(4))
    before = ct.Query().run(cloud, plate, pose)
    points.flags.writeable = True
    points[:] = 7.0
    assert_same_report(ct.Query().run(cloud, plate, pose), before)


def test_poses_of_any_layout(floor, plate):
    poses = np.stack([lifted(z) for z in (0.0, 0.01, 0.03)])
    plain = ct.Query().run_batch(floor, plate, poses)
    for other in (np.asfortranarray(poses), poses.tolist(), np.repeat(poses, 2, axis=0)[::2]):
        np.testing.assert_array_equal(ct.Query().run_batch(floor, plate, other).probability, plain.probability)


def test_a_depth_image_is_an_organised_cloud():
    rows, columns = np.mgrid[0:30, 0:40]
    z = np.full((30, 40), 1.0)
    image = np.stack([(columns - 20) * 0.01, (rows - 15) * 0.01, z], axis=-1)
    image[3, 4] = np.nan
    seen = ct.Cloud(image, sensor="kinect")
    assert seen.removed["missing"] == 1 and 3 * 40 + 4 not in seen.rows
    # A sphere behind the wall was not seen; without the layout nobody knows.
    points = np.random.default_rng(0).normal(size=(400, 3))
    ball = 0.05 * points / np.linalg.norm(points, axis=1, keepdims=True)
    hidden = ct.Query().run(seen, ct.Cloud(ball, sensor="iso:0.001"), lifted(1.5))
    assert (hidden.verdict, hidden.undecided_by) == ("undecided", "unseen")
    assert hidden.unseen == 1.0 and any("sensor saw nothing" in warning for warning in hidden.warnings)
    fields = np.zeros((30, 40), dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("rgb", "u4")])
    for axis, name in enumerate("xyz"):
        fields[name] = image[..., axis]
    assert ct.Query().run(ct.Cloud(fields, sensor="kinect"), seen, np.eye(4)).unseen is not None


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (np.zeros((4, 2)), "points has the shape (4, 2): give (N, 3)"),
        (np.zeros(3), "points has the shape (3,)"),
        (np.zeros((2, 3, 4)), "points has the shape (2, 3, 4)"),
        (np.zeros((2, 2, 2, 3)), "points has the shape (2, 2, 2, 3)"),
        (np.zeros((4, 3), dtype=complex), "points has the type complex128"),
        (np.zeros((4, 3), dtype=bool), "points has the type bool"),
        (np.array([["a", "b", "c"]]), "points has the type"),
        (np.array([[None, 1, 2]]), "points has the type object"),
        (np.ma.masked_equal(np.zeros((4, 3)), 0), "points.filled(numpy.nan)"),
        (np.zeros(4, dtype=[("x", "f4"), ("z", "f4")]), "has the fields x, z: y is missing"),
    ],
)
def test_what_is_no_cloud_is_refused_by_name(points, says):
    with pytest.raises(ValueError) as error:
        ct.Cloud(points, sensor="exact")
    assert says in str(error.value) and not isinstance(error.value, ct.CloudtouchError)


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (np.empty((0, 3)), "the cloud has no points"),
        (np.empty((0, 3), dtype=np.float32), "the cloud has no points"),
        (np.full((5, 3), np.nan), "no point is left of 5 after filtering (missing removed 5"),
        (np.full((5, 3), np.inf), "no point is left of 5"),
        (np.array([[0.0, 0.0, 1e12]]), "beyond 1e10 m"),
    ],
)
def test_the_library_says_what_is_wrong_with_the_numbers(points, says):
    with pytest.raises(ct.CloudtouchError, match=None) as error:
        ct.Cloud(points, sensor="exact")
    assert says in str(error.value)


def test_rows_of_nan_are_missing_returns(plate):
    points = sheet(seed=3)
    holes = np.insert(points, [0, 17, 400], np.nan, axis=0)
    cloud = ct.Cloud(holes, sensor="iso:0.001")
    assert cloud.removed["missing"] == 3 and len(cloud) == 400
    np.testing.assert_array_equal(holes[cloud.rows], cloud.points)
    plain = ct.Cloud(points, sensor="iso:0.001")
    assert answer(cloud, plate).probability == answer(plain, plate).probability


anything = arrays.arrays(
    dtype=st.sampled_from([np.float32, np.float64, np.int16, np.uint64, np.float16, np.bool_, np.complex64]),
    shape=arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=6),
)
few_rows = arrays.arrays(
    dtype=st.sampled_from([np.float32, np.float64]), shape=st.tuples(st.integers(0, 12), st.just(3))
)


@settings(deadline=None, max_examples=150, derandomize=True)
@given(points=anything | few_rows)
def test_any_array_makes_a_cloud_or_a_value_error(points):
    try:
        cloud = ct.Cloud(points, sensor="iso:0.01")
    except ValueError as error:
        assert len(str(error)) > 15
        return
    assert 0 < len(cloud) <= points.size // 3
    rows = points.reshape(-1, 3)[cloud.rows].astype(np.float64)
    np.testing.assert_array_equal(cloud.points, rows)
    report = ct.Query().run(cloud, cloud, np.eye(4))
    assert 0.0 <= report.lower <= report.probability <= report.upper <= 1.0


@settings(deadline=None, max_examples=150, derandomize=True)
@given(pose=anything | arrays.arrays(np.float64, (4, 4)))
def test_any_array_is_a_pose_or_a_value_error(pose, floor, plate):
    for ask in (lambda: ct.Query().run(floor, plate, pose), lambda: ct.Query().run_batch(floor, plate, [pose])):
        try:
            ask()
        except ValueError as error:
            assert "pose" in str(error)
        else:
            assert pose.shape == (4, 4) and np.isfinite(pose).all()


def test_a_pose_is_a_rigid_motion(floor, plate):
    for pose, says in [
        (2 * np.eye(4), "pose: the last row"),
        (np.diag([2.0, 1, 1, 1]), "pose: the 3x3 part of the pose is not a rotation"),
        (np.diag([-1.0, 1, 1, 1]), "mirrors"),
        (lifted(np.nan), "pose entry (2, 3) is NaN"),
        (lifted(1e11), "at most 1e10 m"),
    ]:
        with pytest.raises(ct.CloudtouchError) as error:
            ct.Query().run(floor, plate, pose)
        assert says in str(error.value)
        with pytest.raises(ct.CloudtouchError, match=r"^poses\[1\]: "):
            ct.Query().run_batch(floor, plate, [np.eye(4), pose])
    for pose in (np.eye(3), np.zeros(16), np.eye(4)[None]):
        with pytest.raises(ValueError, match=r"pose has the shape .*: give \(4, 4\)"):
            ct.Query().run(floor, plate, pose)
    with pytest.raises(ValueError, match=r"poses has the shape \(4, 4\): give \(N, 4, 4\)"):
        ct.Query().run_batch(floor, plate, np.eye(4))


def test_no_pose_is_an_empty_batch(floor, plate):
    batch = ct.Query().run_batch(floor, plate, np.empty((0, 4, 4)))
    assert len(batch) == 0 and batch.contact_point.shape == (0, 3) and batch.verdict.shape == (0,)
    assert repr(batch) == "<Batch: 0 poses>"


def test_columns_of_a_table_were_taken_by_their_places(plate):
    points = sheet(seed=5)
    xyz = pd.DataFrame(points, columns=["x", "y", "z"])
    wanted = ct.Query().run(ct.Cloud(points, sensor="iso:0.001"), plate, lifted(0.004))
    for frame in (xyz, xyz[["z", "y", "x"]], xyz.assign(intensity=1.0), pd.DataFrame(points)):
        assert_same_report(ct.Query().run(ct.Cloud(frame, sensor="iso:0.001"), plate, lifted(0.004)), wanted)
    with pytest.raises(ValueError, match="points has the fields X, y, z: x is missing"):
        ct.Cloud(xyz.rename(columns={"x": "X"}), sensor="iso:0.001")
