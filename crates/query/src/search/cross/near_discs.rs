//! The discs of a leaf that edges of another may pass, as far as most edges are told to miss them.

use cloudtouch_geom::{Point3, Vector3};

use crate::cloud::{DISC_SPACINGS, Surfel};

/// Memory for discs of a leaf and for the ends of edges that may pass them, to use again.
#[derive(Debug, Default)]
pub(in crate::search) struct Memory {
    pub(super) discs: Vec<NearDisc>,
    pub(super) ends: Vec<Told>,
}

/// The disc about a sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearDisc {
    /// Its place in its leaf.
    pub at: usize,
    pub middle: Point3,
    pub radius: f64,
    normal: Vector3,
}

/// What is told of an end of edges before any disc is asked: whether it is below all of them, above all of
/// them, and near, a bit each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told(u8);

impl NearDisc {
    /// `None` where no normal was fitted.
    pub(super) fn of(disc: &Surfel, at: usize) -> Option<Self> {
        let (middle, radius) = (disc.point.mean, DISC_SPACINGS * disc.spacing);
        disc.normal.map(|normal| Self { at, middle, radius, normal })
    }

    /// Whether an edge has its ends on two sides of it.
    pub(super) fn parts(&self, ends: &[Point3; 2]) -> bool {
        let height = |end: &Point3| (end - self.middle).dot(&self.normal);
        height(&ends[0]) * height(&ends[1]) < 0.0
    }

    /// Whether the middle of an edge is near enough to pass it.
    pub(super) fn is_within_reach(&self, middle: &Point3, half_length: f64) -> bool {
        let reach = half_length + self.radius;
        (self.middle - middle).norm_squared() <= reach * reach
    }
}

impl Told {
    pub(super) fn new([is_below, is_above]: [bool; 2], is_near: bool) -> Self {
        Self(u8::from(is_below) | u8::from(is_above) << 1 | u8::from(is_near) << 2)
    }

    /// Whether an edge from one to the other may pass a disc: not where both are on one side of all, or
    /// neither is near.
    pub(super) fn may_pass(self, to: Self) -> bool {
        self.0 & to.0 & 0b011 == 0 && (self.0 | to.0) & 0b100 != 0
    }
}
