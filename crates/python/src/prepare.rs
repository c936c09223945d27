//! Bodies made of arrays.

use cloudtouch::geom::{MeshError, TriangleMesh};
use cloudtouch::{Cloud, Mesh, PrepareError};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::Rows;
use crate::body::{Body, CloudArguments, Given};
use crate::error::refused;
use crate::pool::on_all_threads;

/// A cloud, ready to be queried.
#[pyfunction]
#[pyo3(signature = (points, arguments, /))]
pub(crate) fn cloud(
    py: Python<'_>,
    points: Rows<'_>,
    arguments: CloudArguments<'_>,
) -> PyResult<Body> {
    let settings = arguments.settings(py)?;
    let given = arguments.cloud(points.points())?;
    let refined = arguments.refined;
    let prepared = on_all_threads(py, || {
        let cloud = Cloud::prepare(&given, &settings)?;
        if refined { cloud.refined() } else { Ok(cloud) }
    })?;
    Ok(Body::new(prepared.map_err(refused)?, Given::Cloud(given)))
}

/// A mesh, ready to be queried. The indices are from 0 to what 32 bits hold.
#[pyfunction]
#[pyo3(signature = (vertices, triangles, /))]
pub(crate) fn mesh(
    py: Python<'_>,
    vertices: Rows<'_>,
    triangles: PyReadonlyArray2<'_, u32>,
) -> PyResult<Body> {
    let indices = triangles.as_array();
    let triangles = indices.rows().into_iter().map(|t| [t[0], t[1], t[2]]).collect();
    let given = TriangleMesh::new(vertices.points(), triangles).map_err(refused)?;
    let prepared = on_all_threads(py, || Mesh::prepare(&given))?.map_err(|error| match error {
        // There are triangles, or they would not have been taken.
        PrepareError::Mesh(MeshError::Empty) => refused(format_args!(
            "no triangle has an area, of {}: two corners of each are in one place",
            given.triangles().len()
        )),
        other => refused(other),
    })?;
    Ok(Body::new(prepared, Given::Mesh(given)))
}
