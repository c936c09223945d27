//! A leaf that the search came by, with what is known of its points so far.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::rc::Rc;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Point3};

use crate::body::BodyRef;
use crate::cloud::{Ball, Cloud, DISC_SPACINGS, Edge, LeafEdges, LeafSurface, Slab, Surfel};
use crate::judge::MOST_DEVIATIONS;
use crate::mesh::Mesh;
use crate::stats::Stats;

use super::side::Side;
use crate::search::compare::facet::Facet;
use crate::search::compare::meeting::probability_at;
use crate::search::compare::whitening::Whitening;
use crate::search::measure::compared::Compared;

/// A leaf in the local frame of A: noisy pieces of surface, or exact ones.
#[derive(Debug)]
pub(crate) enum Leaf<'a> {
    Noisy(NoisyLeaf<'a>),
    Exact(ExactLeaf),
}

/// How far the pieces of two leaves are from one another, by the balls around them.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Between {
    /// The means are at least so far apart, m.
    pub of_means: f64,
    /// The surfaces that these stand for too, m.
    pub of_surfaces: f64,
    /// Two of them have no larger standard deviation together in any direction, m.
    pub most_std: f64,
}

/// A leaf of a mesh.
#[derive(Debug)]
pub(crate) struct ExactLeaf {
    pub(in crate::search) facets: Rc<Vec<Facet>>,
    pub(in crate::search) ball: Ball,
}

/// A leaf of a cloud.
#[derive(Debug)]
pub(crate) struct NoisyLeaf<'a> {
    pub(in crate::search) cloud: &'a Cloud,
    pub(super) id: NodeId,
    /// Whether of any piece it is open where it ends.
    pub(super) may_end: bool,
    pub surfels: Cow<'a, [Surfel]>,
    /// Where they were measured, for most are told to be far from another leaf before they are moved;
    /// `None` until they are needed.
    pub(in crate::search) edges: Option<&'a LeafEdges>,
    /// For each surfel lengths in its standard deviations, once they are needed.
    pub(super) whitenings: Vec<OnceCell<Whitening>>,
    /// For each surfel the squared deviations to the nearest piece of the other body, at most those
    /// of [`MOST_DEVIATIONS`].
    pub squared: Vec<f64>,
    /// For each surfel the probability of its clearest crossing; empty until there is one.
    crossing: Vec<f64>,
    /// For each surfel whether a mesh was looked at that passes through its disc; empty where none was.
    is_pierced: Vec<bool>,
    /// What of a mesh it was compared with.
    pub(in crate::search) compared: Compared,
    pub(in crate::search) ball: Ball,
    /// Around its discs.
    pub(in crate::search) slab: Slab,
}

impl<'a> Leaf<'a> {
    /// A leaf of a body, moved to the frame of A.
    pub(in crate::search) fn load(
        body: BodyRef<'a>,
        id: NodeId,
        side: &mut Side,
        stats: &mut Stats,
    ) -> Self {
        match body {
            BodyRef::Cloud(cloud) => Self::Noisy(NoisyLeaf::load(cloud, id, side, stats)),
            BodyRef::Mesh(mesh) => {
                Self::Exact(ExactLeaf::of(Rc::new(facets_of(mesh, id, side.motion.as_ref()))))
            }
        }
    }

    /// How far the pieces of one leaf are from those of the other.
    pub(in crate::search) fn between(&self, other: &Self) -> Between {
        /// Of the distance of the balls and their radii, generously.
        const ROUNDING: f64 = 1e-9;
        let (ball, around) = (self.ball(), other.ball());
        let (way, radii) = ((ball.middle - around.middle).norm(), ball.radius + around.radius);
        let of_means = way - radii - ROUNDING * (way + radii);
        Between {
            of_means,
            of_surfaces: of_means - DISC_SPACINGS * (ball.spacing + around.spacing),
            most_std: (ball.variance + around.variance).sqrt(),
        }
    }

    fn ball(&self) -> &Ball {
        match self {
            Self::Noisy(leaf) => &leaf.ball,
            Self::Exact(leaf) => &leaf.ball,
        }
    }

    pub(in crate::search) fn middle(&self) -> Point3 {
        self.ball().middle
    }
}

