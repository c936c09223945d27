//! Clouds and meshes, made ready: what they hold, and how they change.

use std::sync::{Arc, PoisonError, RwLock};

use cloudtouch::geom::{Covariance, Matrix3, Point3, PointCloud, Pose, TriangleMesh, unit};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Body as Prepared, BodyRef, Change, ChangeError, Cloud, CloudSettings, Mesh, OutlierSettings,
    SelfMesh,
};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

use crate::arrays::{Rows, matrix};
use crate::error::{refused, refused_for};
use crate::pool::pool;
use crate::rows::{corners, rows, table};
use crate::sensor::stated;

/// A prepared body, shared by threads.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Body {
    state: RwLock<State>,
}

struct State {
    /// Held by others only while they ask.
    prepared: Arc<Prepared>,
    /// As it was given, for pickling: what is prepared has lost points that were filtered out. None once it
    /// was changed.
    given: Option<Given>,
}

/// What a body was made of.
pub(crate) enum Given {
    Cloud(PointCloud),
    Mesh(TriangleMesh),
}

impl Body {
    pub(crate) fn new(prepared: impl Into<Prepared>, given: Given) -> Self {
        let state = State { prepared: Arc::new(prepared.into()), given: Some(given) };
        Self { state: RwLock::new(state) }
    }

    /// As it is now, to be held while it is asked about. Waits for a change, and lets others run meanwhile.
    pub(crate) fn now(&self, py: Python<'_>) -> PyResult<Arc<Prepared>> {
        py.detach(|| self.state.read().map(|state| Arc::clone(&state.prepared)).map_err(broken))
    }

    /// A link of a robot, given as its prepared mesh.
    pub(crate) fn of_link(mesh: Arc<Mesh>) -> PyResult<Self> {
        let (vertices, triangles) = mesh.faces();
        let given = TriangleMesh::new(vertices, triangles.to_vec()).map_err(refused)?;
        Ok(Self::new(mesh, Given::Mesh(given)))
    }

    /// A mesh as a link that a camera saw.
    pub(crate) fn mesh(&self, py: Python<'_>) -> PyResult<Arc<Mesh>> {
        match &*self.now(py)? {
            Prepared::Mesh(mesh) => Ok(Arc::clone(mesh)),
            Prepared::Cloud(_) => Err(refused("a link of a robot is a Mesh")),
        }
    }

    /// Changes a cloud in its place, on all threads.
    fn change(
        &self,
        py: Python<'_>,
        change: impl FnOnce(&mut Cloud) -> Result<Change, ChangeError> + Send,
    ) -> PyResult<Change> {
        let pool = pool()?;
        py.detach(|| {
            // Out of the pool: a thread of it that waits for its part could take up another change.
            let mut state = self.state.write().map_err(broken)?;
            match Arc::get_mut(&mut state.prepared) {
                Some(Prepared::Cloud(cloud)) => {
                    let done = pool.install(|| change(cloud)).map_err(refused)?;
                    state.given = None;
                    Ok(done)
                }
                Some(Prepared::Mesh(_)) => Err(refused("a mesh does not change")),
                None => Err(refused(
                    "the cloud is being asked about by another thread, or a robot holds it: change it between queries, or have \
                     the robot hold it anew",
                )),
            }
        })
    }
}

/// A change that panicked may have left half of it.
fn broken<T>(_: PoisonError<T>) -> PyErr {
    refused("a change of this cloud did not come to its end: make it anew")
}

#[pymethods]
impl Body {
    /// The points or vertices as given, m; none once they were changed.
    fn given_points<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        Ok(match &self.state.read().map_err(broken)?.given {
            Some(Given::Cloud(cloud)) => Some(rows(py, &cloud.points)),
            Some(Given::Mesh(mesh)) => Some(rows(py, mesh.vertices())),
            None => None,
        })
    }

    /// The triangles as given; none for a cloud.
    fn given_triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        Ok(match &self.state.read().map_err(broken)?.given {
            Some(Given::Mesh(mesh)) => corners(py, mesh.triangles()),
            _ => corners(py, &[]),
        })
    }

    /// The points that the cloud has, or the merged vertices, m.
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        Ok(match &*self.now(py)? {
            Prepared::Cloud(cloud) => {
                table((0..cloud.len()).map(|i| cloud.point(i).coords)).into_pyarray(py)
            }
            Prepared::Mesh(mesh) => rows(py, &mesh.faces().0),
        })
    }

    /// The merged triangles; none for a cloud.
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        Ok(match &*self.now(py)? {
            Prepared::Cloud(_) => corners(py, &[]),
            Prepared::Mesh(mesh) => corners(py, mesh.faces().1),
        })
    }

    /// For every kept point its row; empty after a collision map, and for a mesh.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let rows = match &*self.now(py)? {
            Prepared::Cloud(cloud) => cloud.rows().iter().map(|&row| row as i64).collect(),
            Prepared::Mesh(_) => Vec::new(),
        };
        Ok(rows.into_pyarray(py))
    }

    /// How many points were kept, or triangles are left after merging.
    fn count(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(match &*self.now(py)? {
            Prepared::Cloud(cloud) => cloud.len(),
            Prepared::Mesh(mesh) => mesh.triangle_count(),
        })
    }

    /// What each stage of the filter removed.
    fn removed(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, usize)>> {
        Ok(match &*self.now(py)? {
            Prepared::Cloud(cloud) => {
                cloud.filter_stages().iter().map(|stage| (stage.stage, stage.removed)).collect()
            }
            Prepared::Mesh(_) => Vec::new(),
        })
    }

    /// Whether a mesh encloses a volume.
    fn is_watertight(&self, py: Python<'_>) -> PyResult<bool> {
        Ok(matches!(&*self.now(py)?, Prepared::Mesh(mesh) if mesh.is_watertight()))
    }

    fn prepare_seconds(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(BodyRef::from(&*self.now(py)?).prepare_time().as_secs_f64())
    }

    #[pyo3(signature = (points, arguments, /))]
    fn insert(
        &self,
        py: Python<'_>,
        points: Rows<'_>,
        arguments: CloudArguments<'_>,
    ) -> PyResult<Changed> {
        let (settings, scan) = (arguments.settings(py)?, arguments.cloud(points.points())?);
        self.change(py, |cloud| cloud.insert(&scan, &settings)).map(changed)
    }

    #[pyo3(signature = (points, arguments, /))]
    fn replace_frame(
        &self,
        py: Python<'_>,
        points: Rows<'_>,
        arguments: CloudArguments<'_>,
    ) -> PyResult<Changed> {
        let (settings, frame) = (arguments.settings(py)?, arguments.cloud(points.points())?);
        self.change(py, |cloud| cloud.replace_frame(&frame, &settings)).map(changed)
    }

    #[pyo3(signature = (indices, /))]
    fn remove(&self, py: Python<'_>, indices: Vec<usize>) -> PyResult<Changed> {
        self.change(py, |cloud| cloud.remove(&indices)).map(changed)
    }

    #[pyo3(signature = (indices, places, /))]
    fn move_points(
        &self,
        py: Python<'_>,
        indices: Vec<usize>,
        places: Rows<'_>,
    ) -> PyResult<Changed> {
        let moves: Vec<(usize, Point3)> = indices.into_iter().zip(places.points()).collect();
        self.change(py, |cloud| cloud.move_points(&moves)).map(changed)
    }

    fn rebuild(&self, py: Python<'_>) -> PyResult<Changed> {
        self.change(py, Cloud::rebuild).map(changed)
    }
}

