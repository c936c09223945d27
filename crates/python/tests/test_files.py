"""Files are read as the command-line tool reads them."""

import numpy as np
import pytest
from cloudtouch.demo import table_top
from conftest import lifted, sheet
from same import assert_same_report

import cloudtouch as ct


def write_points(path, points):
    path.write_text("".join(" ".join(repr(float(v)) for v in point) + "\n" for point in points))


def write_table(path, factor=1.0):
    vertices, triangles = table_top()
    lines = ["v " + " ".join(repr(factor * v) for v in vertex) for vertex in vertices.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in triangle) for triangle in triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")


def write_image(path, points, viewpoint):
    height, width = points.shape[:2]
    head = f"FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH {width}\nHEIGHT {height}\nVIEWPOINT {viewpoint}\n"
    head += f"POINTS {height * width}\nDATA ascii\n"
    rows = "".join(" ".join(repr(float(v)) for v in point) + "\n" for point in points.reshape(-1, 3))
    path.write_text(head + rows)


def test_a_cloud_of_a_file_is_that_of_its_points(tmp_path, plate):
    points = sheet(seed=1)
    write_points(tmp_path / "floor.xyz", points)
    write_points(tmp_path / "floor_mm.xyz", 1000 * points)
    given = ct.Query().run(ct.Cloud(points, sensor="iso:0.001"), plate, lifted(0.004))
    read = ct.Cloud.read(tmp_path / "floor.xyz", sensor="iso:0.001")
    assert_same_report(ct.Query().run(read, plate, lifted(0.004)), given)
    scaled = ct.Cloud.read(str(tmp_path / "floor_mm.xyz"), sensor="iso:0.001", unit="mm", refined=True)
    assert abs(ct.Query().run(scaled, plate, lifted(0.004)).probability - given.probability) < 1e-9


def test_an_image_and_its_viewpoint_are_kept(tmp_path, table):
    image = sheet(z=1.0).reshape(20, 20, 3)
    image[:, :, :2] -= 0.1
    image[5:15, 5:15] = np.nan
    write_image(tmp_path / "image.pcd", image, "0 0 0 1 0 0 0")
    report = ct.Query().run(ct.Cloud.read(tmp_path / "image.pcd", sensor="kinect"), table, lifted(0.5))
    assert report.undecided_by == "unseen"
    # From the other side all of it is behind the camera.
    write_image(tmp_path / "turned.pcd", image, "0 0 2 0 1 0 0")
    turned = ct.Cloud.read(tmp_path / "turned.pcd", sensor="kinect")
    stated = ct.Cloud.read(tmp_path / "image.pcd", sensor="kinect", sensor_pose=np.diag([1.0, -1, -1, 1]) + lifted(2.0) - np.eye(4))
    for pose in (lifted(0.5), lifted(1.5)):
        assert_same_report(ct.Query().run(turned, table, pose), ct.Query().run(stated, table, pose))


def test_a_mesh_of_a_file_is_that_of_its_triangles(tmp_path, table, plate):
    write_table(tmp_path / "table.obj")
    write_table(tmp_path / "table_mm.obj", 1000)
    given = ct.Query().run(plate, table, lifted(-0.001))
    assert_same_report(ct.Query().run(plate, ct.Mesh.read(tmp_path / "table.obj"), lifted(-0.001)), given)
    scaled = ct.Mesh.read(tmp_path / "table_mm.obj", unit="mm")
    assert abs(ct.Query().run(plate, scaled, lifted(-0.001)).probability - given.probability) < 1e-9


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("none.pcd", None, "none.pcd"),
        ("scan.las", "", ".pcd"),
        ("bad.xyz", "1 2 3\n1 abc 3\n", "bad.xyz: line 2"),
        ("run.mcap", "", "run.mcap: is a recording"),
    ],
)
def test_bad_files_are_named(tmp_path, name, text, words):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(ct.CloudtouchError) as error:
        ct.Cloud.read(tmp_path / name, sensor="iso:0.001")
    assert words in str(error.value)


def test_units_are_known(tmp_path):
    with pytest.raises(ct.CloudtouchError, match="km.*is not a unit of length: use m, cm, mm or in"):
        ct.Mesh.read(tmp_path / "any.stl", unit="km")


def test_what_a_file_holds_is_refused_by_its_name(tmp_path):
    (tmp_path / "empty.xyz").write_text("nan nan nan\n" * 20)
    with pytest.raises(ct.CloudtouchError, match=r"empty\.xyz: "):
        ct.Cloud.read(tmp_path / "empty.xyz", sensor="iso:0.001")
    # Between its vertices it read free.
    corners = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "part.ply").write_text(header + faces + corners)
    with pytest.raises(ct.CloudtouchError, match=r"part\.ply: .*read it as a mesh"):
        ct.Cloud.read(tmp_path / "part.ply", sensor="iso:0.001")
    assert len(ct.Mesh.read(tmp_path / "part.ply")) == 1
