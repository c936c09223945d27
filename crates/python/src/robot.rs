//! Robots from URDF, and which of their links touch what.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cloudtouch::geom::Pose;
use cloudtouch_robot::{
    JointKind, PathChecked, Robot as Described, RobotChecker as Checker, SURROUNDINGS, Stopped,
    Touching,
};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{matrix, of_pose};
use crate::body::Body;
use crate::error::refused;
use crate::page;
use crate::pool::on_all_threads;
use crate::query::{Query, rigid};
use crate::scene::{Found, Pair, box_of, found, nobody, pair};

type Joints = BTreeMap<String, f64>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;
/// Name, kind, limits, and what it mimics by which factor and offset.
type Joint = (String, &'static str, Option<[f64; 2]>, Option<(String, f64, f64)>);
/// Vertices, triangles and pose.
type Link<'py> = (Body, Matrix<'py>);
/// Answers at the positions given, how far it is free, segment, time and worst pair of where it stops,
/// positions looked at, and the verdict.
type Along<'py> =
    (Vec<Found<'py>>, f64, (Option<Place<'py>>, Option<Place<'py>>), usize, &'static str);

/// Segment, time in it, the worst pair there, and that which is least sure around.
type Place<'py> = (usize, f64, Option<Pair<'py>>, Option<(String, String, f64)>);

/// A robot read from a URDF; immutable.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Robot {
    described: Arc<Described>,
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (urdf, packages, srdf, /))]
    fn new(
        py: Python<'_>,
        urdf: PathBuf,
        packages: Vec<(String, PathBuf)>,
        srdf: Option<PathBuf>,
    ) -> PyResult<Self> {
        let read = || {
            let robot = Described::from_urdf(urdf, &packages)?;
            match srdf {
                Some(srdf) => robot.with_srdf(srdf),
                None => Ok(robot),
            }
        };
        Ok(Self { described: Arc::new(py.detach(read).map_err(refused)?) })
    }

    fn joints(&self) -> Vec<Joint> {
        let joint = |joint: &cloudtouch_robot::Joint| {
            let kind = match joint.kind {
                JointKind::Fixed => "fixed",
                JointKind::Revolute => "revolute",
                JointKind::Continuous => "continuous",
                JointKind::Prismatic => "prismatic",
            };
            let mimics = joint.mimics.as_ref();
            let mimics = mimics.map(|by| (by.joint.clone(), by.multiplier, by.offset));
            (joint.name.clone(), kind, joint.limits, mimics)
        };
        self.described.joints().iter().map(joint).collect()
    }

    fn links(&self) -> Vec<String> {
        self.described.links().to_vec()
    }

    fn unchecked_links(&self) -> Vec<String> {
        self.described.unchecked_links().to_vec()
    }

    fn unknown_links(&self) -> Vec<String> {
        self.described.unknown_links().to_vec()
    }

    #[pyo3(signature = (a, b, /))]
    fn may_touch(&self, a: &str, b: &str) -> PyResult<bool> {
        self.described.may_touch(a, b).map_err(refused)
    }

    #[pyo3(signature = (joints, /))]
    fn link_poses<'py>(
        &self,
        py: Python<'py>,
        joints: Joints,
    ) -> PyResult<Vec<(String, Matrix<'py>)>> {
        let poses = self.described.link_poses(&joints).map_err(refused)?;
        Ok(poses.into_iter().map(|(link, pose)| (link.to_owned(), of_pose(py, &pose))).collect())
    }

    /// The shapes of the links, and where a camera saw them.
    #[pyo3(signature = (joints, base_pose, /))]
    fn seen<'py>(
        &self,
        py: Python<'py>,
        joints: Joints,
        base_pose: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Vec<Link<'py>>> {
        let base = rigid("base_pose", &matrix(&base_pose))?;
        // The padding is that of the cloud.
        let links = self.described.self_filter(&joints, &base, 0.0).map_err(refused)?;
        let link = |link: cloudtouch::SelfMesh| {
            let pose = of_pose(py, &link.cloud_from_link);
            Ok((Body::of_link(link.mesh)?, pose))
        };
        links.into_iter().map(link).collect()
    }
}

/// A robot in its surroundings, which may change between two questions.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct RobotChecker {
    /// With nobody around.
    checker: Mutex<Checker>,
    surroundings: Py<Body>,
}

impl RobotChecker {
    /// What a thread that panicked left is whole: each change is made at once or not at all.
    fn lock(&self) -> MutexGuard<'_, Checker> {
        self.checker.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now(&self, py: Python<'_>) -> PyResult<Checker> {
        let mut checker = self.lock().clone();
        checker.replace_surroundings(self.surroundings.get().now(py)?).map_err(refused)?;
        Ok(checker)
    }
}

