//! The search for what two bodies say of a collision by their geometry alone.

use cloudtouch_bvh::{Sought, SurfaceFlow, SurfacePair, visit_surfaces};
use cloudtouch_geom::{Motion, Pose, Vector3};
use cloudtouch_noise::Scratch;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::stats::Stats;

use super::compare::meeting::{Meeting, deviations_by_pose};
use super::cross::crossings::Crossings;
use super::cross::gather::{
    NearDisc, add_edges_through_discs, add_edges_through_facets, add_mesh_through_discs,
};
use super::cross::near::{may_cross_a_disc, may_cross_a_facet, reaching, reaching_facets};
use super::measure::nearest::{Nearest, nearest_pieces};
use super::visit::around::{Around, OfMesh};
use super::visit::leaf::{Between, Leaf, NoisyLeaf};
use super::visit::leaves::Leaves;
use super::visit::trees::Trees;
use super::visit::unseen::Unseen;
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
    around: Around,
    /// Memory for the discs of a leaf that edges may pass, to use again, ...
    discs: Vec<NearDisc>,
    /// ... and for fits of either body.
    scratch: [Scratch; 2],
    /// How many deviations above the least is looked.
    pub(super) further: f64,
    /// Whether what was left out can change neither of these.
    pub is_complete: bool,
    /// No two pieces are nearer than this, m; negative where surfaces may cross.
    pub at_least: f64,
}

