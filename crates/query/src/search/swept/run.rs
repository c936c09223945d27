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

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, TriangleMesh, Vector3};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    use super::*;
    use crate::body::Body;
    use crate::classifier::Clock;
    use crate::cloud::{Cloud, CloudSettings};
    use crate::mesh::Mesh;
    use crate::search::swept::greatest_depth;
    use crate::search::{look_inside, search};

    fn body(is_mesh: bool, shape: &TriangleMesh, std: f64, seed: u64) -> Body {
        if is_mesh {
            return Body::Mesh(Mesh::prepare(shape).unwrap());
        }
        let samples = surface::positions(&surface::sample_surface(shape, 160, seed));
        let points = add_noise(&samples, NoiseKind::Gaussian, std, seed);
        let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
        settings.tree.max_leaf_points = 12;
        settings.tree.min_leaf_points = 4;
        Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

        /// Each number by itself: where one is found wanting, another may hide it from a probability.
        #[test]
        fn no_pose_on_the_way_has_more_evidence_of_any_kind(
            (mesh, shapes) in (0..3_usize, any::<[bool; 2]>()),
            std in 0.0003_f64..0.004,
            offset in prop::array::uniform3(-0.09..0.09_f64),
            turn in -3.0..3.0_f64,
            linear in prop::array::uniform3(-0.02..0.02_f64),
            angular in prop::array::uniform3(-0.2..0.2_f64),
            is_fine in any::<bool>(),
            seed in any::<u64>(),
        ) {
            let kinds = [[false, false], [true, false], [false, true]][mesh];
            let of = |is_ball: bool| match is_ball {
                true => scene::sphere(0.05, 2),
                false => scene::cuboid([0.1, 0.08, 0.04]),
            };
            let a = body(kinds[0], &of(shapes[0]), std, seed);
            let b = body(kinds[1], &of(shapes[1]), std, !seed);
            let pair = (BodyRef::from(&a), BodyRef::from(&b));
            let file = Pose::from_translation_rpy(Vector3::from(offset), [turn, 0.3, 0.0]);
            let local = pair.0.shape().local_from(&pair.1.shape(), &file);
            // Small motions are bounded as tightly as they are told.
            let scale = if is_fine { 0.1 } else { 1.0 };
            let (linear, angular) = (Vector3::from(linear) * scale, Vector3::from(angular) * scale);
            let pivot = Point3::new(0.03, 0.0, -0.05);
            let drift = Drift::new(pivot, linear, angular);
            let mut stats = Stats::default();
            let reach = reach_of(pair, &local, &drift, |_, _| false, &mut stats).unwrap();
            let depth = greatest_depth(pair, &local, &drift, |_| false, &mut stats);
            prop_assert!(reach.is_complete);
            for s in [-1.0, -0.7, -0.3, 0.0, 0.2, 0.6, 1.0] {
                let turned = UnitQuaternion::new(angular * s);
                let about = pivot.coords + linear * s - turned * pivot.coords;
                let there = Pose::from_translation_rotation(about, turned).after(&local);
                let found = search(pair, &there, |_, _| false, &mut stats).unwrap();
                prop_assert!(found.deviations >= reach.deviations * (1.0 - 1e-9), "{s}");
                let clearness = found.crossings.clearness();
                prop_assert!(clearness <= reach.clearness * (1.0 + 1e-9) + 1e-9,
                    "{clearness} above {} at {s}", reach.clearness);
                let clock = Clock::new(std::time::Instant::now(), None);
                let inside = look_inside(pair, &there, &clock).deepest;
                let is_deeper = |d: f64| d > depth * (1.0 + 1e-9) && depth < MOST_DEVIATIONS;
                prop_assert!(!inside.is_some_and(|inside| is_deeper(inside.deviations)), "{s}");
            }
        }
    }
}
