//! All pieces of a leaf of a cloud against all of a mesh.
//!
//! Where a mesh has many more triangles than a cloud has samples a search comes by hundreds of its leaves for
//! each leaf of the cloud, and nearly all of them are about as near as the box about its pieces, which noise makes
//! thick. Once it came by a few, each piece is taken down the tree of the mesh alone, within what is known of it,
//! and so are its disc and its edges.

use cloudtouch_bvh::NodeId;

use crate::cloud::DISC_SPACINGS;
use crate::search::cross::crossings::Crossings;
use crate::search::cross::with_all::cross_with_all;
use crate::search::visit::around::OfMesh;
use crate::search::visit::ends::ROUNDING;
use crate::search::visit::leaf::{ExactLeaf, Leaf, NoisyLeaf};
use crate::search::visit::side::Side;
use crate::search::visit::within::Metric;

use super::compared::Compared;
use super::nearest::Nearest;

/// Leaves of a mesh that reach so many times less far are small beside one of a cloud: a search comes by dozens of them.
const SMALL: f64 = 0.3;
/// Where the cloud is refined its tree knows the surface, which leaves fewer for a search to come by.
const SMALL_BESIDE_REFINED: f64 = 0.1;

/// How near the pieces of a leaf are to a mesh.
pub(in crate::search) struct Settlement {
    /// By leaves of the mesh where some piece has its nearest place, and which it was not compared with: the
    /// nearest.
    pub(in crate::search) nearest: Vec<(NodeId, Nearest)>,
    /// No surface that they stand for is nearer, m.
    pub(in crate::search) at_least: f64,
}

impl Leaf<'_> {
    /// Whether it was compared with all of a mesh.
    pub(in crate::search) fn is_settled(&self) -> bool {
        matches!(self, Self::Noisy(leaf) if matches!(leaf.compared, Compared::WithAll))
    }
}

impl NoisyLeaf<'_> {
    /// Compares it with all of a mesh, and adds the crossings with that, where it was compared with a few leaves of it and
    /// this one, and most of these are small.
    pub(in crate::search) fn settle(
        &mut self,
        ((id, leaf), few): ((NodeId, &ExactLeaf), usize),
        mesh: &mut OfMesh<'_>,
        within: f64,
        side: &mut Side,
        crossings: &mut Crossings,
    ) -> Option<Settlement> {
        let small = if self.cloud.prepared().is_refined() { SMALL_BESIDE_REFINED } else { SMALL };
        let is_small = leaf.ball.radius < small * self.reach();
        let compared = self.compared.next(id, is_small, few)?;
        self.make_room();
        self.end_near_mesh(mesh, within * within, side);
        let nearest = self.nearest_of_mesh(mesh, &compared, within * within);
        let at_least = self.apart_from(mesh);
        if at_least <= 0.0 {
            cross_with_all(self, &compared, mesh, side, crossings);
        }
        Some(Settlement { nearest, at_least })
    }

    /// Lets those pieces end that some facet is near; `within` is squared, as below.
    fn end_near_mesh(&mut self, mesh: &mut OfMesh<'_>, within: f64, side: &mut Side) {
        let is_near = |leaf: &Self, place: usize| {
            let (surfel, whitening) = (&leaf.surfels[place], leaf.whitening(place));
            let limit = leaf.squared[place].min(within) * (1.0 + ROUNDING);
            let mut is_near = false;
            mesh.visit_within(&Metric::of(surfel, whitening), limit, |_, facets| {
                let mut all = facets.iter();
                is_near |=
                    all.any(|facet| facet.squared_deviations(surfel, whitening, limit).is_some());
                if is_near { 0.0 } else { limit }
            });
            is_near
        };
        self.end_near(is_near, side);
    }

    /// Notes for every piece what is its least; the nearest by leaves of the mesh, without those that it was compared
    /// with.
    fn nearest_of_mesh(
        &mut self,
        mesh: &mut OfMesh<'_>,
        compared: &[NodeId],
        within: f64,
    ) -> Vec<(NodeId, Nearest)> {
        // On an edge it is as near to both triangles, which may be of two leaves.
        let limit = |least: f64| (least * (1.0 + ROUNDING)).min(within);
        let mut nearest: Vec<(NodeId, Nearest)> = Vec::new();
        let mut of_piece = Vec::new();
        for place in 0..self.surfels.len() {
            let surfel = &self.surfels[place];
            if surfel.may_end() {
                continue;
            }
            let whitening = self.whitening(place);
            let mut least = self.squared[place];
            of_piece.clear();
            mesh.visit_within(&Metric::of(surfel, whitening), limit(least), |id, facets| {
                for facet in facets {
                    let found = facet.squared_deviations(surfel, whitening, limit(least));
                    if let Some(found) = found {
                        least = least.min(found.0);
                        of_piece.push((id, Nearest::on_facet(surfel, facet, found)));
                    }
                }
                limit(least)
            });
            self.squared[place] = least;
            let are_least = |of: &&(NodeId, Nearest)| of.1.squared < limit(least);
            for &(id, found) in of_piece.iter().filter(are_least) {
                match nearest.iter_mut().find(|known| known.0 == id) {
                    Some((_, known)) if found.squared < known.squared => *known = found,
                    Some(_) => {}
                    None if compared.contains(&id) => {}
                    None => nearest.push((id, found)),
                }
            }
        }
        nearest
    }

    /// How far the surfaces of its pieces are from a mesh at least, by the ball about them, m.
    fn apart_from(&self, mesh: &mut OfMesh<'_>) -> f64 {
        let middle = self.ball.middle;
        let mut squared = f64::INFINITY;
        mesh.visit_within(&Metric::metres(middle), squared, |_, facets| {
            let ways = facets.iter().map(|facet| facet.way_from(&middle).norm_squared());
            squared = ways.fold(squared, f64::min);
            squared
        });
        let (way, reach) = (squared.sqrt(), self.reach());
        way - reach - ROUNDING * (way + reach)
    }

    /// How far the surfaces of its pieces reach from the middle of the ball about them, m.
    fn reach(&self) -> f64 {
        self.ball.radius + DISC_SPACINGS * self.ball.spacing
    }
}
