//! The search for what two bodies say of a collision by their geometry alone.

use cloudtouch_bvh::{Sought, SurfaceFlow, SurfacePair, visit_surfaces};
use cloudtouch_geom::{Motion, Pose, Vector3};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::stats::Stats;

use super::compare::meeting::{Meeting, deviations_by_pose};
use super::cross::crossings::Crossings;
use super::cross::near_discs::Memory;
use super::measure::compared::FEW;
use super::measure::nearest::Nearest;
use super::visit::around::Around;
use super::visit::leaf::Leaf;
use super::visit::leaves::Leaves;
use super::visit::side::Side;
use super::visit::trees::Trees;
use super::visit::unseen::{Parted, told_apart};
use super::wrench::Wrench;

/// Places that are more than this many deviations above the least are not looked at, where it counts over how many
/// pieces of surface the bodies are as near, ...
pub(crate) const WITH_EXTENT: f64 = 2.5;
/// ... and where it does not, ...
pub(crate) const WITHOUT_EXTENT: f64 = 1.5;
/// ... nor those beyond this, which have no contact that is reported.
const CLEARLY_FREE: f64 = 4.5;

/// What a search looks for: who rules a pair out beforehand has to look for the same.
pub(crate) const SOUGHT: Sought =
    Sought { within: MOST_DEVIATIONS, margin: 0.0, crossings: true, drift: None };

/// What a search has found so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Progress {
    /// The least deviations.
    pub deviations: f64,
    /// Clearness of crossings, where one was found last.
    pub clearness: f64,
    /// Whether the boxes of the last pair of leaves overlap: such pairs come first.
    pub is_amid_overlap: bool,
}

/// How a search goes on after a pair of leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Course {
    /// Up to so many deviations further than the least.
    Further(f64),
    Stop,
}

/// Where the pieces of two leaves are least apart.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Finding {
    /// The two pieces of surface with the least deviations between them.
    pub nearest: Nearest,
    /// Where these would meet.
    pub meeting: Meeting,
    /// From the middle of the leaf of A to that of B.
    pub toward_b: Vector3,
}

/// All that the search found.
#[derive(Debug, Default)]
pub(crate) struct Found<'a> {
    pub leaves_a: Leaves<Leaf<'a>>,
    pub leaves_b: Leaves<Leaf<'a>>,
    pub findings: Vec<Finding>,
    /// The least deviations between two pieces of surface, at most [`MOST_DEVIATIONS`].
    pub deviations: f64,
    pub crossings: Crossings,
    pub(super) around: Around,
    pub(super) memory: Memory,
    pub(super) sides: [Side; 2],
    /// With how many leaves of a mesh a leaf of a cloud is compared before it is with all of that.
    pub(super) few: usize,
    /// How many deviations above the least is looked.
    pub(super) further: f64,
    /// Whether what was left out can change neither of these.
    pub is_complete: bool,
    /// No two pieces are nearer than this, m; negative where surfaces may cross.
    pub at_least: f64,
}

/// Looks at the pairs of leaves where the surfaces may touch, after each as far as `course` says.
pub(crate) fn search<'a>(
    bodies: (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    course: impl Fn(Progress) -> Course,
    stats: &mut Stats,
) -> Result<Found<'a>, QueryError> {
    search_settling(FEW, bodies, a_from_b, course, stats)
}

/// The same, given with how many leaves of a mesh a leaf of a cloud is compared before it is with all of that.
fn search_settling<'a>(
    few: usize,
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    course: impl Fn(Progress) -> Course,
    stats: &mut Stats,
) -> Result<Found<'a>, QueryError> {
    let (deviations, at_least) = (MOST_DEVIATIONS, f64::INFINITY);
    let mut found = Found { deviations, at_least, few, ..Found::default() };
    let motion = Motion::from(a_from_b);
    found.sides = [Side::default(), Side::moved(motion)];
    let mut trees = Trees::of(a, b);
    let outcome = visit_surfaces(trees.both(), a_from_b, SOUGHT, |pair| {
        stats.leaf_pairs += 1;
        let settled = match found.told_apart((a, b), &pair, trees.may_be_loose(), stats) {
            Some(apart) => {
                found.at_least = found.at_least.min(apart);
                None
            }
            None => found.add((a, b), &motion, &pair, stats),
        };
        trees.count_pair([found.leaves_a.len(), found.leaves_b.len()]);
        let progress = Progress {
            deviations: found.deviations,
            clearness: found.crossings.last_clearness(),
            is_amid_overlap: pair.deviations == 0.0,
        };
        let Course::Further(further) = course(progress) else {
            return SurfaceFlow::Stop;
        };
        found.further = further;
        let within = found.deviations_of_interest();
        match (trees.flow(within, stats, || course(progress) == Course::Stop), settled) {
            (SurfaceFlow::Within(within), Some(settled)) => {
                SurfaceFlow::WithinSettled(within, settled)
            }
            (flow, _) => flow,
        }
    })?;
    stats.nodes_visited += outcome.nodes_visited;
    found.at_least = found.at_least.min(outcome.apart);
    found.is_complete = !outcome.stopped;
    Ok(found)
}

