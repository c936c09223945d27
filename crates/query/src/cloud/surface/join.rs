//! Joins neighbouring samples by edges.

use std::collections::BTreeMap;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::Vector3;
use cloudtouch_noise::Scratch;

use super::edge::{EDGE_SLOPE, EDGE_SPACINGS, EdgeEnd};
use super::edges::{Growing, LeafEdges};
use super::slots::NEIGHBORS;
use super::surfel::Surfel;
use crate::cloud::prepared::Prepared;

impl Prepared {
    /// The edges that start or end at a point of a leaf, where they were joined.
    pub(crate) fn known_edges(&self, id: NodeId) -> Option<&LeafEdges> {
        self.surface.edges.get(id.index()).map(|edges| &**edges)
    }

    /// The edges that start or end at a point of a leaf, by buffers that leaves nearby were joined with.
    pub(crate) fn leaf_edges(&self, id: NodeId, scratch: &mut Scratch) -> &LeafEdges {
        self.surface.edges.get_or_init(id.index(), || {
            let pieces = self.tree.leaf(id).map_or(&[][..], |leaf| leaf.primitive_indices());
            Box::new(edges_of(self, pieces, self.thin_side(id), scratch))
        })
    }
}

/// The edges at the points of a leaf: to each other once, and to points of other leaves, each of
/// which has the same edge.
///
/// Only points that are among each other's nearest are joined, so that both leaves agree. The leaf is thin along
/// a unit vector.
pub(crate) fn edges_of(
    cloud: &Prepared,
    indices: &[u32],
    thin: Vector3,
    scratch: &mut Scratch,
) -> LeafEdges {
    let places: BTreeMap<u32, u32> = indices.iter().copied().zip(0..).collect();
    let mut nearest = Nearest { cloud, known: BTreeMap::new() };
    nearest.gather(&places, scratch);
    let end = |piece: u32, surfel: &Surfel| EdgeEnd {
        place: surfel.point.mean,
        across: surfel.across,
        piece,
    };
    let mut own = |&piece: &u32| end(piece, cloud.fit(piece, scratch));
    let mut edges = Growing::at(indices.iter().map(&mut own).collect());
    for (&p, &place) in &places {
        for q in nearest.of(p, scratch) {
            let is_second = q < p && places.contains_key(&q);
            if q == p || is_second || !nearest.of(q, scratch).contains(&p) {
                continue;
            }
            let from = *cloud.fit(p, scratch);
            let to = *cloud.fit(q, scratch);
            if !runs_along(&from, &to) {
                continue;
            }
            match places.get(&q) {
                Some(&other) => edges.join(place, other),
                None => edges.join_other(place, end(q, &to)),
            }
        }
    }
    edges.grown(thin)
}

/// The points nearest to points of a leaf; most are asked for several times.
struct Nearest<'a> {
    cloud: &'a Prepared,
    known: BTreeMap<u32, [u32; NEIGHBORS]>,
}

impl Nearest<'_> {
    /// Makes buffers ready for what will be asked of the points of other leaves.
    fn gather(&mut self, places: &BTreeMap<u32, u32>, scratch: &mut Scratch) {
        let near = self.cloud.near_pieces();
        let indices = |of: &[u32]| of.iter().map(|&index| index as usize).collect::<Vec<_>>();
        let unknown = |of: &u32| self.cloud.known_nearest(*of).is_none();
        let own: Vec<u32> = places.keys().copied().filter(unknown).collect();
        near.gather(indices(&own).into_iter(), NEIGHBORS, scratch);
        let mut others: Vec<u32> = Vec::new();
        for &index in places.keys() {
            others.extend(self.of(index, scratch).iter().filter(|q| !places.contains_key(q)));
        }
        others.sort_unstable();
        others.dedup();
        others.retain(|other| self.cloud.known_nearest(*other).is_none());
        near.gather(indices(&others).into_iter(), NEIGHBORS, scratch);
        let reach = places.keys().find_map(|&own| self.cloud.known_reach(own));
        self.cloud.gather(&others, reach, scratch);
    }

    fn of(&mut self, index: u32, scratch: &mut Scratch) -> [u32; NEIGHBORS] {
        if let Some(nearest) = self.cloud.known_nearest(index) {
            return nearest;
        }
        *self.known.entry(index).or_insert_with(|| self.cloud.sought_nearest(index, scratch))
    }
}

/// Whether the surface between two neighbours is straight enough to be joined.
pub(super) fn runs_along(p: &Surfel, q: &Surfel) -> bool {
    let step = q.point.mean - p.point.mean;
    let length = step.norm();
    let along = |s: &Surfel| s.normal.is_some_and(|n| step.dot(&n).abs() <= EDGE_SLOPE * length);
    length <= EDGE_SPACINGS * p.spacing.min(q.spacing) && along(p) && along(q)
}
