//! Leaves of a search among surfaces of which one drifts: what is told once of a leaf for all others that
//! it meets.

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Matrix3, Motion, Vector3};

use crate::body::BodyRef;
use crate::cloud::{Cloud, DISC_SPACINGS, Edge, LeafEdges, Surfel};
use crate::stats::Stats;

use super::course::Course;
use super::hull::Hull;
use super::layer::{ExactLayer, Layer, span};
use super::track::{Direction, SweptFacet, Track};
use crate::search::compare::facet::Facet;
use crate::search::visit::leaf::{ExactLeaf, Leaf, NoisyLeaf};
use crate::search::visit::side::Side;

/// A leaf in the frame of A, and where its pieces get to.
#[derive(Debug)]
pub(super) enum Swept<'a> {
    Noisy(Box<SweptCloud<'a>>),
    Exact(SweptMesh),
}

/// A leaf of a mesh.
#[derive(Debug)]
pub(super) struct SweptMesh {
    pub leaf: ExactLeaf,
    /// Of the corners of its facets.
    tracks: Vec<[Track; 3]>,
    /// `None` where none of them has a normal.
    pub layer: Option<ExactLayer>,
}

/// A leaf of a cloud.
#[derive(Debug)]
pub(super) struct SweptCloud<'a> {
    pub leaf: NoisyLeaf<'a>,
    /// Of its pieces.
    pub tracks: Vec<Track>,
    /// About its discs.
    pub discs: Option<Hull>,
    pub layer: Layer,
    /// From where it was measured to the frame of A; `None` for one of A.
    pub motion: Option<Motion>,
    axes: Matrix3,
    edges: Option<SweptEdges>,
}

/// The edges of a leaf.
#[derive(Debug)]
pub(super) struct SweptEdges {
    /// In the frame of A.
    pub all: Vec<Edge>,
    pub tracks: Vec<EdgeTrack>,
    /// About all of them; `None` where there are none.
    pub hull: Option<Hull>,
}

/// Where an edge gets to.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeTrack {
    pub middle: Track,
    pub ends: [Track; 2],
}

impl<'a> Swept<'a> {
    /// A leaf of a body, moved to the frame of A.
    pub(super) fn load(
        body: BodyRef<'a>,
        id: NodeId,
        side: &mut Side,
        drift: &Course,
        stats: &mut Stats,
    ) -> Self {
        match Leaf::load(body, id, side, stats) {
            Leaf::Noisy(mut leaf) => {
                // Less noise takes less of the way.
                leaf.end_all(side);
                let axes = axes_of(leaf.cloud, id, side.motion.as_ref());
                Self::Noisy(Box::new(SweptCloud::new(leaf, side.motion, axes, drift)))
            }
            Leaf::Exact(leaf) => Self::Exact(SweptMesh::new(leaf, drift)),
        }
    }
}

/// The axes of the box of a leaf, as columns.
fn axes_of(cloud: &Cloud, id: NodeId, motion: Option<&Motion>) -> Matrix3 {
    let axes = cloud.tree().node(id).map_or_else(Matrix3::identity, |leaf| leaf.obb().axes);
    motion.map_or(axes, |motion| motion.rotation() * axes)
}

impl SweptMesh {
    fn new(leaf: ExactLeaf, drift: &Course) -> Self {
        let track = |facet: &Facet| facet.corners.map(|corner| Track::of(&corner, drift));
        let tracks: Vec<[Track; 3]> = leaf.facets.iter().map(track).collect();
        let normal = leaf.facets.iter().find_map(|facet| facet.normal);
        let layer = normal.map(|n| ExactLayer::around(&tracks, Direction::new(n, drift)));
        Self { leaf, tracks, layer }
    }

    pub(super) fn facets(&self) -> impl Iterator<Item = SweptFacet<'_>> {
        let all = self.leaf.facets.iter().zip(&self.tracks);
        all.map(|(facet, corners)| SweptFacet { facet, corners })
    }
}

impl<'a> SweptCloud<'a> {
    fn new(leaf: NoisyLeaf<'a>, motion: Option<Motion>, axes: Matrix3, drift: &Course) -> Self {
        let tracks = leaf.surfels.iter().map(|s| Track::of(&s.point.mean, drift)).collect();
        let of_disc = |s: &Surfel| {
            let normal = s.normal?;
            let sine = |cosine: f64| (1.0 - cosine * cosine).max(0.0).sqrt();
            let reach = axes.tr_mul(&normal).map(sine) * (DISC_SPACINGS * s.spacing);
            Some((s.point.mean, reach))
        };
        let discs = Hull::around(&axes, leaf.surfels.iter().filter_map(of_disc), drift);
        let layer = Layer::around(&leaf.surfels, Direction::new(leaf.slab.direction, drift));
        Self { leaf, tracks, discs, layer, motion, axes, edges: None }
    }

    /// Gets its edges, once.
    pub(super) fn load_edges(&mut self, drift: &Course, side: &mut Side) {
        if self.edges.is_none() {
            self.leaf.load_edges(side);
            let motion = self.motion.as_ref();
            self.edges =
                self.leaf.edges.map(|edges| SweptEdges::new(edges, motion, &self.axes, drift));
        }
    }

    /// `None` before they were loaded.
    pub(super) fn edges(&self) -> Option<&SweptEdges> {
        self.edges.as_ref()
    }
}

impl SweptEdges {
    fn new(edges: &LeafEdges, motion: Option<&Motion>, axes: &Matrix3, drift: &Course) -> Self {
        let moved = |edge: Edge| motion.map_or(edge, |motion| edge.moved(motion));
        let all: Vec<Edge> = edges.iter().map(moved).collect();
        let ends = all.iter().flat_map(|edge| edge.ends);
        let hull = Hull::around(axes, ends.map(|end| (end, Vector3::zeros())), drift);
        // PERF: where an end gets to is told once for all edges there.
        let mut known: Vec<Option<Track>> = vec![None; edges.ends().len()];
        let tracks = edges.joints().iter().zip(&all).map(|(joint, edge)| {
            let places = joint.places();
            let ends = [0, 1]
                .map(|k| *known[places[k]].get_or_insert_with(|| Track::of(&edge.ends[k], drift)));
            EdgeTrack::of(edge, ends)
        });
        let tracks = tracks.collect();
        Self { all, tracks, hull }
    }

    /// Between which heights along a unit vector all of them are, m; never too narrow by rounding.
    pub(super) fn heights(&self, n: &Vector3) -> [f64; 2] {
        span(self.all.iter().flat_map(|edge| edge.ends).map(|end| (n.dot(&end.coords), 0.0)))
    }

    /// The same wherever they get.
    pub(super) fn heights_on_the_way(&self, direction: &Direction) -> [f64; 2] {
        let ends = self.tracks.iter().flat_map(|track| &track.ends);
        span(ends.map(|end| (direction.n.dot(&end.place.coords), end.along(direction))))
    }
}

impl EdgeTrack {
    fn of(edge: &Edge, ends: [Track; 2]) -> Self {
        // What the arc adds is no more between its ends than at one of them.
        let (way, beside) = (0.5 * (ends[0].way + ends[1].way), ends[0].beside.max(ends[1].beside));
        Self { middle: Track { place: edge.middle(), way, beside }, ends }
    }
}
