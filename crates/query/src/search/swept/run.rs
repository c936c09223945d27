//! The search for what geometry could say at most anywhere along a drift.

use cloudtouch_bvh::{Sought, SurfaceFlow, SurfacePair, visit_surfaces};
use cloudtouch_geom::{Drift, Motion, Pose};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::search::run::SOUGHT;
use crate::stats::Stats;

use super::course::Course;
use super::dividing::Dividing;
use super::drifts::Drifts;
use super::facets::may_touch;
use super::gather::{
    add_edges_through_discs, add_edges_through_facets, add_mesh_through_discs, may_meet, may_reach,
    may_reach_facets,
};
use super::layer::ExactLayer;
use super::leaf::{Swept, SweptCloud, SweptMesh};
use super::pieces::{between_discs, to_facet, turned_variance};
use super::pool::Passages;
use super::track::Direction;
use crate::search::visit::around::{Around, OfMesh};
use crate::search::visit::leaves::Leaves;
use crate::search::visit::side::Side;
use crate::search::visit::trees::Trees;

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
    let is_exact = matches!((a, b), (BodyRef::Mesh(_), BodyRef::Mesh(_)));
    let sought = Sought { crossings: !is_exact, drift: Some(*drift), ..SOUGHT };
    Way::new((a, b), a_from_b, Drifts::new(drift)).look(a_from_b, sought, is_enough, stats)
}

/// A search among poses, and what it found.
pub(super) struct Way<'a> {
    bodies: (BodyRef<'a>, BodyRef<'a>),
    a_from_b: Motion,
    drifts: Drifts,
    leaves: (Leaves<Swept<'a>>, Leaves<Swept<'a>>),
    deviations: f64,
    passages: Passages,
    around: Around,
    dividing: Dividing,
    sides: [Side; 2],
}

impl<'a> Way<'a> {
    pub(super) fn new(bodies: (BodyRef<'a>, BodyRef<'a>), a_from_b: &Pose, drifts: Drifts) -> Self {
        let a_from_b = Motion::from(a_from_b);
        Self {
            bodies,
            a_from_b,
            drifts,
            leaves: Default::default(),
            deviations: MOST_DEVIATIONS,
            passages: Passages::default(),
            around: Around::default(),
            dividing: Dividing::default(),
            sides: [Side::default(), Side::moved(a_from_b)],
        }
    }

    /// Looks at the pairs of leaves that hold what is sought, until `is_enough`.
    pub(super) fn look(
        mut self,
        a_from_b: &Pose,
        sought: Sought,
        is_enough: impl Fn(f64, f64) -> bool,
        stats: &mut Stats,
    ) -> Result<Reach, QueryError> {
        let mut trees = Trees::of(self.bodies.0, self.bodies.1);
        let outcome = visit_surfaces(trees.both(), a_from_b, sought, |pair| {
            stats.leaf_pairs += 1;
            self.look_at(&pair, stats);
            let (deviations, clearness) = (self.deviations, self.passages.last_clearness());
            if is_enough(deviations, clearness) {
                return SurfaceFlow::Stop;
            }
            trees.count_pair([self.leaves.0.len(), self.leaves.1.len()]);
            trees.flow(deviations, stats, || is_enough(deviations, clearness))
        })?;
        stats.nodes_visited += outcome.nodes_visited;
        let clearness = self.passages.clearness();
        Ok(Reach { deviations: self.deviations, clearness, is_complete: !outcome.stopped })
    }

    fn look_at(&mut self, pair: &SurfacePair, stats: &mut Stats) {
        let (a, b) = self.bodies;
        let (motion, drifts) = (&self.a_from_b, &self.drifts);
        let (of_a, of_b) = &mut self.leaves;
        let [side_a, side_b] = &mut self.sides;
        let load_a = || Swept::load(a, pair.a, side_a, &drifts.of_a, stats);
        let leaf_a = of_a.get_or_load(pair.a, load_a);
        let load_b = || Swept::load(b, pair.b, side_b, &drifts.of_b, stats);
        let leaf_b = of_b.get_or_load(pair.b, load_b);
        if pair.deviations < self.deviations {
            self.deviations = least_of(leaf_a, leaf_b, &drifts.of_b, self.deviations);
        }
        if pair.may_cross {
            let told = (&mut self.passages, &mut self.around, &mut self.dividing);
            cross((a, b), motion, (leaf_a, leaf_b), drifts, &mut self.sides, told);
        }
    }
}

