//! What is known along a path, as what `cloudtouch.Swept` is made of.

use cloudtouch::{AlongPath, Swept, Undecided};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer::report;
use crate::arrays::of_pose;

/// The fields of a sweep, by their names in Python.
pub(crate) fn answer<'py>(py: Python<'py>, swept: &Swept) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let [lower, upper] = swept.bounds;
    fields.set_item("lower", lower)?;
    fields.set_item("upper", upper)?;
    fields.set_item("verdict", swept.verdict.code())?;
    fields.set_item("undecided_by", swept.undecided_by.map(Undecided::code))?;
    let warnings: Vec<String> = swept.warnings.iter().map(ToString::to_string).collect();
    fields.set_item("warnings", warnings)?;
    fields.set_item("most_probable", place(py, &swept.most_probable)?)?;
    let first = swept.first.as_ref();
    fields.set_item("first", first.map(|first| place(py, &first.at)).transpose()?)?;
    fields.set_item("first_not_before", first.map(|first| first.not_before))?;
    fields.set_item("certified_free_until", swept.certified_free_until)?;
    fields.set_item("poses", swept.stats.poses)?;
    fields.set_item("seconds", 1e-6 * swept.stats.query_us as f64)?;
    Ok(fields)
}

fn place<'py>(py: Python<'py>, at: &AlongPath) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    fields.set_item("segment", at.segment)?;
    fields.set_item("t", at.t)?;
    fields.set_item("share", at.share)?;
    fields.set_item("pose", of_pose(py, &at.pose))?;
    fields.set_item("report", report(py, &at.report)?)?;
    Ok(fields)
}
