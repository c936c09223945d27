//! Many reports as columns.

use cloudtouch::Report;
use cloudtouch::geom::Vector3;
use numpy::{IntoPyArray, PyFixedUnicode};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer::{cause, seconds, verdict};
use crate::body::table;

/// Letters of the longest name: "in_collision".
const LETTERS: usize = 12;

/// The columns of a batch, a row for each pose; NaN where a report has no number.
#[derive(Default)]
pub(crate) struct Columns {
    probability: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    verdict: Vec<PyFixedUnicode<LETTERS>>,
    undecided_by: Vec<PyFixedUnicode<LETTERS>>,
    log_likelihood_ratio: Vec<f64>,
    clearance: Vec<f64>,
    clearance_std: Vec<f64>,
    clearance_is_bound: Vec<bool>,
    clearance_at_least: Vec<f64>,
    contact_point: Vec<Vector3>,
    contact_normal: Vec<Vector3>,
    contact_count: Vec<i64>,
    warning_count: Vec<i64>,
    seconds: Vec<f64>,
    error: Vec<String>,
}

impl Columns {
    pub(crate) fn push(&mut self, report: &Report) {
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let [lower, upper] = report.bounds;
        self.probability.push(report.collision_probability);
        self.lower.push(lower);
        self.upper.push(upper);
        self.verdict.push(name(verdict(report.verdict)));
        self.undecided_by.push(name(report.undecided_by.map_or("", cause)));
        self.log_likelihood_ratio.push(or_nan(report.log_likelihood_ratio));
        let clearance = report.clearance_m;
        self.clearance.push(or_nan(clearance.map(|c| c.mean)));
        self.clearance_std.push(or_nan(clearance.map(|c| c.std)));
        self.clearance_is_bound.push(clearance.is_some_and(|c| c.is_bound));
        self.clearance_at_least.push(or_nan(report.clearance_at_least_m));
        let nowhere = Vector3::repeat(f64::NAN);
        let contact = report.contacts.first();
        self.contact_point.push(contact.map_or(nowhere, |c| c.point.coords));
        self.contact_normal.push(contact.map_or(nowhere, |c| c.normal_a_to_b));
        self.contact_count.push(report.contacts.len() as i64);
        self.warning_count.push(report.warnings.len() as i64);
        self.seconds.push(seconds(report));
        self.error.push(String::new());
    }

    /// A row without an answer, which never reads as free.
    pub(crate) fn push_error(&mut self, message: &str) {
        self.probability.push(f64::NAN);
        self.lower.push(f64::NAN);
        self.upper.push(f64::NAN);
        self.verdict.push(name("error"));
        self.undecided_by.push(name(""));
        self.log_likelihood_ratio.push(f64::NAN);
        self.clearance.push(f64::NAN);
        self.clearance_std.push(f64::NAN);
        self.clearance_is_bound.push(false);
        self.clearance_at_least.push(f64::NAN);
        self.contact_point.push(Vector3::repeat(f64::NAN));
        self.contact_normal.push(Vector3::repeat(f64::NAN));
        self.contact_count.push(0);
        self.warning_count.push(0);
        self.seconds.push(0.0);
        self.error.push(message.to_owned());
    }

    /// By their names in Python.
    pub(crate) fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let columns = PyDict::new(py);
        columns.set_item("probability", self.probability.into_pyarray(py))?;
        columns.set_item("lower", self.lower.into_pyarray(py))?;
        columns.set_item("upper", self.upper.into_pyarray(py))?;
        columns.set_item("verdict", self.verdict.into_pyarray(py))?;
        columns.set_item("undecided_by", self.undecided_by.into_pyarray(py))?;
        columns.set_item("log_likelihood_ratio", self.log_likelihood_ratio.into_pyarray(py))?;
        columns.set_item("clearance", self.clearance.into_pyarray(py))?;
        columns.set_item("clearance_std", self.clearance_std.into_pyarray(py))?;
        columns.set_item("clearance_is_bound", self.clearance_is_bound.into_pyarray(py))?;
        columns.set_item("clearance_at_least", self.clearance_at_least.into_pyarray(py))?;
        columns
            .set_item("contact_point", table(self.contact_point.into_iter()).into_pyarray(py))?;
        let normals = table(self.contact_normal.into_iter());
        columns.set_item("contact_normal", normals.into_pyarray(py))?;
        columns.set_item("contact_count", self.contact_count.into_pyarray(py))?;
        columns.set_item("warning_count", self.warning_count.into_pyarray(py))?;
        columns.set_item("seconds", self.seconds.into_pyarray(py))?;
        columns.set_item("error", self.error)?;
        Ok(columns)
    }
}

/// The columns of rows that were not asked about, all for one reason.
#[pyfunction]
#[pyo3(signature = (message, count, /))]
pub(crate) fn refused<'py>(
    py: Python<'py>,
    message: &str,
    count: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let mut columns = Columns::default();
    (0..count).for_each(|_| columns.push_error(message));
    columns.into_dict(py)
}

/// A name in the letters that numpy has, filled up with zeros.
fn name(text: &str) -> PyFixedUnicode<LETTERS> {
    let mut letters = [0; LETTERS];
    letters.iter_mut().zip(text.chars()).for_each(|(letter, c)| *letter = c.into());
    letters.into()
}
