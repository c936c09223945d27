//! The search for what geometry could say at most anywhere along a drift.

use std::collections::BTreeMap;

use cloudtouch_bvh::{NodeId, Sought, SurfaceFlow, SurfacePair, visit_surfaces};
use cloudtouch_geom::{Drift, Motion, Point3, Pose};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::report::Stats;

use super::super::leaf::{ExactLeaf, Leaf, NoisyLeaf};
use super::super::run::{facets_around, load_edges};
use super::facets::may_touch;
use super::gather::{
    add_edges_through_discs, add_edges_through_facets, add_mesh_through_discs, may_reach,
    may_reach_facets,
};
use super::pieces::{between_discs, to_facet};
use super::pool::Passages;
use super::track::Track;

/// What the evidence can be on the way, at most.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    /// No two pieces of surface ever have fewer deviations between them; 0 where two triangles may
    /// touch.
    pub deviations: f64,
    /// Crossings are never clearer than this.
    pub clearness: f64,
    /// Whether nothing was left out that could say more.
    pub is_complete: bool,
}

/// Looks at the pairs of leaves whose surfaces may touch while B drifts about its pose, until `is_enough`
/// of the deviations and of the clearness of crossings, as far as found. Local frames.
pub(crate) fn reach_of<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    drift: &Drift,
    is_enough: impl Fn(f64, f64) -> bool,
    stats: &mut Stats,
) -> Result<Reach, QueryError> {
    let mut way = Way {
        bodies: (a, b),
        a_from_b: Motion::from(a_from_b),
        drift,
        leaves: Default::default(),
        deviations: MOST_DEVIATIONS,
        passages: Passages::default(),
    };
    let trees = (a.shape().tree(), b.shape().tree());
    let is_exact = matches!((a, b), (BodyRef::Mesh(_), BodyRef::Mesh(_)));
    let sought =
        Sought { within: MOST_DEVIATIONS, margin: 0.0, crossings: !is_exact, drift: Some(*drift) };
    let outcome = visit_surfaces(trees, a_from_b, sought, |pair| {
        stats.leaf_pairs += 1;
        way.look_at(&pair, stats);
        if is_enough(way.deviations, way.passages.last_clearness()) {
            return SurfaceFlow::Stop;
        }
        SurfaceFlow::Within(way.deviations)
    })?;
    stats.nodes_visited += outcome.nodes_visited;
    let clearness = way.passages.clearness();
    Ok(Reach { deviations: way.deviations, clearness, is_complete: !outcome.stopped })
}

type Leaves<'a> = BTreeMap<NodeId, Leaf<'a>>;

struct Way<'a, 'd> {
    bodies: (BodyRef<'a>, BodyRef<'a>),
    a_from_b: Motion,
    drift: &'d Drift,
    leaves: (Leaves<'a>, Leaves<'a>),
    deviations: f64,
    passages: Passages,
}

impl<'a> Way<'a, '_> {
    fn look_at(&mut self, pair: &SurfacePair, stats: &mut Stats) {
        let (a, b) = self.bodies;
        let motion = &self.a_from_b;
        let leaf_a = self.leaves.0.entry(pair.a);
        let leaf_a = leaf_a.or_insert_with(|| Leaf::load(a, pair.a, None, stats));
        let leaf_b = self.leaves.1.entry(pair.b);
        let leaf_b = leaf_b.or_insert_with(|| Leaf::load(b, pair.b, Some(motion), stats));
        if pair.deviations < self.deviations {
            self.deviations = least_of(leaf_a, leaf_b, self.drift, self.deviations);
        }
        if pair.may_cross {
            cross((a, b), motion, pair, (leaf_a, leaf_b), self.drift, &mut self.passages);
        }
    }
}

/// The fewest deviations of two pieces of two leaves; `most` where none have fewer.
fn least_of(a: &mut Leaf<'_>, b: &mut Leaf<'_>, drift: &Drift, most: f64) -> f64 {
    match (a, b) {
        (Leaf::Noisy(a), Leaf::Noisy(b)) => between_noisy(a, b, drift, most),
        (Leaf::Noisy(a), Leaf::Exact(b)) => to_exact(a, b, false, drift, most),
        (Leaf::Exact(a), Leaf::Noisy(b)) => to_exact(b, a, true, drift, most),
        (Leaf::Exact(a), Leaf::Exact(b)) => {
            let touches = |p| b.facets.iter().any(|q| may_touch(p, q, drift));
            if a.facets.iter().any(touches) { 0.0 } else { most }
        }
    }
}

fn between_noisy(a: &NoisyLeaf<'_>, b: &NoisyLeaf<'_>, drift: &Drift, most: f64) -> f64 {
    let mut least = most;
    for on_b in b.surfels.iter() {
        let mean = &on_b.point.mean;
        let reach = least * (on_b.most_variance + a.ball.variance).sqrt();
        if !Track::of(mean, drift).gets_to(&a.ball, reach) {
            continue;
        }
        for on_a in a.surfels.iter() {
            least = between_discs(on_a, on_b, drift, least).unwrap_or(least);
        }
    }
    least
}

fn to_exact(
    noisy: &mut NoisyLeaf<'_>,
    exact: &ExactLeaf,
    is_facet_still: bool,
    drift: &Drift,
    most: f64,
) -> f64 {
    let mut least = most;
    let (surfels, whitenings, _) = noisy.whitened();
    for (surfel, whitening) in surfels.iter().zip(whitenings) {
        let mean = &surfel.point.mean;
        let reach = least * surfel.most_variance.sqrt();
        if !Track::of(mean, drift).gets_to(&exact.ball, reach) {
            continue;
        }
        for facet in &exact.facets {
            let of_facet = to_facet((surfel, whitening), facet, is_facet_still, drift, least);
            least = of_facet.unwrap_or(least);
        }
    }
    least
}

fn cross<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Motion,
    pair: &SurfacePair,
    leaves: (&mut Leaf<'a>, &mut Leaf<'a>),
    drift: &Drift,
    passages: &mut Passages,
) {
    match leaves {
        (Leaf::Noisy(on_a), Leaf::Noisy(on_b)) => {
            if may_reach(on_a, on_b, drift) {
                load_edges(on_a, a, pair.a, None);
                add_edges_through_discs(true, on_a, on_b, drift, passages);
            }
            if may_reach(on_b, on_a, drift) {
                load_edges(on_b, b, pair.b, Some(a_from_b));
                add_edges_through_discs(false, on_b, on_a, drift, passages);
            }
        }
        (Leaf::Noisy(noisy), Leaf::Exact(exact)) if may_reach_facets(noisy, exact, drift) => {
            load_edges(noisy, a, pair.a, None);
            add_edges_through_facets(true, noisy, exact, drift, passages);
            let around = |place: &Point3, radius| facets_around(b, Some(a_from_b), place, radius);
            add_mesh_through_discs(true, noisy, exact, around, drift, passages);
        }
        (Leaf::Exact(exact), Leaf::Noisy(noisy)) if may_reach_facets(noisy, exact, drift) => {
            load_edges(noisy, b, pair.b, Some(a_from_b));
            add_edges_through_facets(false, noisy, exact, drift, passages);
            let around = |place: &Point3, radius| facets_around(a, None, place, radius);
            add_mesh_through_discs(false, noisy, exact, around, drift, passages);
        }
        _ => {}
    }
}