impl<'a> Found<'a> {
    /// Places with more deviations than this change nothing: where all are as good as free, only the
    /// least counts.
    pub(crate) fn deviations_of_interest(&self) -> f64 {
        self.deviations_up_to(self.further, CLEARLY_FREE)
    }

    /// So many more than the least, but no more than `most` where the least are not.
    pub(crate) fn deviations_up_to(&self, further: f64, most: f64) -> f64 {
        self.deviations.max((self.deviations + further).min(most))
    }

    /// How far beyond the least deviations is looked.
    pub(super) fn window(&self) -> f64 {
        self.deviations_of_interest() - self.deviations
    }

    /// Whether that ends where places are as good as free. Told by the sum, which the window itself, a difference of
    /// it, may miss by its rounding.
    pub(super) fn is_window_cut(&self) -> bool {
        self.deviations + self.further > CLEARLY_FREE
    }

    /// What the least deviations change by as the pose does: those of the two pieces that have them.
    pub(crate) fn deviations_by_pose(&self) -> Wrench {
        let least = self.findings.iter().map(|finding| &finding.nearest);
        least
            .min_by(|p, q| p.squared.total_cmp(&q.squared))
            .and_then(|nearest| deviations_by_pose(&nearest.a, &nearest.b))
            .unwrap_or_else(Wrench::zeros)
    }