/// The fewest deviations of two pieces of two leaves, those of B drifting; `most` where none have fewer.
fn least_of(a: &mut Swept<'_>, b: &mut Swept<'_>, drift: &Course, most: f64) -> f64 {
    match (a, b) {
        (Swept::Noisy(a), Swept::Noisy(b)) => between_noisy(a, b, drift, most),
        (Swept::Noisy(a), Swept::Exact(b)) => to_exact(a, b, false, drift, most),
        (Swept::Exact(a), Swept::Noisy(b)) => to_exact(b, a, true, drift, most),
        (Swept::Exact(a), Swept::Exact(b)) => {
            let touches = |p| b.leaf.facets.iter().any(|q| may_touch(p, q, drift));
            if a.leaf.facets.iter().any(touches) { 0.0 } else { most }
        }
    }
}

fn between_noisy(a: &SweptCloud<'_>, b: &SweptCloud<'_>, drift: &Course, most: f64) -> f64 {
    let mut least = most;
    let ball = &a.leaf.ball;
    for (on_b, track) in b.leaf.surfels.iter().zip(&b.tracks) {
        let reach = least * (on_b.most_variance + ball.variance).sqrt();
        let variance = |n: &Direction| turned_variance(on_b, n, drift);
        if !track.gets_to(ball, reach) || a.layer.deviations(track, variance) >= least {
            continue;
        }
        for on_a in a.leaf.surfels.iter() {
            least = between_discs(on_a, (on_b, track), drift, least).unwrap_or(least);
        }
    }
    least
}

fn to_exact(
    noisy: &mut SweptCloud<'_>,
    exact: &SweptMesh,
    is_facet_still: bool,
    drift: &Course,
    most: f64,
) -> f64 {
    let mut least = most;
    noisy.leaf.make_room();
    for (place, (surfel, track)) in noisy.leaf.surfels.iter().zip(&noisy.tracks).enumerate() {
        let by_layer =
            |layer: &ExactLayer| layer.deviations((surfel, track), is_facet_still, drift);
        if !track.gets_to(&exact.leaf.ball, least * surfel.most_variance.sqrt())
            || exact.layer.as_ref().is_some_and(|layer| by_layer(layer) >= least)
        {
            continue;
        }
        let whitening = noisy.leaf.whitening(place);
        for facet in exact.facets() {
            let of_facet =
                to_facet((surfel, whitening, track), facet, is_facet_still, drift, least);
            least = of_facet.unwrap_or(least);
        }
    }
    least
}

/// Adds the passages of edges of one leaf through discs of another, where there may be any; `drift` is that
/// of the edges.
fn cross_discs(
    is_a: bool,
    of_edges: &mut SweptCloud<'_>,
    of_discs: &SweptCloud<'_>,
    drift: &Course,
    side: &mut Side,
    told: (&mut Passages, &mut Dividing),
) {
    let dividing = *told.1;
    let may_meet = |of_edges: &SweptCloud<'_>| {
        of_edges.edges().is_none_or(|edges| may_meet(is_a, (of_edges, edges), of_discs, dividing))
    };
    if !may_meet(of_edges) || !may_reach(of_edges, &of_discs.leaf, drift) {
        return;
    }
    of_edges.load_edges(drift, side);
    if may_meet(of_edges) {
        add_edges_through_discs(is_a, of_edges, &of_discs.leaf, drift, told);
    }
}