/// The fields of `cloudtouch.Change`, in their order.
type Changed = (usize, usize, usize, usize, usize, bool, bool);

fn changed(change: Change) -> Changed {
    let Change { inserted, removed, moved, surfaces_kept, surfaces_lost, .. } = change;
    let Change { is_recentred, is_rebuilt, .. } = change;
    (inserted, removed, moved, surfaces_kept, surfaces_lost, is_recentred, is_rebuilt)
}

/// What a cloud is made of beside its points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CloudArguments<'py> {
    sensor: String,
    sensor_pose: Option<PyReadonlyArray2<'py, f64>>,
    image_size: Option<(usize, usize)>,
    covariances: Option<PyReadonlyArray3<'py, f64>>,
    normals: Option<Rows<'py>>,
    min_range: Option<f64>,
    max_range: Option<f64>,
    keep_veil: bool,
    outliers: Option<(usize, f64)>,
    collision_map: Option<f64>,
    robot: Vec<(Bound<'py, Body>, PyReadonlyArray2<'py, f64>, f64)>,
    pub(crate) refined: bool,
}

impl CloudArguments<'_> {
    pub(crate) fn settings(&self, py: Python<'_>) -> PyResult<CloudSettings> {
        let mut settings = CloudSettings::new(stated(&self.sensor).map_err(refused)?);
        let filter = &mut settings.filter;
        filter.min_range = self.min_range.or(filter.min_range);
        filter.max_range = self.max_range.unwrap_or(filter.max_range);
        filter.veil = filter.veil.filter(|_| !self.keep_veil);
        let outliers = |(neighbors, deviations)| OutlierSettings { neighbors, deviations };
        filter.outliers = self.outliers.map(outliers).or(filter.outliers);
        for (link, pose, padding) in &self.robot {
            let cloud_from_link = Pose::try_from_matrix(&matrix(pose));
            let cloud_from_link = cloud_from_link.map_err(|e| refused_for("robot", e))?;
            let mesh = link.get().mesh(py)?;
            filter.robot.push(SelfMesh { mesh, cloud_from_link, padding: *padding });
        }
        if let Some(resolution) = self.collision_map {
            if resolution <= 0.0 {
                let why = format!("cells of {resolution} m: give their edge, such as 0.02");
                return Err(refused_for("collision_map", why));
            }
            filter.collision_map = Some(resolution);
            settings.sensor = SensorModel::Grid { resolution };
        }
        Ok(settings)
    }

    pub(crate) fn cloud(&self, points: Vec<Point3>) -> PyResult<PointCloud> {
        let mut cloud = PointCloud::from_points(points);
        if let Some(array) = &self.sensor_pose {
            let pose = Pose::try_from_matrix(&matrix(array));
            cloud.sensor_pose = Some(pose.map_err(|e| refused_for("sensor_pose", e))?);
        }
        cloud.image_size = self.image_size;
        if let Some(array) = &self.covariances {
            let view = array.as_array();
            let one = |(i, m): (usize, numpy::ndarray::ArrayView2<'_, f64>)| {
                let covariance = Covariance::try_from_matrix(&Matrix3::from_fn(|r, c| m[(r, c)]));
                covariance.map_err(|e| refused_for(format!("covariances[{i}]"), e))
            };
            let all: PyResult<Vec<Covariance>> = view.outer_iter().enumerate().map(one).collect();
            cloud.covariances = Some(all?);
        }
        if let Some(array) = &self.normals {
            let one = |(i, p): (usize, &Point3)| {
                unit(&p.coords).map_err(|e| refused_for(format!("normals[{i}]"), e))
            };
            let all: PyResult<Vec<_>> = array.points().iter().enumerate().map(one).collect();
            cloud.normals = Some(all?);
        }
        Ok(cloud)
    }
}