    /// How far apart the surfaces of two leaves are, m, where one tells that the other, whose surface was not
    /// looked at yet, changes nothing.
    fn told_apart(
        &mut self,
        bodies: (BodyRef<'a>, BodyRef<'a>),
        pair: &SurfacePair,
        are_loose: [bool; 2],
        stats: &mut Stats,
    ) -> Option<f64> {
        let most = self.deviations_of_interest();
        let Self { leaves_a, leaves_b, around, sides, .. } = self;
        let load = |body, id, side: &mut Side| around.load(body, id, side, stats);
        let is_apart =
            |parted: &Parted| parted.surfaces > 0.0 && parted.deviations_beyond(0.0) >= most;
        told_apart(bodies, pair, are_loose, (leaves_a, leaves_b), sides, load, is_apart)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, PointCloud, TriangleMesh};
    use cloudtouch_noise::{Scratch, SensorModel};
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};
    use proptest::prelude::*;

    use super::*;
    use crate::body::Body;
    use crate::classifier::Clock;
    use crate::cloud::{Edge, Surfel, edges_of};
    use crate::mesh::Mesh;
    use crate::search::compare::meeting::squared_deviations;
    use crate::search::cross::crossing::through_disc;
    use crate::search::cross::crossings::Witness;
    use crate::search::cross::past::Past;
    use crate::search::least_beyond;
    use crate::{Cloud, CloudSettings};

    fn shape(is_box: bool) -> TriangleMesh {
        if is_box { scene::cuboid([0.1, 0.06, 0.03]) } else { scene::sphere(0.05, 2) }
    }

    fn cloud(of: &TriangleMesh, count: usize, std: f64, seed: u64) -> Cloud {
        let samples = surface::sample_surface(of, count, seed);
        let points: Vec<Point3> =
            add_noise(&surface::positions(&samples), NoiseKind::Gaussian, std, seed);
        let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
        settings.tree.max_leaf_points = 12;
        settings.tree.min_leaf_points = 4;
        Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap()
    }

    /// All pieces and edges of a cloud, in the frame of A, as if it were one leaf.
    fn whole(cloud: &Cloud, a_from_cloud: &Pose) -> (Vec<Surfel>, Vec<Edge>) {
        let mut scratch = Scratch::default();
        let motion = Motion::from(a_from_cloud);
        let indices: Vec<u32> =
            cloud.tree().leaves().flat_map(|leaf| leaf.primitive_indices().to_vec()).collect();
        let edges = edges_of(cloud.prepared(), &indices, Vector3::z(), &mut scratch);
        let surfels = cloud.prepared().told_together(&indices, &mut scratch);
        (
            surfels.iter().map(|s| s.moved(&motion)).collect(),
            edges.iter().map(|e| e.moved(&motion)).collect(),
        )
    }

    /// Every piece against every other and every edge against every disc.
    fn brute_force(a: &Cloud, b: &Cloud, a_from_b: &Pose) -> (f64, f64) {
        let (surfels_a, edges_a) = whole(a, &Pose::identity());
        let (surfels_b, edges_b) = whole(b, a_from_b);
        let mut least = MOST_DEVIATIONS.powi(2);
        for s in &surfels_a {
            for t in &surfels_b {
                least = squared_deviations(s, t, least).unwrap_or(least);
            }
        }
        let mut crossings = Crossings::default();
        let motion = Motion::from(a_from_b);
        let of_a = (a, None, edges_a, &surfels_b);
        let of_b = (b, Some(&motion), edges_b, &surfels_a);
        for (cloud, motion, edges, discs) in [of_a, of_b] {
            let is_a = motion.is_none();
            for edge in &edges {
                let past = Past::new(cloud, edge, motion);
                let through = |disc| through_disc(edge, disc, |end| past.of(end));
                for crossing in discs.iter().filter_map(through) {
                    crossings.add(Witness::edge(is_a, edge), &edge.middle(), &crossing);
                }
            }
        }
        (least.sqrt(), crossings.clearness())
    }

    /// Where the pieces of the clouds were measured, in the frame of A, and how likely they collide.
    fn pieces(found: &Found<'_>) -> Vec<(Point3, f64)> {
        let leaves = found.leaves_a.in_order().chain(found.leaves_b.in_order());
        let noisy = leaves.filter_map(|leaf| match leaf {
            Leaf::Noisy(leaf) => Some(leaf),
            Leaf::Exact(_) => None,
        });
        let within = found.deviations_of_interest();
        let all = noisy.flat_map(|leaf| leaf.probabilities(within));
        all.map(|(piece, p)| (piece.point.mean, p)).collect()
    }

    fn likely(found: &Found<'_>) -> Vec<(Point3, f64)> {
        pieces(found).into_iter().filter(|(_, p)| *p > 0.0).collect()
    }

    fn all_of<'a>(bodies: (BodyRef<'a>, BodyRef<'a>), pose: &Pose) -> Found<'a> {
        search(bodies, pose, |_| Course::Further(WITH_EXTENT), &mut Stats::default()).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

        #[test]
        fn the_search_finds_what_brute_force_finds(
            counts in [40_usize..200, 40_usize..200],
            std in 0.0002_f64..0.01,
            offset in 0.05_f64..0.2,
            turn in -3.0_f64..3.0,
            are_boxes in any::<[bool; 2]>(),
            seed in any::<u64>(),
        ) {
            let [a, b] = [(0, seed), (1, !seed)]
                .map(|(k, seed)| cloud(&shape(are_boxes[k]), counts[k], std, seed));
            let offset = Vector3::new(0.0, 0.3 * offset, offset);
            let pose = Pose::from_translation_rpy(offset, [turn, 0.3, 0.0]);
            let found = all_of((BodyRef::Cloud(&a), BodyRef::Cloud(&b)), &pose);
            prop_assert!(found.is_complete);
            let (deviations, clearness) = brute_force(&a, &b, &pose);
            prop_assert!((found.deviations - deviations).abs() < 1e-9);
            // The sums run in different orders.
            prop_assert!((found.crossings.clearness() - clearness).abs() <= 1e-9 * (1.0 + clearness));
        }

        /// A refined cloud has ended everywhere, and its tree leaves out more.
        #[test]
        fn what_is_found_of_fresh_clouds_is_what_is_found_of_refined_ones(
            mesh in 0..3_usize,
            counts in [60_usize..400, 60_usize..400],
            std in 0.0002_f64..0.01,
            offset in 0.02_f64..0.15,
            turn in -3.0_f64..3.0,
            are_boxes in any::<[bool; 2]>(),
            seed in any::<u64>(),
        ) {
            let offset = Vector3::new(0.3 * offset, 0.2 * offset, offset);
            let pose = Pose::from_translation_rpy(offset, [turn, 0.3, 0.0]);
            let body = |k: usize, is_refined: bool| {
                let shape = shape(are_boxes[k]);
                if k == mesh {
                    return Body::from(Mesh::prepare(&shape).unwrap());
                }
                let cloud = cloud(&shape, counts[k], std, seed.wrapping_add(k as u64));
                Body::Cloud(if is_refined { cloud.refined().unwrap() } else { cloud })
            };
            let [fresh, refined] = [false, true].map(|refined| [body(0, refined), body(1, refined)]);
            let [fresh, refined] = [&fresh, &refined].map(|[a, b]| (a.into(), b.into()));
            let (one, other) = (all_of(fresh, &pose), all_of(refined, &pose));
            prop_assert_eq!(one.deviations, other.deviations);
            let is_same = |p: f64, q: f64| (p - q).abs() <= 1e-12 * (1.0 + p.abs());
            let [p, q] = [&one, &other].map(|found| found.crossings.clearness());
            prop_assert!(is_same(p, q), "clearness {p} and {q}");
            let (p, q) = (one.extent(fresh, &pose), other.extent(refined, &pose));
            prop_assert!(is_same(p, q), "extent {p} and {q}");
            let clock = Clock::new(std::time::Instant::now(), None);
            for margin in [0.0, 0.004, 0.03] {
                let beyond = |bodies| least_beyond(bodies, &pose, margin, &clock).unwrap();
                let (p, q) = (beyond(fresh), beyond(refined));
                prop_assert_eq!(p.deviations, q.deviations, "beyond {} m", margin);
            }
        }

        #[test]
        fn leaves_compared_with_all_of_a_mesh_say_what_they_say_of_each_leaf_of_it(
            is_a in any::<bool>(),
            is_refined in any::<bool>(),
            count in 60_usize..400,
            std in 0.0002_f64..0.01,
            most_edge in 0.002_f64..0.01,
            offset in 0.02_f64..0.15,
            turn in -3.0_f64..3.0,
            are_boxes in any::<[bool; 2]>(),
            seed in any::<u64>(),
        ) {
            let mesh = scene::subdivide_to_max_edge(&shape(are_boxes[0]), most_edge);
            let mesh = Body::from(Mesh::prepare(&mesh).unwrap());
            let cloud = cloud(&shape(are_boxes[1]), count, std, seed);
            let cloud = Body::Cloud(if is_refined { cloud.refined().unwrap() } else { cloud });
            let offset = Vector3::new(0.3 * offset, 0.2 * offset, offset);
            let pose = Pose::from_translation_rpy(offset, [turn, 0.3, 0.0]);
            let (a, b) = if is_a { (&mesh, &cloud) } else { (&cloud, &mesh) };
            let bodies: (BodyRef<'_>, BodyRef<'_>) = (a.into(), b.into());
            let by = |few: usize| {
                let course = |_| Course::Further(WITH_EXTENT);
                search_settling(few, bodies, &pose, course, &mut Stats::default()).unwrap()
            };
            let one_by_one = by(usize::MAX);
            for few in [1, FEW] {
                let at_once = by(few);
                prop_assert_eq!(one_by_one.deviations, at_once.deviations);
                let is_same = |p: f64, q: f64| (p - q).abs() <= 1e-12 * (1.0 + p.abs());
                let [p, q] = [&one_by_one, &at_once].map(|found| found.crossings.clearness());
                prop_assert!(is_same(p, q), "clearness {} and {}", p, q);
                let [p, q] = [&one_by_one, &at_once].map(|found| found.extent(bodies, &pose));
                prop_assert!(is_same(p, q), "extent {} and {}", p, q);
                let [p, q] = [&one_by_one, &at_once].map(|found| found.extent_by_pose(bodies, &pose));
                prop_assert!((p - q).norm() <= 1e-9 * (1.0 + p.norm()), "by pose {} and {}", p, q);
                let BodyRef::Mesh(mesh) = (if is_a { bodies.0 } else { bodies.1 }) else { unreachable!() };
                let mesh_from_a = if is_a { Pose::identity() } else { pose.inverse() };
                for (place, _) in pieces(&at_once) {
                    let distance = mesh.distance(&mesh_from_a.transform_point(&place));
                    prop_assert!(at_once.at_least <= distance + 1e-9);
                }
                let [p, q] = [&one_by_one, &at_once].map(likely);
                prop_assert_eq!(p, q);
            }
        }
    }
}
