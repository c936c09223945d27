//! Many bodies by name.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cloudtouch::geom::{Point3, TriangleMesh};
use cloudtouch::{Body as Prepared, Checked, Mesh, PairAnswer, Scene as Bodies};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answer;
use crate::arrays::matrix;
use crate::body::Body;
use crate::error::refused;
use crate::page;
use crate::pool::on_all_threads;
use crate::query::{Query, rigid};

/// Named bodies with poses; several threads may ask it, one at a time changes it.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Scene {
    named: Mutex<Named>,
    nobody: Arc<Prepared>,
}

struct Named {
    /// Where they are, with nobody in the place of each.
    places: Bodies,
    /// Who they are: a cloud may change while it is in a scene.
    bodies: BTreeMap<String, Py<Body>>,
}

/// Names of two bodies, and their report or why there is none.
pub(crate) type Pair<'py> = (String, String, Option<Bound<'py, PyDict>>, Option<String>);

/// Pairs that are not free; pairs there are, allowed, ruled out and asked; bodies unchecked, outside, warned of.
pub(crate) type Found<'py> =
    (Vec<Pair<'py>>, [usize; 4], Vec<String>, Vec<(String, f64, f64)>, Vec<(String, String)>);

impl Scene {
    /// What a thread that panicked left is whole: each change is made at once or not at all.
    fn lock(&self) -> MutexGuard<'_, Named> {
        self.named.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// As it is now: to be asked while others change it.
    fn now(&self, py: Python<'_>) -> PyResult<Bodies> {
        let (mut scene, bodies) = {
            let named = self.lock();
            let bodies = named.bodies.iter().map(|(name, body)| (name.clone(), body.clone_ref(py)));
            (named.places.clone(), bodies.collect::<Vec<_>>())
        };
        for (name, body) in bodies {
            scene.replace(&name, body.get().now(py)?).map_err(refused)?;
        }
        Ok(scene)
    }
}

/// Stands where a body will be, so that its owner may change that.
pub(crate) fn nobody() -> PyResult<Arc<Prepared>> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0));
    let triangle = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2]]).map_err(refused)?;
    Ok(Arc::new(Mesh::prepare(&triangle).map_err(refused)?.into()))
}

#[pymethods]
impl Scene {
    #[new]
    fn new() -> PyResult<Self> {
        let named = Named { places: Bodies::default(), bodies: BTreeMap::new() };
        Ok(Self { named: Mutex::new(named), nobody: nobody()? })
    }

    #[pyo3(signature = (name, body, pose, /))]
    fn add(
        &self,
        name: String,
        body: Bound<'_, Body>,
        pose: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let pose = rigid("pose", &matrix(&pose))?;
        let mut named = self.lock();
        named.places.add(name.clone(), Arc::clone(&self.nobody), pose).map_err(refused)?;
        named.bodies.insert(name, body.unbind());
        Ok(())
    }

    #[pyo3(signature = (name, body, /))]
    fn replace(&self, name: &str, body: Bound<'_, Body>) -> PyResult<()> {
        let mut named = self.lock();
        named.places.body(name).map_err(refused)?;
        named.bodies.insert(name.to_owned(), body.unbind());
        Ok(())
    }

    #[pyo3(signature = (name, /))]
    fn remove(&self, name: &str) -> PyResult<()> {
        let mut named = self.lock();
        named.places.remove(name).map_err(refused)?;
        named.bodies.remove(name);
        Ok(())
    }

    #[pyo3(signature = (name, pose, /))]
    fn set_pose(&self, name: &str, pose: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        let pose = rigid("pose", &matrix(&pose))?;
        self.lock().places.set_pose(name, pose).map_err(refused)
    }

    #[pyo3(signature = (name, to, /))]
    fn attach(&self, name: &str, to: &str) -> PyResult<()> {
        let bodies = &mut self.lock().places;
        let between = bodies.between(to, name).map_err(refused)?;
        bodies.attach(name, to, between).map_err(refused)
    }

