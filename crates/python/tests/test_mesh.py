"""Meshes from arrays and from the objects of other libraries."""

import types

import numpy as np
import pytest
from cloudtouch.demo import table_top
from conftest import lifted
from same import assert_same_report

import cloudtouch as ct


def test_meshes_of_other_libraries_are_taken_as_they_are(table, parcel):
    vertices, faces = table_top()
    plain = ct.Query().run(table, parcel, lifted(0.05))
    # What trimesh calls triangles are corners, (M, 3, 3).
    trimesh = types.SimpleNamespace(vertices=vertices, faces=faces, triangles=vertices[faces])
    open3d = types.SimpleNamespace(vertices=vertices.tolist(), triangles=faces.astype(np.int32).tolist())
    for source in (trimesh, open3d):
        assert_same_report(ct.Query().run(ct.Mesh(source), parcel, lifted(0.05)), plain)
    soup = ct.Mesh(vertices[faces].reshape(-1, 3).astype(np.float32), np.arange(3 * len(faces)).reshape(-1, 3))
    assert len(soup) == 12 and soup.is_watertight and soup.vertices.shape == (8, 3)


@pytest.mark.parametrize(
    ("triangles", "kind", "says"),
    [
        (np.array([[0.0, 1.0, 2.0]]), ValueError, "triangles has the type float64: give whole numbers"),
        (np.array([0, 1, 2]), ValueError, "triangles has the shape (3,)"),
        (np.array([[0, 1, -2]]), ValueError, "indices from -2 to 1"),
        (np.array([[0, 1, 2**40]]), ValueError, "indices from 0 to 1099511627776"),
        (np.array([[0, 1, 8]]), ct.CloudtouchError, "triangle 0 names vertex 8, but there are only 8"),
        ([], ct.CloudtouchError, "the mesh has no triangles"),
        (np.array([[1, 1, 1]]), ct.CloudtouchError, "no triangle has an area, of 1"),
        (np.array([[0, 1, 1], [2, 2, 3]]), ct.CloudtouchError, "no triangle has an area, of 2"),
    ],
)
def test_bad_triangles_are_refused(triangles, kind, says):
    with pytest.raises(kind) as error:
        ct.Mesh(table_top()[0], triangles)
    assert says in str(error.value) and type(error.value) is kind


def test_a_vertex_of_nan_and_an_object_that_is_no_mesh_are_refused():
    vertices, triangles = table_top()
    vertices[3, 1] = np.nan
    with pytest.raises(ct.CloudtouchError, match="vertex 3 has the coordinate NaN"):
        ct.Mesh(vertices, triangles)
    with pytest.raises(TypeError, match="list has no .vertices"):
        ct.Mesh([1, 2, 3])


def test_two_meshes_are_exact(table):
    apart = ct.Query().run(table, table, lifted(0.2))
    assert (apart.probability, apart.verdict, apart.evidence) == (0.0, "free", None)
    assert apart.clearance == pytest.approx(0.17, abs=1e-9) and apart.clearance_std == 0.0
    assert ct.Query().run(table, table, lifted(0.01)).probability == 1.0
