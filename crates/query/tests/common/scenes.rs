//! Bodies of scenes, and what is found of them.

use cloudtouch::geom::{PointCloud, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Checked, Cloud, CloudSettings, Mesh, Query, QuerySettings};

use super::measured;

pub(crate) fn mesh(mesh: &TriangleMesh) -> Body {
    Mesh::prepare(mesh).expect("a good mesh").into()
}

pub(crate) fn cloud(mesh: &TriangleMesh, spacing: f64, std: f64, seed: u64) -> Body {
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    let points = PointCloud::from_points(measured(mesh, spacing, std, seed));
    Cloud::prepare(&points, &settings).expect("a good cloud").into()
}

pub(crate) fn query() -> Query {
    Query::new(QuerySettings::default()).expect("good settings")
}

/// The pairs told, in their order.
pub(crate) fn names(checked: &Checked) -> Vec<[&str; 2]> {
    checked.pairs.iter().map(|pair| [pair.a.as_str(), pair.b.as_str()]).collect()
}
