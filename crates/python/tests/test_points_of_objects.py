"""Objects with ``.points``: clouds, and meshes whose points are their vertices."""

import types

import numpy as np
import pytest
from cloudtouch.demo import table_top
from conftest import lifted, sheet

import cloudtouch as ct


@pytest.mark.parametrize("name", ["faces", "triangles", "cells"])
def test_the_points_of_a_mesh_were_taken_for_a_cloud(name, parcel):
    """As pyvista and meshio have them: a cloud of few vertices, with nothing between them, through which all passes."""
    vertices, triangles = table_top()
    mesh = types.SimpleNamespace(points=vertices, **{name: triangles})
    with pytest.raises(TypeError, match=f"SimpleNamespace, which has .{name}: give its .points .* or Mesh"):
        ct.Cloud(mesh, sensor="iso:0.001")
    assert ct.Query().run(ct.Mesh(vertices, triangles), parcel, lifted(0.0)).verdict == "in_collision"


@pytest.mark.parametrize("none", [None, [], np.empty((0, 3), dtype=int), lambda: 3])
def test_a_cloud_without_faces_is_taken(none):
    points = sheet()
    cloud = ct.Cloud(types.SimpleNamespace(points=points, faces=none), sensor="iso:0.001")
    np.testing.assert_array_equal(cloud.points, points)


def test_what_gives_points_one_by_one_is_told_how():
    with pytest.raises(TypeError, match=r"points is of the type generator.*list\(points\)"):
        ct.Cloud((point for point in sheet()), sensor="iso:0.001")
    # What goes through an array knows that array.
    ct.Cloud.from_depth(np.full((4, 4), 0.8), np.array([[4, 4], [1.5, 1.5]]).flat, sensor="iso:0.001")


def test_a_tensor_that_gives_no_array_is_told_by_the_name_of_the_argument():
    """As of torch: one that needs a gradient raises what was no error of an argument."""

    class Tensor:
        def __array__(self, *_, **__):
            raise RuntimeError("Can't call numpy() on Tensor that requires grad. Use tensor.detach().numpy() instead.")

    with pytest.raises(ValueError, match=r"points makes no array .*detach\(\)"):
        ct.Cloud(Tensor(), sensor="iso:0.001")


def test_no_poses_as_a_list_are_no_answers(floor, plate):
    query = ct.Query()
    assert len(query.run_batch(floor, plate, [])) == 0 and query.are_free(floor, plate, []).shape == (0,)
    with pytest.raises(ValueError, match="no points"):
        ct.Cloud([], sensor="iso:0.001")