fn cross<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Motion,
    leaves: (&mut Swept<'a>, &mut Swept<'a>),
    drifts: &Drifts,
    [of_a, of_b]: &mut [Side; 2],
    (passages, known, dividing): (&mut Passages, &mut Around, &mut Dividing),
) {
    match leaves {
        (Swept::Noisy(on_a), Swept::Noisy(on_b)) => {
            cross_discs(true, on_a, on_b, &drifts.of_a, of_a, (passages, dividing));
            cross_discs(false, on_b, on_a, &drifts.of_b, of_b, (passages, dividing));
        }
        (Swept::Noisy(noisy), Swept::Exact(exact))
            if may_reach_facets(noisy, &exact.leaf, &drifts.of_a) =>
        {
            noisy.load_edges(&drifts.of_a, of_a);
            add_edges_through_facets(true, noisy, exact, drifts, (passages, dividing));
            let mut around = OfMesh { known, body: b, a_from_mesh: Some(a_from_b) };
            add_mesh_through_discs(true, noisy, exact, &mut around, drifts, passages);
        }
        (Swept::Exact(exact), Swept::Noisy(noisy))
            if may_reach_facets(noisy, &exact.leaf, &drifts.of_b) =>
        {
            noisy.load_edges(&drifts.of_b, of_b);
            add_edges_through_facets(false, noisy, exact, drifts, (passages, dividing));
            let mut around = OfMesh { known, body: a, a_from_mesh: None };
            add_mesh_through_discs(false, noisy, exact, &mut around, drifts, passages);
        }
        _ => {}
    }
}

#[cfg(test)]
pub(super) mod tests {
    use cloudtouch_geom::{Point3, PointCloud, TriangleMesh, Vector3};
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
    use crate::search::{Course, WITH_EXTENT};
    use crate::search::{look_inside, search};

    fn body(is_mesh: bool, shape: &TriangleMesh, std: f64, seed: u64) -> Body {
        if is_mesh {
            return Body::from(Mesh::prepare(shape).unwrap());
        }
        let samples = surface::positions(&surface::sample_surface(shape, 160, seed));
        let points = add_noise(&samples, NoiseKind::Gaussian, std, seed);
        let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
        settings.tree.max_leaf_points = 12;
        settings.tree.min_leaf_points = 4;
        Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
    }

    /// Kinds and shapes of two bodies, the noise, and where the second is.
    pub(in super::super) fn pair_of(
        mesh: usize,
        are_balls: [bool; 2],
        std: f64,
        seed: u64,
    ) -> [Body; 2] {
        let kinds = [[false, false], [true, false], [false, true]][mesh];
        let of = |is_ball: bool| match is_ball {
            true => scene::sphere(0.05, 2),
            false => scene::cuboid([0.1, 0.08, 0.04]),
        };
        [(0, seed), (1, !seed)].map(|(k, seed)| body(kinds[k], &of(are_balls[k]), std, seed))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

        /// Each number by itself: where one is found wanting, another may hide it from a probability.
        #[test]
        fn no_pose_on_the_way_has_more_evidence_of_any_kind(
            (mesh, shapes) in (0..3_usize, any::<[bool; 2]>()),
            std in 0.0003_f64..0.012,
            offset in prop::array::uniform3(-0.09..0.09_f64),
            turn in -3.0..3.0_f64,
            linear in prop::array::uniform3(-0.02..0.02_f64),
            angular in prop::array::uniform3(-0.2..0.2_f64),
            is_fine in any::<bool>(),
            seed in any::<u64>(),
        ) {
            let [a, b] = pair_of(mesh, shapes, std, seed);
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
                let found = search(pair, &there, |_| Course::Further(WITH_EXTENT), &mut stats).unwrap();
                prop_assert!(found.deviations >= reach.deviations * (1.0 - 1e-9), "{s}");
                let clearness = found.crossings.clearness();
                prop_assert!(clearness <= reach.clearness * (1.0 + 1e-9) + 1e-9,
                    "{clearness} above {} at {s}", reach.clearness);
                let clock = Clock::new(std::time::Instant::now(), None);
                let inside = look_inside(pair, &there, &clock, |_| false).deepest;
                let is_deeper = |d: f64| d > depth * (1.0 + 1e-9) && depth < MOST_DEVIATIONS;
                prop_assert!(!inside.is_some_and(|inside| is_deeper(inside.deviations)), "{s}");
            }
        }
    }
}
