//! The surface at the points of a leaf, and what encloses it: told once for all poses.

use std::sync::OnceLock;

use cloudtouch_geom::Vector3;

use super::ball::Ball;
use super::slab::Slab;
use super::surfel::Surfel;

/// The pieces of surface of a leaf, in the order of its points.
#[derive(Debug)]
pub(crate) struct LeafSurface {
    pub surfels: Vec<Surfel>,
    /// Around them.
    pub ball: Ball,
    /// Around their discs.
    pub slab: Slab,
    /// The same pieces with all that ends cut off, where that was asked for; never of a refined cloud, whose
    /// pieces have ended.
    pub ended: OnceLock<Vec<Surfel>>,
}

impl LeafSurface {
    /// Of a leaf that is thin along a unit vector.
    pub(in crate::cloud) fn new(surfels: Vec<Surfel>, thin: Vector3) -> Self {
        let (ball, slab) = (Ball::around(&surfels), Slab::around_discs(&surfels, thin));
        Self { surfels, ball, slab, ended: OnceLock::new() }
    }
}
