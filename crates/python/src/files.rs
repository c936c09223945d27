//! Files, read as the command-line tool reads them.

use std::path::PathBuf;

use cloudtouch::geom::{Covariance, PointCloud};
use cloudtouch_io::{
    DepthCamera, LengthUnit, ReadLimits, read_cloud_within, read_mesh, scaled_cloud,
};
use numpy::ndarray::Array3;
use numpy::{IntoPyArray, PyArray2, PyArray3};
use pyo3::prelude::*;

use crate::arrays::of_pose;
use crate::error::{refused, refused_for};
use crate::rows::{corners, rows};

type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Rows (N, 3), the width and height of an image, the pose of the sensor and covariances.
type CloudRead<'py> =
    (Matrix<'py>, Option<(usize, usize)>, Option<Matrix<'py>>, Option<Bound<'py, PyArray3<f64>>>);

/// What a file holds of a cloud, in metres.
#[pyfunction]
#[pyo3(signature = (path, unit, /))]
pub(crate) fn read_cloud<'py>(
    py: Python<'py>,
    path: PathBuf,
    unit: &str,
) -> PyResult<CloudRead<'py>> {
    let factor = unit.parse::<LengthUnit>().map_err(refused)?.in_metres();
    let read = py.detach(|| read_cloud_within(path, &ReadLimits::default()));
    let cloud: PointCloud = scaled_cloud(read.map_err(refused)?, factor);
    let pose = cloud.sensor_pose.map(|pose| of_pose(py, &pose));
    let covariances = cloud.covariances.as_deref().map(|all| matrices(all).into_pyarray(py));
    Ok((rows(py, &cloud.points), cloud.image_size, pose, covariances))
}

/// Refuses what is no unit of length, by the name of the argument.
#[pyfunction]
#[pyo3(signature = (unit, name, /))]
pub(crate) fn check_unit(unit: &str, name: &str) -> PyResult<()> {
    unit.parse::<LengthUnit>().map(|_| ()).map_err(|error| refused_for(name, error))
}

fn matrices(covariances: &[Covariance]) -> Array3<f64> {
    let all: Vec<_> = covariances.iter().map(Covariance::matrix).collect();
    Array3::from_shape_fn((all.len(), 3, 3), |(i, row, column)| all[i][(row, column)])
}

/// Refuses what is no camera of an image of so many columns and rows, and tells what may be another's.
#[pyfunction]
#[pyo3(signature = (intrinsics, depth_scale, image_size, /))]
pub(crate) fn check_camera(
    intrinsics: [f64; 4],
    depth_scale: f64,
    image_size: (usize, usize),
) -> PyResult<Option<String>> {
    let [fx, fy, cx, cy] = intrinsics;
    let camera = DepthCamera { depth_scale, ..DepthCamera::new(fx, fy, cx, cy) };
    let (width, height) = image_size;
    camera.validate_for(width, height).map_err(refused)?;
    Ok(camera.doubt_for(width, height).map(|doubt| doubt.to_string()))
}

/// Vertices and triangles of a file, in metres.
#[pyfunction]
#[pyo3(name = "read_mesh", signature = (path, unit, /))]
pub(crate) fn read_faces<'py>(
    py: Python<'py>,
    path: PathBuf,
    unit: &str,
) -> PyResult<(Matrix<'py>, Bound<'py, PyArray2<i64>>)> {
    let unit: LengthUnit = unit.parse().map_err(refused)?;
    let mesh = py.detach(|| read_mesh(path, unit)).map_err(refused)?;
    Ok((rows(py, mesh.vertices()), corners(py, mesh.triangles())))
}