#[pymethods]
impl RobotChecker {
    #[new]
    #[pyo3(signature = (robot, surroundings, base_pose, self_collision, /))]
    fn new(
        robot: &Bound<'_, Robot>,
        surroundings: Bound<'_, Body>,
        base_pose: PyReadonlyArray2<'_, f64>,
        self_collision: bool,
    ) -> PyResult<Self> {
        let base: Pose = rigid("base_pose", &matrix(&base_pose))?;
        let touching = if self_collision { Touching::AndItself } else { Touching::Surroundings };
        let robot = Arc::clone(&robot.get().described);
        let checker = Checker::new(robot, nobody()?, base, touching).map_err(refused)?;
        Ok(Self { checker: Mutex::new(checker), surroundings: surroundings.unbind() })
    }

    /// Another in the same surroundings; what one of the two allows or holds is not seen by the other.
    fn copied(&self, py: Python<'_>) -> Self {
        let checker = Mutex::new(self.lock().clone());
        Self { checker, surroundings: self.surroundings.clone_ref(py) }
    }

    #[pyo3(signature = (a, b, /))]
    fn allow(&self, a: &str, b: &str) -> PyResult<()> {
        self.lock().allow(a, b).map_err(refused)
    }

    #[pyo3(signature = (name, body, link, link_from_body, /))]
    fn hold(
        &self,
        py: Python<'_>,
        name: &str,
        body: &Bound<'_, Body>,
        link: &str,
        link_from_body: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let pose = rigid("link_from_body", &matrix(&link_from_body))?;
        let body = body.get().now(py)?;
        self.lock().hold(name, body, link, pose).map_err(refused)
    }

    #[pyo3(signature = (name, /))]
    fn release(&self, name: &str) -> PyResult<()> {
        self.lock().release(name).map(|_| ()).map_err(refused)
    }

    #[pyo3(signature = (joints, /))]
    fn boxes(&self, py: Python<'_>, joints: Joints) -> PyResult<Vec<(String, [[f64; 3]; 2])>> {
        let boxes = self.now(py)?.boxes(&joints).map_err(refused)?;
        Ok(boxes.into_iter().map(|(name, of)| (name, box_of(of))).collect())
    }

    #[pyo3(signature = (query, joints, /))]
    fn check<'py>(
        &self,
        py: Python<'py>,
        query: &Bound<'py, Query>,
        joints: Joints,
    ) -> PyResult<Found<'py>> {
        let (checker, query) = (self.now(py)?, query.get().checked());
        let checked = on_all_threads(py, || checker.check(query, &joints))?;
        found(py, checked.map_err(refused)?)
    }

    #[pyo3(signature = (query, joints, /))]
    fn is_free(&self, py: Python<'_>, query: &Bound<'_, Query>, joints: Joints) -> PyResult<bool> {
        let (checker, query) = (self.now(py)?, query.get().checked());
        on_all_threads(py, || checker.is_free(query, &joints))?.map_err(refused)
    }

    #[pyo3(signature = (query, joints, title, height, /))]
    fn page(
        &self,
        py: Python<'_>,
        query: &Bound<'_, Query>,
        joints: Joints,
        title: String,
        height: Option<u32>,
    ) -> PyResult<String> {
        let scene = self.now(py)?.scene_at(&joints).map_err(refused)?;
        let first = Some(SURROUNDINGS);
        page::of_scene(py, query.get().checked(), &scene, first, (title, height))
    }

    #[pyo3(signature = (query, path, tolerance, /))]
    fn check_path<'py>(
        &self,
        py: Python<'py>,
        query: &Bound<'py, Query>,
        path: Vec<Joints>,
        tolerance: f64,
    ) -> PyResult<Along<'py>> {
        let (checker, query) = (self.now(py)?, query.get().checked());
        let checked = on_all_threads(py, || checker.check_path(query, &path, tolerance))?;
        let checked = checked.map_err(refused)?;
        let worst = checked.verdict().code();
        let PathChecked { given, certified_free_until, stopped, later, looked_at, .. } = checked;
        let given: PyResult<_> = given.into_iter().map(|at| found(py, at)).collect();
        let place = |at: Stopped| {
            let found = at.pair.map(|found| pair(py, found)).transpose()?;
            let nearest = at.nearest.map(|near| (near.a, near.b, near.at_most));
            PyResult::Ok((at.segment, at.t, found, nearest))
        };
        let [stopped, later] = [stopped, later].map(|at| at.map(place).transpose());
        Ok((given?, certified_free_until, (stopped?, later?), looked_at, worst))
    }
}
