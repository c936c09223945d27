//! The interval of an answer contains what a query that never stops early finds.
//!
//! That such a search finds what every piece against every piece gives is tested beside it
//! (`search::run::tests`).

use crate::common::{assert_sound, at, mesh};
use cloudtouch::bvh::TreeSettings;
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{BodyRef, Cloud, CloudSettings, Mesh, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};
use proptest::prelude::*;

/// The same pair of leaves is solved from the same numbers both times, so only the bound of what
/// was culled may be off, by the tolerance of the plane found for it.
const TOLERANCE: f64 = 1e-3;

fn run(settings: QuerySettings, a: BodyRef<'_>, b: BodyRef<'_>, pose: &Pose) -> Report {
    let report = Query::new(settings).expect("good settings").run(a, b, pose).expect("good pose");
    assert_sound(&report);
    report
}

fn flat() -> QuerySettings {
    QuerySettings { stop_above: 1.0, ..QuerySettings::default() }
}

/// A cloud of `count` points with small leaves, so that there is something to cull.
fn small_cloud(shape: &TriangleMesh, count: usize, std: f64, seed: u64) -> Cloud {
    let points: Vec<Point3> = surface::positions(&surface::sample_surface(shape, count, seed));
    let points = add_noise(&points, NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings {
        tree: TreeSettings { max_leaf_points: 12, min_leaf_points: 4, ..TreeSettings::default() },
        ..CloudSettings::new(SensorModel::Isotropic { std })
    };
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// A random pair: a patch or a ball below, a ball of 5 cm above it.
#[derive(Debug, Clone)]
struct Pair {
    below: TriangleMesh,
    counts: [usize; 2],
    std: f64,
    pose: Pose,
    seed: u64,
}

fn pairs() -> impl Strategy<Value = Pair> {
    (
        any::<bool>(),
        [30_usize..150, 30_usize..150],
        // From far below the spacing (about 2 cm) to the order of the gap.
        0.0005_f64..0.01,
        (-0.02_f64..0.02, -0.02_f64..0.02, -0.03_f64..0.08),
        any::<u64>(),
    )
        .prop_map(|(is_patch, counts, std, (x, y, gap), seed)| {
            let (below, top) = if is_patch {
                (scene::plane_patch(0.2), 0.0)
            } else {
                (scene::sphere(0.05, 2), 0.05)
            };
            Pair { below, counts, std, pose: at(x, y, top + 0.05 + gap), seed }
        })
}

fn contains(report: &Report, flat: f64) -> Result<(), TestCaseError> {
    let [lower, upper] = report.bounds;
    prop_assert!(flat >= lower - TOLERANCE, "flat {} below {:?}", flat, report);
    prop_assert!(flat <= upper + TOLERANCE, "flat {} above {:?}", flat, report);
    Ok(())
}

fn check(
    a: BodyRef<'_>,
    b: BodyRef<'_>,
    pose: &Pose,
    stop_above: f64,
) -> Result<(), TestCaseError> {
    let reference = run(flat(), a, b, pose);
    contains(&run(QuerySettings::default(), a, b, pose), reference.collision_probability)?;
    let early = QuerySettings { stop_above, ..QuerySettings::default() };
    contains(&run(early, a, b, pose), reference.collision_probability)
}

proptest! {
    // Each case solves up to some hundred kernel problems.
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn two_clouds(pair in pairs(), stop in 0.5_f64..1.0) {
        let a = small_cloud(&pair.below, pair.counts[0], pair.std, pair.seed);
        let b = small_cloud(&scene::sphere(0.05, 2), pair.counts[1], pair.std, !pair.seed);
        check((&a).into(), (&b).into(), &pair.pose, stop)?;
    }

    #[test]
    fn a_cloud_and_a_watertight_mesh(pair in pairs(), stop in 0.5_f64..1.0) {
        let a = small_cloud(&pair.below, pair.counts[0], pair.std, pair.seed);
        let b: Mesh = mesh(&scene::sphere(0.05, 2));
        check((&a).into(), (&b).into(), &pair.pose, stop)?;
    }

    #[test]
    fn an_open_mesh_and_a_cloud(pair in pairs(), stop in 0.5_f64..1.0) {
        let a: Mesh = mesh(&scene::plane_patch(0.2));
        let b = small_cloud(&scene::sphere(0.05, 2), pair.counts[1], pair.std, pair.seed);
        let gap = pair.pose.translation().z - 0.05;
        check((&a).into(), (&b).into(), &at(0.01, 0.0, gap), stop)?;
    }
}

/// Stopping early keeps a lower end that holds and gives up the upper one.
#[test]
fn an_early_stop_widens_the_upper_end_only() {
    let a = small_cloud(&scene::plane_patch(0.2), 600, 0.001, 1);
    let b = small_cloud(&scene::sphere(0.05, 2), 600, 0.001, 2);
    let pose = at(0.0, 0.0, 0.02);
    let full = run(flat(), (&a).into(), (&b).into(), &pose);
    let early = QuerySettings { stop_above: 0.92, ..QuerySettings::default() };
    let early = run(early, (&a).into(), (&b).into(), &pose);
    assert!(early.stats.leaf_pairs < full.stats.leaf_pairs, "the search did not stop early");
    assert!(early.bounds[0] > 0.92 && early.bounds[0] <= full.collision_probability + TOLERANCE);
    assert!(early.bounds[1] >= full.bounds[1] - TOLERANCE, "{:?}, {:?}", early.bounds, full.bounds);
}

/// A point inside of a closed mesh that is enough spares the others their fits, and leaves open how much more
/// clearly these are inside.
#[test]
fn a_look_inside_ends_at_what_is_enough_and_widens_the_upper_end_only() {
    let ball = mesh(&scene::sphere(0.05, 3));
    let run = |settings: QuerySettings| {
        // Fresh each time: it counts the leaves that are computed.
        let sheet = small_cloud(&scene::plane_patch(0.2), 2000, 0.003, 1);
        run(settings, (&sheet).into(), (&ball).into(), &at(0.0, 0.0, 0.02))
    };
    let full = run(flat());
    let early = run(QuerySettings { stop_above: 0.9, ..QuerySettings::default() });
    let prepared = [&early, &full].map(|report| report.stats.leaves_prepared);
    assert!(4 * prepared[0] < prepared[1], "{prepared:?}");
    assert!(early.bounds[0] > 0.9 && early.bounds[0] <= full.collision_probability + TOLERANCE);
    assert!(early.bounds[1] >= full.bounds[1] - TOLERANCE, "{:?}, {:?}", early.bounds, full.bounds);
}

/// Where nothing is within six deviations the odds are those of the fit there: small, and not zero.
#[test]
fn far_apart_the_upper_bound_is_small_and_the_verdict_free() {
    let a = small_cloud(&scene::plane_patch(0.2), 100, 0.003, 1);
    let b = small_cloud(&scene::sphere(0.05, 2), 100, 0.003, 2);
    let report = run(QuerySettings::default(), (&a).into(), (&b).into(), &at(0.0, 0.0, 0.5));
    assert_eq!(report.verdict, Verdict::Free);
    assert_eq!(report.stats.kernel_solves, 0);
    assert!(report.bounds[1] <= 5e-4, "{:?}", report.bounds);
}

/// A culled pair's edge to a neighbouring leaf raised its points above the bound it was culled by.
#[test]
fn an_edge_that_leaves_its_leaf_raises_no_point_above_the_bound_of_the_pair() {
    let seed = 745_084_910_551_866_825;
    let a = small_cloud(&scene::plane_patch(0.2), 31, 0.0005, seed);
    let b = small_cloud(&scene::sphere(0.05, 2), 35, 0.0005, !seed);
    let pose = at(0.0, 0.0, 0.076_512_129_135_623_18);
    check((&a).into(), (&b).into(), &pose, 0.5).expect("contained");
}

/// The lower bound lay above the flat answer: with an early stop at one half, a pair above one half
/// was not solved as tightly.
#[test]
fn how_tightly_a_pair_is_solved_does_not_depend_on_the_early_stop() {
    let seed = 10_873_337_821_766_386_607;
    let a = small_cloud(&scene::plane_patch(0.2), 54, 0.005_637_064_950_103_49, seed);
    let b = small_cloud(&scene::sphere(0.05, 2), 34, 0.005_637_064_950_103_49, !seed);
    let pose = at(-0.004_013_779_780_147_773, 0.016_674_680_821_064_99, 0.020_518_018_600_221_95);
    check((&a).into(), (&b).into(), &pose, 0.5).expect("contained");
}
