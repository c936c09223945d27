//! Many reports as columns.
//!
//! A report becomes a row on the thread that asked: contacts and points that no column tells are given back
//! while they are in its cache, and not kept for all poses.

use cloudtouch::geom::Vector3;
use cloudtouch::{Report, Undecided, Warning};
use numpy::{Element, IntoPyArray, PyArray1, PyFixedUnicode};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer::seconds;
use crate::rows::table;

/// Letters of the longest name: "in_collision".
const LETTERS: usize = 12;

/// What a batch tells of a pose; NaN where a report has no number.
pub(crate) struct Row {
    probability: f64,
    lower: f64,
    upper: f64,
    verdict: &'static str,
    undecided_by: &'static str,
    log_likelihood_ratio: f64,
    clearance: f64,
    clearance_std: f64,
    clearance_is_bound: bool,
    clearance_at_least: f64,
    contact_point: Vector3,
    contact_normal: Vector3,
    contact_count: usize,
    warning_count: usize,
    warnings: String,
    seconds: f64,
    error: String,
}

impl From<&Report> for Row {
    fn from(report: &Report) -> Self {
        let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let (clearance, contact) = (report.clearance_m, report.contacts.first());
        let nowhere = Vector3::repeat(f64::NAN);
        let [lower, upper] = report.bounds;
        Self {
            probability: report.collision_probability,
            lower,
            upper,
            verdict: report.verdict.code(),
            undecided_by: report.undecided_by.map_or("", Undecided::code),
            log_likelihood_ratio: or_nan(report.log_likelihood_ratio),
            clearance: or_nan(clearance.map(|c| c.mean)),
            clearance_std: or_nan(clearance.map(|c| c.std)),
            clearance_is_bound: clearance.is_some_and(|c| c.is_bound),
            clearance_at_least: or_nan(report.clearance_at_least_m),
            contact_point: contact.map_or(nowhere, |c| c.point.coords),
            contact_normal: contact.map_or(nowhere, |c| c.normal_a_to_b),
            contact_count: report.contacts.len(),
            warning_count: report.warnings.len(),
            warnings: codes(report),
            seconds: seconds(report),
            error: String::new(),
        }
    }
}

impl Row {
    /// No answer, which never reads as free.
    pub(crate) fn refused(error: String) -> Self {
        Self {
            probability: f64::NAN,
            lower: f64::NAN,
            upper: f64::NAN,
            verdict: "error",
            undecided_by: "",
            log_likelihood_ratio: f64::NAN,
            clearance: f64::NAN,
            clearance_std: f64::NAN,
            clearance_is_bound: false,
            clearance_at_least: f64::NAN,
            contact_point: Vector3::repeat(f64::NAN),
            contact_normal: Vector3::repeat(f64::NAN),
            contact_count: 0,
            warning_count: 0,
            warnings: String::new(),
            seconds: 0.0,
            error,
        }
    }
}

/// The codes of all warnings, in their order.
fn codes(report: &Report) -> String {
    let codes: Vec<&str> = report.warnings.iter().map(Warning::code).collect();
    codes.join(",")
}

/// The columns by their names in Python.
pub(crate) fn columns<'py>(py: Python<'py>, rows: &[Row]) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    columns.set_item("probability", column(py, rows, |row| row.probability))?;
    columns.set_item("lower", column(py, rows, |row| row.lower))?;
    columns.set_item("upper", column(py, rows, |row| row.upper))?;
    columns.set_item("verdict", column(py, rows, |row| name(row.verdict)))?;
    columns.set_item("undecided_by", column(py, rows, |row| name(row.undecided_by)))?;
    let ratios = column(py, rows, |row| row.log_likelihood_ratio);
    columns.set_item("log_likelihood_ratio", ratios)?;
    columns.set_item("clearance", column(py, rows, |row| row.clearance))?;
    columns.set_item("clearance_std", column(py, rows, |row| row.clearance_std))?;
    columns.set_item("clearance_is_bound", column(py, rows, |row| row.clearance_is_bound))?;
    columns.set_item("clearance_at_least", column(py, rows, |row| row.clearance_at_least))?;
    let points = table(rows.iter().map(|row| row.contact_point));
    columns.set_item("contact_point", points.into_pyarray(py))?;
    let normals = table(rows.iter().map(|row| row.contact_normal));
    columns.set_item("contact_normal", normals.into_pyarray(py))?;
    columns.set_item("contact_count", column(py, rows, |row| row.contact_count as i64))?;
    columns.set_item("warning_count", column(py, rows, |row| row.warning_count as i64))?;
    let warnings: Vec<&str> = rows.iter().map(|row| row.warnings.as_str()).collect();
    columns.set_item("warnings", warnings)?;
    columns.set_item("seconds", column(py, rows, |row| row.seconds))?;
    let errors: Vec<&str> = rows.iter().map(|row| row.error.as_str()).collect();
    columns.set_item("error", errors)?;
    Ok(columns)
}

fn column<'py, T: Element>(
    py: Python<'py>,
    rows: &[Row],
    of: impl Fn(&Row) -> T,
) -> Bound<'py, PyArray1<T>> {
    rows.iter().map(of).collect::<Vec<T>>().into_pyarray(py)
}

/// The columns of rows that were not asked about, all for one reason.
#[pyfunction]
#[pyo3(signature = (message, count, /))]
pub(crate) fn refused<'py>(
    py: Python<'py>,
    message: &str,
    count: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let rows: Vec<Row> = (0..count).map(|_| Row::refused(message.to_owned())).collect();
    columns(py, &rows)
}

/// A name in the letters that numpy has, filled up with zeros.
fn name(text: &str) -> PyFixedUnicode<LETTERS> {
    let mut letters = [0; LETTERS];
    letters.iter_mut().zip(text.chars()).for_each(|(letter, c)| *letter = c.into());
    letters.into()
}
