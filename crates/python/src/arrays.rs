//! Arrays of numpy in, of either precision and any strides; nothing is copied on the way.

use cloudtouch::geom::{Point3, Pose};
use nalgebra::Matrix4;
use numpy::ndarray::{Array2, ArrayView2, ArrayView3};
use numpy::{Element, IntoPyArray, PyArray2, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

/// Rows of three numbers, as points.
#[derive(FromPyObject)]
pub(crate) enum Rows<'py> {
    /// Of float64.
    Double(PyReadonlyArray2<'py, f64>),
    /// Of float32.
    Single(PyReadonlyArray2<'py, f32>),
}

impl Rows<'_> {
    pub(crate) fn points(&self) -> Vec<Point3> {
        match self {
            Self::Double(array) => points(array.as_array()),
            Self::Single(array) => points(array.as_array()),
        }
    }
}

fn points<T: Element + Copy + Into<f64>>(rows: ArrayView2<'_, T>) -> Vec<Point3> {
    rows.rows()
        .into_iter()
        .map(|row| Point3::new(row[0].into(), row[1].into(), row[2].into()))
        .collect()
}

/// Sixteen numbers, as they were given: pickled settings have the same bits.
pub(crate) fn matrix(array: &PyReadonlyArray2<'_, f64>) -> Matrix4<f64> {
    let view = array.as_array();
    Matrix4::from_fn(|row, column| view[(row, column)])
}

/// Many of them.
pub(crate) fn matrices(array: &PyReadonlyArray3<'_, f64>) -> Vec<Matrix4<f64>> {
    let view: ArrayView3<'_, f64> = array.as_array();
    let of = |m: ArrayView2<'_, f64>| Matrix4::from_fn(|row, column| m[(row, column)]);
    view.outer_iter().map(of).collect()
}

/// A pose as a matrix.
pub(crate) fn of_pose<'py>(py: Python<'py>, pose: &Pose) -> Bound<'py, PyArray2<f64>> {
    let matrix = pose.isometry().to_homogeneous();
    Array2::from_shape_fn((4, 4), |place| matrix[place]).into_pyarray(py)
}
