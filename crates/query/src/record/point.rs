//! A point of either body and what a query says of it.

use cloudtouch_geom::Point3;

/// Which body a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Side {
    A,
    B,
}

/// The probability of one point, by the surface that separates its leaf pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointProbability {
    pub side: Side,
    /// Index in the prepared cloud; `None` for a point of a mesh.
    pub index: Option<u32>,
    /// In the local frame of A.
    pub position: Point3,
    pub probability: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
}
