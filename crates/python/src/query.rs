//! Queries: settings checked once, and the three questions.

use std::time::Duration;

use cloudtouch::geom::Pose;
use cloudtouch::{Query as Checked, QuerySettings, Safeguards};
use nalgebra::Matrix4;
use numpy::{PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer;
use crate::arrays::{matrices, matrix};
use crate::batch::Columns;
use crate::body::Body;
use crate::error::{refused, refused_for};
use crate::pool::on_all_threads;

/// Between so many poses Python is asked whether Ctrl-C was pressed, and reports make room for others.
const POSES_AT_ONCE: usize = 1024;

/// Settings, checked.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Query {
    checked: Checked,
}

#[pymethods]
impl Query {
    #[new]
    #[pyo3(signature = (
        accept, reject, prior, max_unseen, max_missing, doubt_units, stop_above, deadline,
        max_contacts, /
    ))]
    #[allow(clippy::too_many_arguments, reason = "one for each setting, named in Python")]
    fn new(
        accept: f64,
        reject: f64,
        prior: f64,
        max_unseen: f64,
        max_missing: f64,
        doubt_units: bool,
        stop_above: f64,
        deadline: Option<f64>,
        max_contacts: usize,
    ) -> PyResult<Self> {
        let deadline = deadline.map(Duration::try_from_secs_f64).transpose();
        let settings = QuerySettings {
            accept,
            reject,
            prior,
            safeguards: Safeguards { max_unseen, max_missing, doubt_units },
            stop_above,
            deadline: deadline.map_err(|e| refused_for("deadline", e))?,
            max_contacts,
            ..QuerySettings::default()
        };
        Ok(Self { checked: Checked::new(settings).map_err(refused)? })
    }

    #[pyo3(signature = (a, b, pose, /))]
    fn run<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (a, b) = (a.get().get(), b.get().get());
        let pose = rigid(&matrix(&pose))?;
        let report = py.detach(|| self.checked.run(a, b, &pose)).map_err(refused)?;
        answer::report(py, &report)
    }

    #[pyo3(signature = (a, b, pose, margin, /))]
    fn within<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
        margin: f64,
    ) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
        let (a, b) = (a.get().get(), b.get().get());
        let pose = rigid(&matrix(&pose))?;
        let both = py.detach(|| self.checked.within(a, b, &pose, margin));
        let (report, within) = both.map_err(refused)?;
        Ok((answer::report(py, &report)?, answer::within(py, &within)?))
    }

    #[pyo3(signature = (a, b, poses, /))]
    fn run_batch<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        poses: PyReadonlyArray3<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (a, b) = (a.get().get(), b.get().get());
        let at = |index: usize| format!("poses[{index}]");
        let rigid = |(index, pose): (usize, &Matrix4<f64>)| {
            Pose::try_from_matrix(pose).map_err(|e| refused_for(at(index), e))
        };
        let poses: PyResult<Vec<Pose>> = matrices(&poses).iter().enumerate().map(rigid).collect();
        let mut columns = Columns::default();
        for (part, poses) in poses?.chunks(POSES_AT_ONCE).enumerate() {
            let reports = on_all_threads(py, || self.checked.run_batch(a, b, poses))?;
            for (index, report) in reports.into_iter().enumerate() {
                let failed = |e| refused_for(at(part * POSES_AT_ONCE + index), e);
                columns.push(&report.map_err(failed)?);
            }
            py.check_signals()?;
        }
        columns.into_dict(py)
    }
}

fn rigid(matrix: &Matrix4<f64>) -> PyResult<Pose> {
    Pose::try_from_matrix(matrix).map_err(|e| refused_for("pose", e))
}
