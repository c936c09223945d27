//! The points of a leaf pair or of a contact patch, and what a classifier says of them.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};
use cloudtouch_svm::Class;

use crate::cloud::Surfel;

use super::surface::Surface;

/// A point on one side of a leaf pair, in the local frame of A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairPoint {
    /// Index in the prepared cloud; `None` for a point of a mesh.
    pub index: Option<u32>,
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// r of its ellipsoid, where it brings one of its own.
    pub radius: Option<f64>,
}

impl From<&Surfel> for PairPoint {
    /// A piece of surface that is in the local frame of A already.
    fn from(surfel: &Surfel) -> Self {
        Self {
            index: Some(surfel.index),
            point: surfel.point,
            spacing: surfel.spacing,
            radius: None,
        }
    }
}

/// The points of the two leaves.
#[derive(Debug, Default)]
pub(crate) struct PairPoints {
    pub a: Vec<PairPoint>,
    pub b: Vec<PairPoint>,
    /// Whether the points of that side are exact points of a mesh.
    pub a_is_mesh: bool,
    pub b_is_mesh: bool,
}

impl PairPoints {
    /// The same whichever body is called A: first the side with fewer points, or of as many the one whose points are closer
    /// together. The solver goes through them in their order and ends within its tolerance.
    pub(crate) fn in_order(self) -> Self {
        let counts = self.a.len().cmp(&self.b.len());
        if counts.then_with(|| spread(&self.a).total_cmp(&spread(&self.b))).is_le() {
            return self;
        }
        Self { a: self.b, b: self.a, a_is_mesh: self.b_is_mesh, b_is_mesh: self.a_is_mesh }
    }
}

/// Sum of the squared distances of some points from their middle, m^2; there must be one.
fn spread(points: &[PairPoint]) -> f64 {
    let middle = centroid(points);
    points.iter().map(|p| (p.point.mean - middle).norm_squared()).sum()
}

/// What a leaf pair says.
#[derive(Debug)]
pub(crate) enum PairAnswer {
    /// A surface separates the pair, with these probabilities of the points of A and of B.
    Separated { surface: Surface, a: Vec<f64>, b: Vec<f64> },
    /// The uncertainty is as large as the pair itself: nothing separates it, nothing joins it.
    Indistinct,
    /// No solver reached an answer.
    Undecided,
}

impl PairAnswer {
    /// The probabilities that a surface gives the points; `None` when one of them is not a number.
    pub(crate) fn of(surface: Surface, a: &[UncertainPoint], b: &[UncertainPoint]) -> Option<Self> {
        let side = |points: &[UncertainPoint], class| {
            points.iter().map(|p| surface.probability(p, class)).collect::<Option<Vec<f64>>>()
        };
        let (a, b) = (side(a, Class::A)?, side(b, Class::B)?);
        Some(Self::Separated { surface, a, b })
    }

    /// The largest probability of a point; 1 without an answer.
    pub(crate) fn largest(&self) -> f64 {
        match self {
            Self::Separated { a, b, .. } => a.iter().chain(b).copied().fold(0.0, f64::max),
            Self::Indistinct | Self::Undecided => 1.0,
        }
    }
}

/// Mean position of some points, of which there must be one.
pub(crate) fn centroid(points: &[PairPoint]) -> Point3 {
    let sum: Vector3 = points.iter().map(|p| p.point.mean.coords).sum();
    Point3::from(sum / points.len() as f64)
}
