//! One report as what `cloudtouch.Report` is made of.

use cloudtouch::{Penetration, PoseGradient, Report, Undecided, UnderPoses, Within};
use numpy::IntoPyArray;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::rows::table;

/// How long a query took, s: a report has whole microseconds.
pub(crate) fn seconds(report: &Report) -> f64 {
    1e-6 * report.stats.query_us as f64
}

/// The fields of a report, by their names in Python.
pub(crate) fn report<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let [lower, upper] = report.bounds;
    fields.set_item(intern!(py, "probability"), report.collision_probability)?;
    fields.set_item(intern!(py, "lower"), lower)?;
    fields.set_item(intern!(py, "upper"), upper)?;
    fields.set_item(intern!(py, "verdict"), report.verdict.code())?;
    fields.set_item(intern!(py, "undecided_by"), report.undecided_by.map(Undecided::code))?;
    fields.set_item(intern!(py, "log_likelihood_ratio"), report.log_likelihood_ratio)?;
    let clearance = report.clearance_m;
    fields.set_item(intern!(py, "clearance"), clearance.map(|c| c.mean))?;
    fields.set_item(intern!(py, "clearance_std"), clearance.map(|c| c.std))?;
    fields.set_item(intern!(py, "clearance_is_bound"), clearance.is_some_and(|c| c.is_bound))?;
    fields.set_item(intern!(py, "clearance_at_least"), report.clearance_at_least_m)?;
    fields.set_item(intern!(py, "unseen"), report.unseen.map(|unseen| unseen.share()))?;
    let evidence = report.evidence.map(|e| {
        (
            e.deviations,
            e.crossing,
            e.extent,
            e.misclassified,
            e.noise_over_spacing,
            e.scatter_over_spacing,
        )
    });
    fields.set_item(intern!(py, "evidence"), evidence)?;
    let warnings: Vec<String> = report.warnings.iter().map(ToString::to_string).collect();
    fields.set_item(intern!(py, "warnings"), warnings)?;
    fields.set_item(intern!(py, "seconds"), seconds(report))?;
    if !report.contacts.is_empty() {
        let contacts = &report.contacts;
        let points = table(contacts.iter().map(|c| c.point.coords));
        let normals = table(contacts.iter().map(|c| c.normal_a_to_b));
        let area = |area: Option<f64>| area.unwrap_or(f64::NAN);
        let numbers =
            contacts.iter().map(|c| [c.probability, c.clearance_m, area(c.area_m2)].into());
        let numbers = table(numbers).into_pyarray(py);
        let arrays = (points.into_pyarray(py), normals.into_pyarray(py), numbers);
        fields.set_item(intern!(py, "_contacts"), arrays)?;
    }
    for (name, points) in [
        (intern!(py, "points_a"), &report.point_probabilities.a),
        (intern!(py, "points_b"), &report.point_probabilities.b),
    ] {
        if !points.is_empty() {
            let (indices, probabilities): (Vec<i64>, Vec<f64>) =
                points.iter().map(|&(index, p)| (index as i64, p)).unzip();
            let arrays = (indices.into_pyarray(py), probabilities.into_pyarray(py));
            fields.set_item(name, arrays)?;
        }
    }
    Ok(fields)
}

/// The fields of what a margin adds.
pub(crate) fn within<'py>(py: Python<'py>, within: &Within) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let [lower, upper] = within.bounds;
    fields.set_item(intern!(py, "margin"), within.margin_m)?;
    fields.set_item(intern!(py, "probability"), within.probability)?;
    fields.set_item(intern!(py, "lower"), lower)?;
    fields.set_item(intern!(py, "upper"), upper)?;
    fields.set_item(intern!(py, "deviations"), within.deviations)?;
    Ok(fields)
}

/// The fields of a collision over all the poses that may be.
pub(crate) fn under_poses<'py>(
    py: Python<'py>,
    under: &UnderPoses,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let [lower, upper] = under.bounds;
    fields.set_item(intern!(py, "probability"), under.probability)?;
    fields.set_item(intern!(py, "lower"), lower)?;
    fields.set_item(intern!(py, "upper"), upper)?;
    fields.set_item(intern!(py, "std_error"), under.std_error)?;
    fields.set_item(intern!(py, "poses"), under.poses)?;
    Ok(fields)
}

/// The fields of what an answer changes by with the pose.
pub(crate) fn gradient<'py>(
    py: Python<'py>,
    gradient: &PoseGradient,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let array = |slopes: [f64; 6]| slopes.to_vec().into_pyarray(py);
    fields.set_item(intern!(py, "probability"), array(gradient.probability))?;
    fields.set_item(intern!(py, "log_odds"), array(gradient.log_odds))?;
    fields.set_item(intern!(py, "clearance"), gradient.clearance.map(array))?;
    Ok(fields)
}

/// The fields of a way out of a collision.
pub(crate) fn penetration<'py>(py: Python<'py>, out: &Penetration) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    let direction: Vec<f64> = out.direction.iter().copied().collect();
    fields.set_item(intern!(py, "direction"), direction.into_pyarray(py))?;
    fields.set_item(intern!(py, "distance"), out.distance_m)?;
    fields.set_item(intern!(py, "depth"), out.depth_m)?;
    fields.set_item(intern!(py, "std"), out.std_m)?;
    Ok(fields)
}
