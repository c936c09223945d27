//! Clouds and meshes, made ready.

use std::sync::Arc;

use cloudtouch::geom::{
    Covariance, Matrix3, Point3, PointCloud, Pose, TriangleMesh, Vector3, unit,
};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body as Prepared, BodyRef, Cloud, CloudSettings, Mesh, OutlierSettings};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

use crate::arrays::{Rows, matrix};
use crate::error::{refused, refused_for};
use crate::pool::on_all_threads;

/// A prepared body; immutable, and shared by threads.
#[pyclass(frozen, module = "cloudtouch._native")]
pub(crate) struct Body {
    prepared: Arc<Prepared>,
    /// As it was given, for pickling: what is prepared has lost points that were filtered out.
    given: Given,
}

/// What a body was made of.
enum Given {
    Cloud(PointCloud),
    Mesh(TriangleMesh),
}

impl Body {
    pub(crate) fn get(&self) -> BodyRef<'_> {
        (&*self.prepared).into()
    }

    pub(crate) fn prepared(&self) -> &Arc<Prepared> {
        &self.prepared
    }

    /// The points kept, to the bit as they were given; the cells of a collision map were not given.
    fn kept(&self, cloud: &Cloud) -> Vec<Point3> {
        match &self.given {
            Given::Cloud(given) if !cloud.rows().is_empty() => {
                cloud.rows().iter().map(|&row| given.points[row]).collect()
            }
            _ => (0..cloud.len()).map(|i| cloud.point(i)).collect(),
        }
    }
}

#[pymethods]
impl Body {
    /// The points or vertices as given, m.
    fn given_points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        match &self.given {
            Given::Cloud(cloud) => rows(py, &cloud.points),
            Given::Mesh(mesh) => rows(py, mesh.vertices()),
        }
    }

    /// The triangles as given; none for a cloud.
    fn given_triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<i64>> {
        let triangles = match &self.given {
            Given::Cloud(_) => &[],
            Given::Mesh(mesh) => mesh.triangles(),
        };
        corners(py, triangles)
    }

    /// The points that the filter kept, or the merged vertices, m.
    fn points<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        match &*self.prepared {
            Prepared::Cloud(cloud) => rows(py, &self.kept(cloud)),
            Prepared::Mesh(mesh) => rows(py, &mesh.faces().0),
        }
    }

    /// The merged triangles; none for a cloud.
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<i64>> {
        match &*self.prepared {
            Prepared::Cloud(_) => corners(py, &[]),
            Prepared::Mesh(mesh) => corners(py, mesh.faces().1),
        }
    }

    /// For every kept point its row; empty after a collision map, and for a mesh.
    fn rows<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let rows = match &*self.prepared {
            Prepared::Cloud(cloud) => cloud.rows().iter().map(|&row| row as i64).collect(),
            Prepared::Mesh(_) => Vec::new(),
        };
        rows.into_pyarray(py)
    }

    /// How many points were kept, or triangles are left after merging.
    fn count(&self) -> usize {
        match &*self.prepared {
            Prepared::Cloud(cloud) => cloud.len(),
            Prepared::Mesh(mesh) => mesh.triangle_count(),
        }
    }

    /// What each stage of the filter removed.
    fn removed(&self) -> Vec<(&'static str, usize)> {
        match &*self.prepared {
            Prepared::Cloud(cloud) => {
                cloud.filter_stages().iter().map(|stage| (stage.stage, stage.removed)).collect()
            }
            Prepared::Mesh(_) => Vec::new(),
        }
    }

    /// Whether a mesh encloses a volume.
    fn is_watertight(&self) -> bool {
        matches!(&*self.prepared, Prepared::Mesh(mesh) if mesh.is_watertight())
    }

    fn prepare_seconds(&self) -> f64 {
        self.get().prepare_time().as_secs_f64()
    }
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
    outliers: Option<(usize, f64)>,
    collision_map: Option<f64>,
    refined: bool,
}

impl CloudArguments<'_> {
    fn settings(&self) -> PyResult<CloudSettings> {
        let sensor: SensorModel = self.sensor.parse().map_err(refused)?;
        let mut settings = CloudSettings::new(sensor);
        let filter = &mut settings.filter;
        filter.min_range = self.min_range.unwrap_or(filter.min_range);
        filter.max_range = self.max_range.unwrap_or(filter.max_range);
        let outliers = |(neighbors, deviations)| OutlierSettings { neighbors, deviations };
        filter.outliers = self.outliers.map(outliers).or(filter.outliers);
        if let Some(resolution) = self.collision_map {
            filter.collision_map = Some(resolution);
            settings.sensor = SensorModel::Grid { resolution };
        }
        Ok(settings)
    }

    fn cloud(&self, points: Vec<Point3>) -> PyResult<PointCloud> {
        let mut cloud = PointCloud::from_points(points);
        if let Some(array) = &self.sensor_pose {
            let pose = Pose::try_from_matrix(&matrix(array));
            cloud.sensor_pose = pose.map_err(|e| refused_for("sensor_pose", e))?;
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

/// A cloud, ready to be queried.
#[pyfunction]
#[pyo3(signature = (points, arguments, /))]
pub(crate) fn cloud(
    py: Python<'_>,
    points: Rows<'_>,
    arguments: CloudArguments<'_>,
) -> PyResult<Body> {
    let settings = arguments.settings()?;
    let given = arguments.cloud(points.points())?;
    let refined = arguments.refined;
    let prepared = on_all_threads(py, || {
        let cloud = Cloud::prepare(&given, &settings)?;
        if refined { cloud.refined() } else { Ok(cloud) }
    })?;
    let prepared = Arc::new(Prepared::Cloud(prepared.map_err(refused)?));
    Ok(Body { prepared, given: Given::Cloud(given) })
}

/// A mesh, ready to be queried. The indices are from 0 to what 32 bits hold.
#[pyfunction]
#[pyo3(signature = (vertices, triangles, /))]
pub(crate) fn mesh(
    py: Python<'_>,
    vertices: Rows<'_>,
    triangles: PyReadonlyArray2<'_, u32>,
) -> PyResult<Body> {
    let indices = triangles.as_array();
    let triangles = indices.rows().into_iter().map(|t| [t[0], t[1], t[2]]).collect();
    let given = TriangleMesh::try_new(vertices.points(), triangles).map_err(refused)?;
    let prepared = on_all_threads(py, || Mesh::prepare(&given))?;
    let prepared = Arc::new(Prepared::Mesh(prepared.map_err(refused)?));
    Ok(Body { prepared, given: Given::Mesh(given) })
}

/// Points as rows.
pub(crate) fn rows<'py>(py: Python<'py>, points: &[Point3]) -> Bound<'py, PyArray2<f64>> {
    table(points.iter().map(|p| p.coords)).into_pyarray(py)
}

/// Vectors as rows.
pub(crate) fn table(vectors: impl ExactSizeIterator<Item = Vector3>) -> Array2<f64> {
    let mut table = Array2::zeros((vectors.len(), 3));
    for (mut row, vector) in table.rows_mut().into_iter().zip(vectors) {
        row.iter_mut().zip(vector.iter()).for_each(|(entry, value)| *entry = *value);
    }
    table
}

/// Triangles as rows.
pub(crate) fn corners<'py>(py: Python<'py>, triangles: &[[u32; 3]]) -> Bound<'py, PyArray2<i64>> {
    let entry = |(row, column): (usize, usize)| i64::from(triangles[row][column]);
    Array2::from_shape_fn((triangles.len(), 3), entry).into_pyarray(py)
}