/// Looks at the pairs of leaves where the surfaces may touch, up to so many deviations `further` than the least,
/// until `is_enough` of the deviations
/// and of the clearness of crossings, as far as found.
pub(crate) fn search<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    further: f64,
    is_enough: impl Fn(f64, f64) -> bool,
    stats: &mut Stats,
) -> Result<Found<'a>, QueryError> {
    let (deviations, at_least) = (MOST_DEVIATIONS, f64::INFINITY);
    let mut found = Found { deviations, further, at_least, ..Found::default() };
    let motion = Motion::from(a_from_b);
    let mut trees = Trees::of(a, b);
    let outcome = visit_surfaces(trees.both(), a_from_b, SOUGHT, |pair| {
        stats.leaf_pairs += 1;
        match found.told_apart((a, b), &motion, &pair, trees.may_be_loose(), stats) {
            Some(apart) => found.at_least = found.at_least.min(apart),
            None => found.add((a, b), &motion, &pair, stats),
        }
        trees.count_pair([found.leaves_a.len(), found.leaves_b.len()]);
        let (deviations, clearness) = (found.deviations, found.crossings.last_clearness());
        if is_enough(deviations, clearness) {
            return SurfaceFlow::Stop;
        }
        let within = found.deviations_of_interest();
        trees.flow(within, stats, || is_enough(deviations, clearness))
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

    /// What the least deviations change by as the pose does: those of the two pieces that have them.
    pub(crate) fn deviations_by_pose(&self) -> Wrench {
        let least = self.findings.iter().map(|finding| &finding.nearest);
        least
            .min_by(|p, q| p.squared.total_cmp(&q.squared))
            .and_then(|nearest| deviations_by_pose(&nearest.a, &nearest.b))
            .unwrap_or_else(Wrench::zeros)
    }

    /// How far apart the surfaces of two leaves are, m, where one of them tells that the other, whose surface was
    /// not looked at yet, changes nothing.
    fn told_apart(
        &mut self,
        (a, b): (BodyRef<'a>, BodyRef<'a>),
        a_from_b: &Motion,
        pair: &SurfacePair,
        [is_a_loose, is_b_loose]: [bool; 2],
        stats: &mut Stats,
    ) -> Option<f64> {
        let most = self.deviations_of_interest();
        let Self { leaves_a, leaves_b, around, scratch: [of_a, of_b], .. } = self;
        let is_unseen_a = is_a_loose && !leaves_a.has(pair.a);
        let is_unseen_b = is_b_loose && !leaves_b.has(pair.b);
        let unseen_a = is_unseen_a.then(|| Unseen::of(a, pair.a, None)).flatten();
        let unseen_b = is_unseen_b.then(|| Unseen::of(b, pair.b, Some(a_from_b))).flatten();
        let is_b_first = match (&unseen_a, &unseen_b) {
            (None, None) => return None,
            (Some(a), Some(b)) => b.reach() > a.reach(),
            (unseen_a, _) => unseen_a.is_some(),
        };
        if is_b_first {
            let load_b = || around.load(b, pair.b, Some(a_from_b), (of_b, stats));
            unseen_a?.apart_from(leaves_b.get_or_load(pair.b, load_b), most)
        } else {
            let load_a = || around.load(a, pair.a, None, (of_a, stats));
            unseen_b?.apart_from(leaves_a.get_or_load(pair.a, load_a), most)
        }
    }

    fn add(
        &mut self,
        (a, b): (BodyRef<'a>, BodyRef<'a>),
        a_from_b: &Motion,
        pair: &SurfacePair,
        stats: &mut Stats,
    ) {
        let most = self.deviations_of_interest();
        let Self { around, scratch, .. } = self;
        let load_a = || around.load(a, pair.a, None, (&mut scratch[0], stats));
        let leaf_a = self.leaves_a.get_or_load(pair.a, load_a);
        let load_b = || around.load(b, pair.b, Some(a_from_b), (&mut scratch[1], stats));
        let leaf_b = self.leaves_b.get_or_load(pair.b, load_b);
        let Between { of_means, of_surfaces, most_std } = leaf_a.between(leaf_b);
        self.at_least = self.at_least.min(of_surfaces);
        // PERF: what the tree knows of leaves whose surface it has not seen is loose.
        let is_near = pair.deviations < most && of_means <= most * most_std;
        let nearest = is_near.then(|| nearest_pieces(leaf_a, leaf_b, most, scratch));
        if pair.may_cross && of_surfaces <= 0.0 {
            let found = (&mut self.crossings, around, &mut self.discs);
            cross((a, b), a_from_b, (leaf_a, leaf_b), scratch, found);
        }
        let Some(nearest) = nearest.flatten() else { return };
        self.deviations = self.deviations.min(nearest.squared.sqrt());
        if let Some(meeting) = Meeting::of(&nearest.a, &nearest.b) {
            let toward_b = leaf_b.middle() - leaf_a.middle();
            self.findings.push(Finding { nearest, meeting, toward_b });
        }
    }
}

fn cross<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Motion,
    leaves: (&mut Leaf<'a>, &mut Leaf<'a>),
    [of_a, of_b]: &mut [Scratch; 2],
    (crossings, known, discs): (&mut Crossings, &mut Around, &mut Vec<NearDisc>),
) {
    match leaves {
        (Leaf::Noisy(on_a), Leaf::Noisy(on_b)) => {
            let near = reaching(on_a, on_b);
            let may_cross = |on_a: &NoisyLeaf<'a>| may_cross_a_disc(on_a, on_b);
            if !near.is_none() && on_a.has_edges_or(may_cross, of_a) {
                add_edges_through_discs(None, (on_a, near), on_b, discs, crossings);
            }
            let near = reaching(on_b, on_a);
            let may_cross = |on_b: &NoisyLeaf<'a>| may_cross_a_disc(on_b, on_a);
            if !near.is_none() && on_b.has_edges_or(may_cross, of_b) {
                add_edges_through_discs(Some(a_from_b), (on_b, near), on_a, discs, crossings);
            }
        }
        (Leaf::Noisy(noisy), Leaf::Exact(exact)) => {
            let near = reaching_facets(noisy, exact);
            if !near.is_none() {
                if noisy.has_edges_or(|noisy| may_cross_a_facet(noisy, exact), of_a) {
                    add_edges_through_facets(None, (noisy, near), exact, crossings);
                }
                let mut around = OfMesh { known, body: b, a_from_mesh: Some(a_from_b) };
                add_mesh_through_discs(true, noisy, exact, &mut around, crossings);
            }
        }
        (Leaf::Exact(exact), Leaf::Noisy(noisy)) => {
            let near = reaching_facets(noisy, exact);
            if !near.is_none() {
                if noisy.has_edges_or(|noisy| may_cross_a_facet(noisy, exact), of_b) {
                    add_edges_through_facets(Some(a_from_b), (noisy, near), exact, crossings);
                }
                let mut around = OfMesh { known, body: a, a_from_mesh: None };
                add_mesh_through_discs(false, noisy, exact, &mut around, crossings);
            }
        }
        // Two meshes are tested exactly and never come here.
        (Leaf::Exact(_), Leaf::Exact(_)) => {}
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, PointCloud};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};
    use proptest::prelude::*;

    use super::*;
    use crate::Cloud;
    use crate::CloudSettings;
    use crate::cloud::{Edge, Surfel, edges_of};
    use crate::search::compare::meeting::squared_deviations;
    use crate::search::cross::crossing::through_disc;
    use crate::search::cross::crossings::Witness;
    use crate::search::cross::past::Past;

    fn ball(count: usize, std: f64, seed: u64) -> Cloud {
        let samples = surface::sample_surface(&scene::sphere(0.05, 2), count, seed);
        let points: Vec<Point3> =
            add_noise(&surface::positions(&samples), NoiseKind::Gaussian, std, seed);
        let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
        settings.tree.max_leaf_points = 12;
        settings.tree.min_leaf_points = 4;
        Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap()
    }

    /// All pieces and edges of a cloud, in the frame of A, as if it were one leaf.
    fn whole(cloud: &Cloud, a_from_cloud: &Pose) -> (Vec<Surfel>, Vec<Edge>) {
        let leaves = cloud.tree().leaves();
        let mut scratch = Scratch::default();
        let pieces = leaves.flat_map(|leaf| leaf.primitive_indices().to_vec());
        let surfels = pieces.map(|piece| cloud.prepared().told(piece, &mut scratch));
        let motion = Motion::from(a_from_cloud);
        let indices: Vec<u32> =
            cloud.tree().leaves().flat_map(|leaf| leaf.primitive_indices().to_vec()).collect();
        let edges = edges_of(cloud.prepared(), &indices, &mut cloudtouch_noise::Scratch::default());
        (
            surfels.map(|s| s.moved(&motion)).collect(),
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

    proptest! {
        #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

        #[test]
        fn the_search_finds_what_brute_force_finds(
            counts in [40_usize..200, 40_usize..200],
            std in 0.0002_f64..0.01,
            offset in 0.05_f64..0.2,
            turn in -3.0_f64..3.0,
            seed in any::<u64>(),
        ) {
            let (a, b) = (ball(counts[0], std, seed), ball(counts[1], std, !seed));
            let offset = Vector3::new(0.0, 0.3 * offset, offset);
            let pose = Pose::from_translation_rpy(offset, [turn, 0.3, 0.0]);
            let found =
                search((BodyRef::Cloud(&a), BodyRef::Cloud(&b)), &pose, WITH_EXTENT, |_, _| false, &mut Stats::default()).unwrap();
            prop_assert!(found.is_complete);
            let (deviations, clearness) = brute_force(&a, &b, &pose);
            prop_assert!((found.deviations - deviations).abs() < 1e-9);
            // The sums run in different orders.
            prop_assert!((found.crossings.clearness() - clearness).abs() <= 1e-9 * (1.0 + clearness));
        }
    }
}
