//! A leaf that the search came by, with what is known of its points so far.

use std::borrow::Cow;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Point3, Vector3};

use crate::body::BodyRef;
use crate::cloud::{Cloud, DISC_SPACINGS, Edge, Surfel};
use crate::judge::MOST_DEVIATIONS;
use crate::mesh::Mesh;
use crate::report::Stats;

use super::facet::{Facet, Whitening};
use super::meeting::probability_at;

/// A leaf in the local frame of A: noisy pieces of surface, or exact ones.
#[derive(Debug)]
pub(crate) enum Leaf<'a> {
    Noisy(NoisyLeaf<'a>),
    Exact(ExactLeaf),
}

/// A leaf of a mesh.
#[derive(Debug)]
pub(crate) struct ExactLeaf {
    pub(super) facets: Vec<Facet>,
    pub(super) ball: Ball,
}

/// A leaf of a cloud.
#[derive(Debug)]
pub(crate) struct NoisyLeaf<'a> {
    pub surfels: Cow<'a, [Surfel]>,
    /// `None` until they are needed.
    edges: Option<Cow<'a, [Edge]>>,
    /// Between which heights these are.
    pub(super) edge_slab: Slab,
    /// For each surfel lengths in its standard deviations; empty until they are needed.
    whitenings: Vec<Whitening>,
    /// For each surfel the squared deviations to the nearest piece of the other body, at most those
    /// of [`MOST_DEVIATIONS`].
    pub squared: Vec<f64>,
    /// For each surfel the probability of its clearest crossing.
    pub crossing: Vec<f64>,
    /// For each surfel whether a mesh was looked at that passes through its disc.
    pub(super) is_pierced: Vec<bool>,
    pub(super) ball: Ball,
    pub(super) slab: Slab,
}

/// Between which heights along a direction all discs of a leaf lie, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slab {
    pub direction: Vector3,
    low: f64,
    high: f64,
}

/// What all pieces of a leaf are in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub middle: Point3,
    /// How far the mean of a piece is from there at most, m.
    pub radius: f64,
    /// The largest variance of a piece in any direction, m².
    pub variance: f64,
    /// The largest spacing, m.
    pub spacing: f64,
}

impl<'a> Leaf<'a> {
    /// A leaf of a body, moved to the frame of A by `motion`, or of A itself.
    pub(super) fn load(
        body: BodyRef<'a>,
        id: NodeId,
        motion: Option<&Motion>,
        stats: &mut Stats,
    ) -> Self {
        match body {
            BodyRef::Cloud(cloud) => Self::Noisy(NoisyLeaf::load(cloud, id, motion, stats)),
            BodyRef::Mesh(mesh) => Self::Exact(ExactLeaf::load(mesh, id, motion)),
        }
    }

    /// No piece of one leaf is nearer than this to a piece of the other, m.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let (ball, around) = (self.ball(), other.ball());
        let reach = |ball: &Ball| ball.radius + DISC_SPACINGS * ball.spacing;
        (ball.middle - around.middle).norm() - reach(ball) - reach(around)
    }

    fn ball(&self) -> &Ball {
        match self {
            Self::Noisy(leaf) => &leaf.ball,
            Self::Exact(leaf) => &leaf.ball,
        }
    }

    pub(super) fn middle(&self) -> Point3 {
        self.ball().middle
    }
}

impl ExactLeaf {
    fn load(mesh: &Mesh, id: NodeId, motion: Option<&Motion>) -> Self {
        let facets = facets_of(mesh, id, motion);
        let ball = Ball::around_points(facets.iter().flat_map(|facet| &facet.corners));
        Self { facets, ball }
    }
}

/// The triangles of a leaf of a mesh, moved to the frame of A by `motion`, or of A itself.
pub(super) fn facets_of(mesh: &Mesh, id: NodeId, motion: Option<&Motion>) -> Vec<Facet> {
    let indices = mesh.tree().leaf(id).map_or(&[][..], |leaf| leaf.primitive_indices());
    let facets = indices.iter().map(|&triangle| {
        let facet = Facet::new(triangle, mesh.corners(triangle as usize));
        motion.map_or(facet, |motion| facet.moved(motion))
    });
    facets.collect()
}

impl<'a> NoisyLeaf<'a> {
    /// A leaf of a cloud, moved to the frame of A by `motion`, or of A itself.
    fn load(cloud: &'a Cloud, id: NodeId, motion: Option<&Motion>, stats: &mut Stats) -> Self {
        let (surfels, computed) = cloud.leaf(id);
        stats.leaves_prepared += usize::from(computed);
        let surfels = match motion {
            None => Cow::Borrowed(surfels),
            Some(motion) => surfels.iter().map(|s| s.moved(motion)).collect(),
        };
        let squared = vec![MOST_DEVIATIONS.powi(2); surfels.len()];
        let crossing = vec![0.0; surfels.len()];
        let is_pierced = vec![false; surfels.len()];
        let ball = Ball::around(&surfels);
        // Along the thinnest side of its box a leaf is all but flat.
        let thin =
            cloud.tree().node(id).map_or_else(Vector3::z, |leaf| leaf.obb().axes.column(2).into());
        let slab = Slab::around(&surfels, motion.map_or(thin, |motion| motion.vector(&thin)));
        Self {
            surfels,
            edges: None,
            edge_slab: Slab::empty(slab.direction),
            whitenings: Vec::new(),
            squared,
            crossing,
            is_pierced,
            ball,
            slab,
        }
    }

