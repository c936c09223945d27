//! Points, or points with faces.

use cloudtouch_geom::{PointCloud, TriangleMesh};

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Points without faces.
    Cloud(PointCloud),
    /// Vertices and at least one face.
    Mesh(TriangleMesh),
}