impl ExactLeaf {
    pub(super) fn of(facets: Rc<Vec<Facet>>) -> Self {
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
    /// A leaf of a cloud, moved to the frame of A.
    fn load(cloud: &'a Cloud, id: NodeId, side: &mut Side, stats: &mut Stats) -> Self {
        let prepared = cloud.prepared();
        let (leaf, computed) = match prepared.known_leaf(id) {
            Some(leaf) => (leaf, false),
            None => prepared.leaf_surface(id, side.scratch()),
        };
        stats.leaves_prepared += usize::from(computed);
        let LeafSurface { surfels, ball, slab, .. } = leaf;
        let surfels = prepared.known_ended(id).unwrap_or(surfels);
        let count = surfels.len();
        let may_end = surfels.iter().any(Surfel::may_end);
        let (surfels, ball, slab) = match &side.motion {
            None => (Cow::Borrowed(surfels), *ball, *slab),
            Some(motion) => (
                surfels.iter().map(|s| s.moved(motion)).collect(),
                ball.moved(motion),
                slab.moved(motion),
            ),
        };
        Self {
            cloud,
            id,
            may_end,
            surfels,
            edges: None,
            whitenings: Vec::new(),
            squared: vec![MOST_DEVIATIONS.powi(2); count],
            crossing: Vec::new(),
            is_pierced: Vec::new(),
            compared: Compared::default(),
            ball,
            slab,
        }
    }

    /// Makes room for the whitenings of its surfels.
    pub(in crate::search) fn make_room(&mut self) {
        if self.whitenings.is_empty() {
            self.whitenings.resize_with(self.surfels.len(), OnceCell::new);
        }
    }

    /// Lengths in the standard deviations of a surfel; asked for after there is room.
    pub(in crate::search) fn whitening(&self, place: usize) -> &Whitening {
        // PERF: most pieces are told to be far beforehand.
        self.whitenings[place].get_or_init(|| Whitening::of(&self.surfels[place]))
    }

    /// Gets its edges, once.
    pub(in crate::search) fn load_edges(&mut self, side: &mut Side) {
        self.has_edges_or(|_| true, side);
    }

    /// Gets them where they are known, or where it is worth to join what they lead to; whether it has them.
    pub(in crate::search) fn has_edges_or(
        &mut self,
        are_worth: impl FnOnce(&Self) -> bool,
        side: &mut Side,
    ) -> bool {
        if self.edges.is_none() {
            let prepared = self.cloud.prepared();
            self.edges = prepared.known_edges(self.id);
            if self.edges.is_none() && are_worth(self) {
                self.edges = Some(prepared.leaf_edges(self.id, side.scratch()));
            }
        }
        self.edges.is_some()
    }

    /// Notes a crossing of an edge for the points that it joins.
    pub(in crate::search) fn raise_ends(&mut self, edge: &Edge, probability: f64) {
        edge.own_places().for_each(|place| self.raise(place, probability));
    }

    /// Notes a crossing of the disc about a surfel.
    pub(in crate::search) fn raise(&mut self, place: usize, probability: f64) {
        if self.crossing.is_empty() {
            self.crossing.resize(self.surfels.len(), 0.0);
        }
        self.crossing[place] = self.crossing[place].max(probability);
    }

    /// Whether a mesh was looked at that passes through the disc about a surfel.
    pub(in crate::search) fn is_pierced(&self, place: usize) -> bool {
        self.is_pierced.get(place).is_some_and(|&is_pierced| is_pierced)
    }

    /// Notes that one was.
    pub(in crate::search) fn set_pierced(&mut self, place: usize) {
        if self.is_pierced.is_empty() {
            self.is_pierced.resize(self.surfels.len(), false);
        }
        self.is_pierced[place] = true;
    }

    /// How likely each piece is to collide, by geometry: halfway between two equally well known
    /// pieces a plane is z/√2 deviations from either. Beyond `within` deviations only some are known,
    /// and none counts.
    pub(crate) fn probabilities(&self, within: f64) -> impl Iterator<Item = (&Surfel, f64)> {
        let within = within.min(MOST_DEVIATIONS).powi(2);
        let crossing = self.crossing.iter().copied().chain(std::iter::repeat(0.0));
        let of = move |(&squared, crossing): (&f64, f64)| {
            let is_near = squared < within;
            let by_gap = if is_near { probability_at(squared.sqrt()) } else { 0.0 };
            by_gap.max(crossing)
        };
        self.surfels.iter().zip(self.squared.iter().zip(crossing).map(of))
    }
}
