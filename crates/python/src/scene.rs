//! Many bodies by name.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cloudtouch::{Checked, PairAnswer, Scene as Bodies};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer;
use crate::arrays::matrix;
use crate::body::Body;
use crate::error::refused;
use crate::pool::on_all_threads;
use crate::query::{Query, rigid};

/// Named bodies with poses; several threads may ask it, one at a time changes it.
#[pyclass(frozen, module = "cloudtouch._native")]
#[derive(Default)]
pub(crate) struct Scene {
    bodies: Mutex<Bodies>,
}

/// Names of two bodies, and their report or why there is none.
type Pair<'py> = (String, String, Option<Bound<'py, PyDict>>, Option<String>);

impl Scene {
    /// What a thread that panicked left is whole: each change is made at once or not at all.
    fn lock(&self) -> MutexGuard<'_, Bodies> {
        self.bodies.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// As it is now: to be asked while others change it.
    fn now(&self) -> Bodies {
        self.lock().clone()
    }
}

#[pymethods]
impl Scene {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    #[pyo3(signature = (name, body, pose, /))]
    fn add(
        &self,
        name: String,
        body: &Bound<'_, Body>,
        pose: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let pose = rigid(&matrix(&pose))?;
        self.lock().add(name, Arc::clone(body.get().prepared()), pose).map_err(refused)
    }

    #[pyo3(signature = (name, body, /))]
    fn replace(&self, name: &str, body: &Bound<'_, Body>) -> PyResult<()> {
        let body = Arc::clone(body.get().prepared());
        self.lock().replace(name, body).map(|_| ()).map_err(refused)
    }

    #[pyo3(signature = (name, /))]
    fn remove(&self, name: &str) -> PyResult<()> {
        self.lock().remove(name).map(|_| ()).map_err(refused)
    }

    #[pyo3(signature = (name, pose, /))]
    fn set_pose(&self, name: &str, pose: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let pose = rigid(&matrix(&pose))?;
        self.lock().set_pose(name, pose).map_err(refused)
    }

    #[pyo3(signature = (name, to, /))]
    fn attach(&self, name: &str, to: &str) -> PyResult<()> {
        let mut bodies = self.lock();
        let between = bodies.between(to, name).map_err(refused)?;
        bodies.attach(name, to, between).map_err(refused)
    }

    #[pyo3(signature = (name, /))]
    fn detach(&self, name: &str) -> PyResult<()> {
        self.lock().detach(name).map_err(refused)
    }

    #[pyo3(signature = (a, b, may_touch, /))]
    fn allow(&self, a: &str, b: &str, may_touch: bool) -> PyResult<()> {
        let mut bodies = self.lock();
        if may_touch { bodies.allow(a, b) } else { bodies.forbid(a, b) }.map_err(refused)
    }

    fn names(&self) -> Vec<String> {
        self.lock().names().map(str::to_owned).collect()
    }

    /// All pairs that are not free, the worst first; pairs there are, ruled out and asked.
    #[pyo3(signature = (query, /))]
    fn check<'py>(
        &self,
        py: Python<'py>,
        query: &Bound<'py, Query>,
    ) -> PyResult<(Vec<Pair<'py>>, [usize; 4])> {
        let (bodies, query) = (self.now(), query.get().checked());
        let Checked { pairs, count, allowed, ruled_out, asked } =
            on_all_threads(py, || bodies.check(query))?;
        let pairs: PyResult<_> = pairs.into_iter().map(|found| pair(py, found)).collect();
        Ok((pairs?, [count, allowed, ruled_out, asked]))
    }

    #[pyo3(signature = (query, /))]
    fn check_first<'py>(
        &self,
        py: Python<'py>,
        query: &Bound<'py, Query>,
    ) -> PyResult<Option<Pair<'py>>> {
        let (bodies, query) = (self.now(), query.get().checked());
        let found = py.detach(|| bodies.check_first(query));
        found.map(|found| pair(py, found)).transpose()
    }
}

fn pair(py: Python<'_>, found: PairAnswer) -> PyResult<Pair<'_>> {
    let PairAnswer { a, b, answer } = found;
    Ok(match answer {
        Ok(report) => (a, b, Some(answer::report(py, &report)?), None),
        Err(error) => (a, b, None, Some(error.to_string())),
    })
}
