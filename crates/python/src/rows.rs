//! Points, vectors and triangles as arrays.

use cloudtouch::geom::{Point3, Vector3};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;

/// Points as rows.
pub(crate) fn rows<'py>(py: Python<'py>, points: &[Point3]) -> Bound<'py, PyArray2<f64>> {
    table(points.iter().map(|p| p.coords)).into_pyarray(py)
}

/// Vectors as rows.
pub(crate) fn table(vectors: impl ExactSizeIterator<Item = Vector3>) -> Array2<f64> {
    let mut table = Array2::zeros((vectors.len(), 3));
    for (mut row, vector) in table.rows_mut().into_iter().zip(vectors) {
        row.iter_mut().zip(vector.iter()).for_each(|(entry, value)| *entry = *value);
    }
    table
}

/// Triangles as rows.
pub(crate) fn corners<'py>(py: Python<'py>, triangles: &[[u32; 3]]) -> Bound<'py, PyArray2<i64>> {
    let entry = |(row, column): (usize, usize)| i64::from(triangles[row][column]);
    Array2::from_shape_fn((triangles.len(), 3), entry).into_pyarray(py)
}
