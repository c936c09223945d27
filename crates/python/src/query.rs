//! Queries: settings checked once, and what is asked with them.

use std::array::from_fn;
use std::time::Duration;

use cloudtouch::geom::Pose;
use cloudtouch::{Path, PoseDistribution, Query as Checked, QuerySettings, Safeguards};
use nalgebra::Matrix4;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::answer;
use crate::arrays::{matrices, matrix};
use crate::batch::{Row, columns};
use crate::body::Body;
use crate::error::{refused, refused_for};
use crate::pool::{on_all_threads, on_this_thread};
use crate::{page, sweep};

/// Between so many poses Python is asked whether Ctrl-C was pressed.
const POSES_AT_ONCE: usize = 1024;

/// Settings, checked.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Query {
    checked: Checked,
}

impl Query {
    pub(crate) fn checked(&self) -> &Checked {
        &self.checked
    }
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
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        let report = on_this_thread(py, || self.checked.run(&*a, &*b, &pose))?.map_err(refused)?;
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
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        let both = on_this_thread(py, || self.checked.within(&*a, &*b, &pose, margin))?;
        let (report, within) = both.map_err(refused)?;
        Ok((answer::report(py, &report)?, answer::within(py, &within)?))
    }

    #[pyo3(signature = (a, b, pose, share, /))]
    fn clearance_interval<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
        share: f64,
    ) -> PyResult<[f64; 2]> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        on_this_thread(py, || self.checked.clearance_interval(&*a, &*b, &pose, share))?
            .map_err(refused)
    }

    #[pyo3(signature = (a, b, pose, covariance, /))]
    fn run_uncertain<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
        covariance: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let mean = rigid("pose", &matrix(&pose))?;
        let entries = covariance.as_array();
        let covariance = from_fn(|row| from_fn(|column| entries[(row, column)]));
        let poses = PoseDistribution { mean, covariance };
        let both = on_all_threads(py, || self.checked.run_uncertain(&*a, &*b, &poses))?;
        let (report, under) = both.map_err(refused)?;
        Ok((answer::report(py, &report)?, answer::under_poses(py, &under)?))
    }

    #[pyo3(signature = (a, b, pose, /))]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        let both = on_this_thread(py, || self.checked.gradient(&*a, &*b, &pose))?;
        let (report, gradient) = both.map_err(refused)?;
        Ok((answer::report(py, &report)?, answer::gradient(py, &gradient)?))
    }

    #[pyo3(signature = (a, b, pose, probability, /))]
    fn penetration<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        pose: PyReadonlyArray2<'py, f64>,
        probability: f64,
    ) -> PyResult<(Bound<'py, PyDict>, Option<Bound<'py, PyDict>>)> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        let both = on_this_thread(py, || self.checked.penetration(&*a, &*b, &pose, probability))?;
        let (report, out) = both.map_err(refused)?;
        let out = out.map(|out| answer::penetration(py, &out)).transpose()?;
        Ok((answer::report(py, &report)?, out))
    }

    #[pyo3(signature = (a, b, poses, is_screw, tolerance, /))]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        poses: PyReadonlyArray3<'py, f64>,
        is_screw: bool,
        tolerance: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let poses: PyResult<Vec<Pose>> = all_rigid(&poses).into_iter().collect();
        let join = if is_screw { Path::through_by_screws } else { Path::through };
        let path = join(&poses?).map_err(refused)?;
        let swept = on_this_thread(py, || self.checked.sweep(&*a, &*b, &path, tolerance))?
            .map_err(refused)?;
        sweep::answer(py, &swept)
    }

    #[pyo3(signature = (a, b, poses, words, height, /))]
    fn page<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        poses: PyReadonlyArray3<'py, f64>,
        words: (String, [Option<String>; 2]),
        height: Option<u32>,
    ) -> PyResult<String> {
        let (title, [sensor_a, sensor_b]) = words;
        let poses: PyResult<Vec<Pose>> = all_rigid(&poses).into_iter().collect();
        let bodies = [(a.get().now(py)?, sensor_a), (b.get().now(py)?, sensor_b)];
        page::answer(py, &self.checked, bodies, &poses?, title, height)
    }

    #[pyo3(signature = (a, b, poses, keep_going, /))]
    fn run_batch<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        poses: PyReadonlyArray3<'py, f64>,
        keep_going: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let poses = all_rigid(&poses);
        // Before any work.
        if let Some(Err(error)) = poses.iter().find(|pose| pose.is_err() && !keep_going) {
            return Err(error.clone_ref(py));
        }
        let ask = |pose: &Pose| self.checked.run(&*a, &*b, pose).map(|report| Row::from(&report));
        let mut rows = Vec::with_capacity(poses.len());
        for (part, poses) in poses.chunks(POSES_AT_ONCE).enumerate() {
            let good: Vec<Pose> = poses.iter().flatten().copied().collect();
            let answers: Vec<_> = on_all_threads(py, || good.par_iter().map(ask).collect())?;
            let mut answers = answers.into_iter();
            for (index, pose) in poses.iter().enumerate() {
                let row = match pose {
                    Ok(_) => {
                        let place = || format!("poses[{}]", part * POSES_AT_ONCE + index);
                        let answer = answers.next().expect("an answer for each good pose");
                        answer.map_err(|e| refused_for(place(), e))
                    }
                    Err(error) => Err(error.clone_ref(py)),
                };
                rows.push(match row {
                    Ok(row) => row,
                    Err(error) if keep_going => Row::refused(error.value(py).to_string()),
                    Err(error) => return Err(error),
                });
            }
            py.check_signals()?;
        }
        columns(py, &rows)
    }

    #[pyo3(signature = (a, b, pose, /))]
    fn is_free(
        &self,
        py: Python<'_>,
        a: &Bound<'_, Body>,
        b: &Bound<'_, Body>,
        pose: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<bool> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let pose = rigid("pose", &matrix(&pose))?;
        on_this_thread(py, || self.checked.is_free(&*a, &*b, &pose))?.map_err(refused)
    }

    #[pyo3(signature = (a, b, poses, /))]
    fn are_free<'py>(
        &self,
        py: Python<'py>,
        a: &Bound<'py, Body>,
        b: &Bound<'py, Body>,
        poses: PyReadonlyArray3<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let (a, b) = (a.get().now(py)?, b.get().now(py)?);
        let poses = all_rigid(&poses).into_iter().collect::<PyResult<Vec<Pose>>>()?;
        let ask = |pose: &Pose| self.checked.is_free(&*a, &*b, pose);
        let mut free = Vec::with_capacity(poses.len());
        for poses in poses.chunks(POSES_AT_ONCE) {
            let answers: Vec<_> = on_all_threads(py, || poses.par_iter().map(ask).collect())?;
            for answer in answers {
                let place = || format!("poses[{}]", free.len());
                free.push(answer.map_err(|e| refused_for(place(), e))?);
            }
            py.check_signals()?;
        }
        Ok(free.into_pyarray(py))
    }
}

/// The poses of an array, each good or named by its place.
fn all_rigid(poses: &PyReadonlyArray3<'_, f64>) -> Vec<PyResult<Pose>> {
    let rigid = |(index, pose): (usize, &Matrix4<f64>)| {
        Pose::try_from_matrix(pose).map_err(|e| refused_for(format!("poses[{index}]"), e))
    };
    matrices(poses).iter().enumerate().map(rigid).collect()
}

/// The pose of a matrix that is an argument by this name.
pub(crate) fn rigid(argument: &str, matrix: &Matrix4<f64>) -> PyResult<Pose> {
    Pose::try_from_matrix(matrix).map_err(|e| refused_for(argument, e))
}