    /// Lengths in the standard deviations of each surfel, beside what is changed with them.
    pub(super) fn whitened(&mut self) -> (&[Surfel], &[Whitening], &mut [f64]) {
        if self.whitenings.is_empty() {
            self.whitenings = self.surfels.iter().map(Whitening::of).collect();
        }
        (&self.surfels, &self.whitenings, &mut self.squared)
    }

    /// Gets its edges, once.
    pub(super) fn load_edges(&mut self, cloud: &'a Cloud, id: NodeId, motion: Option<&Motion>) {
        if self.edges.is_some() {
            return;
        }
        let edges = cloud.leaf_edges(id);
        let edges: Cow<'_, [Edge]> = match motion {
            None => Cow::Borrowed(edges),
            Some(motion) => edges.iter().map(|e| e.moved(motion)).collect(),
        };
        for end in edges.iter().flat_map(|edge| &edge.ends) {
            self.edge_slab.include(end, 0.0);
        }
        self.edges = Some(edges);
    }

    /// None before they were loaded.
    pub(super) fn edges(&self) -> &[Edge] {
        self.edges.as_deref().unwrap_or_default()
    }

    /// How likely each piece is to collide, by geometry: halfway between two equally well known
    /// pieces a plane is z/√2 deviations from either. Beyond `within` deviations only some are known,
    /// and none counts.
    pub(crate) fn probabilities(&self, within: f64) -> impl Iterator<Item = (&Surfel, f64)> {
        let within = within.min(MOST_DEVIATIONS).powi(2);
        let of = move |(&squared, &crossing): (&f64, &f64)| {
            let is_near = squared < within;
            let by_gap = if is_near { probability_at(squared.sqrt()) } else { 0.0 };
            by_gap.max(crossing)
        };
        self.surfels.iter().zip(self.squared.iter().zip(&self.crossing).map(of))
    }
}

impl Slab {
    fn around(surfels: &[Surfel], direction: Vector3) -> Self {
        let mut slab = Self::empty(direction);
        for surfel in surfels {
            if let Some(reach) = surfel.disc_reach(&slab.direction) {
                slab.include(&surfel.point.mean, reach);
            }
        }
        slab
    }

    fn empty(direction: Vector3) -> Self {
        Self { direction, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    /// Grows to what reaches so far (m) from the height of a place.
    fn include(&mut self, place: &Point3, reach: f64) {
        let height = place.coords.dot(&self.direction);
        self.low = self.low.min(height - reach);
        self.high = self.high.max(height + reach);
    }

    /// Whether it holds a place of the disc about a surfel.
    pub(super) fn may_hold_disc_of(&self, surfel: &Surfel) -> bool {
        let reach = surfel.disc_reach(&self.direction);
        reach.is_some_and(|reach| self.is_within(&surfel.point.mean, reach))
    }

    /// Whether a place is at most so far from the height of some disc.
    pub(super) fn is_within(&self, place: &Point3, distance: f64) -> bool {
        let height = place.coords.dot(&self.direction);
        self.low - distance <= height && height <= self.high + distance
    }

    /// Whether some place between two ends may be so near to the height of a disc, m.
    pub(super) fn may_hold(&self, ends: &[Point3; 2], distance: f64) -> bool {
        let [from, to] = ends;
        let (from, to) = (from.coords.dot(&self.direction), to.coords.dot(&self.direction));
        from.max(to) + distance >= self.low && from.min(to) - distance <= self.high
    }
}

impl Ball {
    fn around_points<'p>(points: impl Iterator<Item = &'p Point3> + Clone) -> Self {
        let count = points.clone().count().max(1);
        let sum: Vector3 = points.clone().map(|p| p.coords).sum();
        let middle = Point3::from(sum / count as f64);
        let radius = points.map(|p| (p - middle).norm()).fold(0.0, f64::max);
        Self { middle, radius, variance: 0.0, spacing: 0.0 }
    }

    fn around(surfels: &[Surfel]) -> Self {
        let sum: Vector3 = surfels.iter().map(|s| s.point.mean.coords).sum();
        let middle = Point3::from(sum / surfels.len() as f64);
        let mut ball = Self { middle, radius: 0.0, variance: 0.0, spacing: 0.0 };
        for surfel in surfels {
            ball.radius = ball.radius.max((surfel.point.mean - middle).norm_squared());
            ball.variance = ball.variance.max(surfel.most_variance);
            ball.spacing = ball.spacing.max(surfel.spacing);
        }
        ball.radius = ball.radius.sqrt();
        ball
    }

    /// Whether a place is at most so far from some place in the ball; never no by rounding.
    pub(super) fn is_within(&self, place: &Point3, distance: f64) -> bool {
        const ROUNDING: f64 = 1e-9;
        let reach = (self.radius + distance) * (1.0 + ROUNDING);
        (place - self.middle).norm_squared() <= reach * reach
    }
}