    #[pyo3(signature = (name, /))]
    fn detach(&self, name: &str) -> PyResult<()> {
        self.lock().places.detach(name).map_err(refused)
    }

    #[pyo3(signature = (a, b, may_touch, /))]
    fn allow(&self, a: &str, b: &str, may_touch: bool) -> PyResult<()> {
        let bodies = &mut self.lock().places;
        if may_touch { bodies.allow(a, b) } else { bodies.forbid(a, b) }.map_err(refused)
    }

    /// Another with the same bodies, which are shared; what is done to one of the two is not seen by the other.
    fn copied(&self, py: Python<'_>) -> Self {
        let named = self.lock();
        let bodies = named.bodies.iter().map(|(name, body)| (name.clone(), body.clone_ref(py)));
        let named = Named { places: named.places.clone(), bodies: bodies.collect() };
        Self { named: Mutex::new(named), nobody: Arc::clone(&self.nobody) }
    }

    fn names(&self) -> Vec<String> {
        self.lock().places.names().map(str::to_owned).collect()
    }

    fn boxes(&self, py: Python<'_>) -> PyResult<Vec<(String, [[f64; 3]; 2])>> {
        let bodies = self.now(py)?;
        Ok(bodies.boxes().into_iter().map(|(name, of)| (name.to_owned(), box_of(of))).collect())
    }

    #[pyo3(signature = (query, /))]
    fn check<'py>(&self, py: Python<'py>, query: &Bound<'py, Query>) -> PyResult<Found<'py>> {
        let (bodies, query) = (self.now(py)?, query.get().checked());
        found(py, on_all_threads(py, || bodies.check(query))?)
    }

    #[pyo3(signature = (query, /))]
    fn check_first<'py>(
        &self,
        py: Python<'py>,
        query: &Bound<'py, Query>,
    ) -> PyResult<Option<Pair<'py>>> {
        let (bodies, query) = (self.now(py)?, query.get().checked());
        let found = on_all_threads(py, || bodies.check_first(query))?;
        found.map(|found| pair(py, found)).transpose()
    }

    #[pyo3(signature = (query, /))]
    fn is_free(&self, py: Python<'_>, query: &Bound<'_, Query>) -> PyResult<bool> {
        let (bodies, query) = (self.now(py)?, query.get().checked());
        on_all_threads(py, || bodies.is_free(query))
    }

    #[pyo3(signature = (query, title, height, /))]
    fn page(
        &self,
        py: Python<'_>,
        query: &Bound<'_, Query>,
        title: String,
        height: Option<u32>,
    ) -> PyResult<String> {
        page::of_scene(py, query.get().checked(), &self.now(py)?, None, (title, height))
    }
}

/// Lowest and highest corner of a box.
pub(crate) fn box_of(of: [Point3; 2]) -> [[f64; 3]; 2] {
    of.map(|corner| corner.coords.into())
}

/// All pairs that are not free, the worst first.
pub(crate) fn found(py: Python<'_>, checked: Checked) -> PyResult<Found<'_>> {
    let Checked { pairs, count, allowed, unchecked, ruled_out, asked, outside, warnings, .. } =
        checked;
    let pairs: PyResult<_> = pairs.into_iter().map(|found| pair(py, found)).collect();
    let outside = outside.into_iter().map(|of| (of.name, of.gap_m, of.size_m)).collect();
    let warnings = warnings.into_iter().map(|of| (of.name, of.warning.to_string())).collect();
    Ok((pairs?, [count, allowed, ruled_out, asked], unchecked, outside, warnings))
}

pub(crate) fn pair(py: Python<'_>, found: PairAnswer) -> PyResult<Pair<'_>> {
    let PairAnswer { a, b, answer, .. } = found;
    Ok(match answer {
        Ok(report) => (a, b, Some(answer::report(py, &report)?), None),
        Err(error) => (a, b, None, Some(error.to_string())),
    })
}
