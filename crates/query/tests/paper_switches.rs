//! Each setting of the paper's path acts in a query, one at a time, and by default each has its printed
//! value.

use crate::common::{assert_sound, at, measured, mesh};
use cloudtouch::bvh::Traversal;
use cloudtouch::geom::{Point3, PointCloud, Pose};
use cloudtouch::noise::{Discretization, MotionNoise, SensorModel, Summed};
use cloudtouch::paper::{Closeness, Kernel, MeshPoints, RadiusRule, Scaling};
use cloudtouch::{
    Cloud, CloudSettings, PaperCloud, PaperCloudSettings, PaperNoise, PaperQuery, PaperSettings,
    Pooling, PrepareError, Query, QuerySettings, Report, Verdict,
};
use cloudtouch_testkit::scene;

const STD: f64 = 0.002;
const SENSOR: SensorModel = SensorModel::Isotropic { std: STD };

fn cloud(points: Vec<Point3>, change: impl FnOnce(&mut PaperCloudSettings)) -> PaperCloud {
    let mut settings = PaperCloudSettings::new(SENSOR);
    change(&mut settings);
    PaperCloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// A floor and a ball of 5 cm, both sampled at 15 mm.
fn floor_and_ball(change: impl Fn(&mut PaperCloudSettings)) -> [PaperCloud; 2] {
    [
        cloud(measured(&scene::plane_patch(0.2), 0.015, STD, 1), &change),
        cloud(measured(&scene::sphere(0.05, 3), 0.015, STD, 2), &change),
    ]
}

fn ask(clouds: &[PaperCloud; 2], pose: &Pose, settings: PaperSettings) -> Report {
    let report =
        PaperQuery::new(settings).expect("good settings").run(&clouds[0], &clouds[1], pose);
    let report = report.expect("a finite pose");
    assert_sound(&report);
    report
}

/// With the ball as far above the floor as `gap`.
fn with(change: impl FnOnce(&mut PaperSettings), gap: f64) -> Report {
    let mut settings = PaperSettings { stop_above: 1.0, ..PaperSettings::default() };
    change(&mut settings);
    ask(&floor_and_ball(|_| {}), &at(0.0, 0.0, 0.05 + gap), settings)
}

/// Balance, the scale of a leaf pair and the distrust of large noise were always on, the linear kernel
/// not to be had.
#[test]
fn each_switch_of_the_classifier_changes_what_is_answered() {
    // Resting on the floor's noise, and clearer: not each matters everywhere.
    let gaps = [0.004, 0.006, 0.008];
    let printed = gaps.map(|gap| with(|_| {}, gap).collision_probability);
    type Change = (&'static str, fn(&mut PaperSettings));
    let changes: [Change; 7] = [
        ("balanced", |s| s.balanced = true),
        ("scaling", |s| s.scaling = Scaling::LeafPair),
        ("kernel", |s| s.kernel = Kernel::Linear),
        ("shared points", |s| s.shared_points = false),
        ("penalty", |s| s.penalty = 10.0),
        ("kappa", |s| s.kappa = 0.99),
        ("radius rule", |s| s.radius_rule = RadiusRule::Chebyshev),
    ];
    for (name, change) in changes {
        let changed = gaps.map(|gap| with(change, gap).collision_probability);
        let differs = changed.iter().zip(&printed).any(|(p, q)| (p - q).abs() > 1e-3);
        assert!(differs, "{name}: {changed:?} and {printed:?}");
    }
}

/// The certificate answered in place of eq. 10's own linear problem, whatever was asked.
#[test]
fn a_plane_is_tried_only_where_it_is_asked_for() {
    let printed = with(|_| {}, 0.02).stats;
    assert_eq!(printed.linear_certificates, 0);
    assert!(printed.kernel_solves > 0);
    assert_eq!(printed.kernel_solves, printed.leaf_pairs);
    assert!(with(|s| s.plane_first = true, 0.02).stats.linear_certificates > 0);
}

/// Where the noise is large the kernel's answer was replaced by one half, in the paper's mode too.
#[test]
fn large_noise_is_distrusted_only_where_it_is_asked_for() {
    let noisy = |mesh, seed| {
        let cloud = PointCloud::from_points(measured(mesh, 0.015, 0.001, seed));
        let mut settings = PaperCloudSettings::new(SensorModel::Isotropic { std: 0.03 });
        settings.model.noise = PaperNoise::Convolution;
        PaperCloud::prepare(&cloud, &settings).expect("a good cloud")
    };
    let clouds = [noisy(&scene::plane_patch(0.2), 1), noisy(&scene::sphere(0.05, 3), 2)];
    let pose = at(0.0, 0.0, 0.12);
    let asked = |distrust_noise| {
        let settings = PaperSettings { distrust_noise, ..PaperSettings::default() };
        ask(&clouds, &pose, settings).collision_probability
    };
    let (printed, distrusted) = (asked(false), asked(true));
    assert!(printed < 0.4, "{printed}");
    assert_eq!(distrusted, 0.5);
}

/// "Close to each other" was three spacings and four fifths of the largest, fixed in the code.
#[test]
fn closeness_decides_how_many_witnesses_there_are() {
    let noisy_or = |closeness: Closeness| {
        let settings =
            PaperSettings { pooling: Pooling::NoisyOr, closeness, ..PaperSettings::amended() };
        // Resting on the floor's noise: several points are about as probable.
        ask(&floor_and_ball(|_| {}), &at(0.0, 0.0, 0.056), settings).collision_probability
    };
    let usual = Closeness::default();
    let of_usual = noisy_or(usual);
    let crowded = noisy_or(Closeness { share_of_max: 0.1, spacings: 0.0 });
    assert!(crowded > of_usual + 0.01, "{crowded} and {of_usual}");
    let [none, negative] = [(1.0, 1.0), (0.5, -1.0)].map(|(share_of_max, spacings)| {
        let closeness = Closeness { share_of_max, spacings };
        PaperQuery::new(PaperSettings { closeness, ..PaperSettings::default() }).is_err()
    });
    assert!(none && negative);
}

/// A triangle stands for three corners and a centroid, as printed: a large one that is pierced between
/// them reads as free, which was never so.
#[test]
fn four_points_a_triangle_miss_what_pierces_between_them() {
    let wall = mesh(&scene::cuboid([1.0, 1.0, 0.01]));
    let ball = cloud(measured(&scene::sphere(0.05, 3), 0.015, STD, 2), |_| {});
    let asked = |mesh_points, (x, y)| {
        let settings = PaperSettings { mesh_points, ..PaperSettings::amended() };
        // No volume: the wall is not closed to the query.
        let settings = PaperSettings { points_inside: false, ..settings };
        let query = PaperQuery::new(settings).expect("good settings");
        query.run(&wall, &ball, &at(x, y, 0.0)).expect("a finite pose")
    };
    let between = (0.3, -0.2);
    let dense = asked(MeshPoints::AsDenseAsCloud, between);
    assert_eq!(dense.verdict, Verdict::InCollision, "{dense:?}");
    let printed = asked(MeshPoints::FourPerTriangle, between);
    assert!(printed.collision_probability < 0.5, "{printed:?}");
}

/// One radius stood for all points.
#[test]
fn each_point_may_have_a_kappa_of_its_own() {
    let [floor, ball] = floor_and_ball(|_| {});
    let count = ball.len();
    let settings = PaperSettings { stop_above: 1.0, ..PaperSettings::default() };
    let pose = at(0.0, 0.0, 0.058);
    let probability = |clouds: &[PaperCloud; 2]| ask(clouds, &pose, settings).collision_probability;
    let usual = [floor, ball];
    let by_query = probability(&usual);
    let [floor, ball] = usual;
    // The same for each is the same as one for all.
    let alike = ball.with_kappas(&vec![settings.kappa; count], RadiusRule::Gaussian).unwrap();
    let clouds = [floor, alike];
    assert_eq!(probability(&clouds), by_query);
    let [floor, ball] = clouds;
    let mixed: Vec<f64> = (0..count).map(|i| if i % 2 == 0 { 0.5 } else { 0.999 }).collect();
    let clouds = [floor, ball.with_kappas(&mixed, RadiusRule::Gaussian).unwrap()];
    assert!((probability(&clouds) - by_query).abs() > 1e-3);
    let [_, ball] = clouds;
    assert!(matches!(
        ball.with_kappas(&[0.9], RadiusRule::Gaussian),
        Err(PrepareError::KappaCount { kappas: 1, .. })
    ));
}

/// Eq. 17 ran over twelve neighbours, under a cap.
#[test]
fn eq_17_is_as_printed_and_the_nearest_and_the_cap_are_options() {
    let probability = |change: fn(&mut Discretization)| {
        let clouds = floor_and_ball(|settings| {
            settings.model.noise = PaperNoise::Convolution;
            change(&mut settings.model.discretization);
        });
        let settings = PaperSettings { stop_above: 1.0, ..PaperSettings::default() };
        ask(&clouds, &at(0.0, 0.0, 0.065), settings).collision_probability
    };
    let printed = probability(|_| {});
    assert_eq!(probability(|d| d.summed = Summed::AllPoints), printed);
    assert!((probability(|d| d.summed = Summed::Neighbors) - printed).abs() > 1e-4);
    assert!((probability(|d| d.width = 1.0) - printed).abs() > 1e-3);
    assert!((probability(|d| d.neighbors = 30) - printed).abs() > 1e-3);
}

/// A lone point far from the others has a Ψ as wide as the way to them. It must be culled by what it
/// is, and not by the cap that it does not have.
#[test]
fn without_a_cap_isolated_points_are_not_culled_by_one() {
    let leaf_pairs = |is_capped| {
        let mut points = measured(&scene::plane_patch(0.2), 0.015, STD, 1);
        points.push(Point3::new(0.0, 0.0, 0.6));
        let floor = cloud(points, |settings| {
            settings.model.noise = PaperNoise::Convolution;
            settings.model.discretization.is_capped = is_capped;
        });
        let ball = cloud(measured(&scene::sphere(0.05, 3), 0.015, STD, 2), |_| {});
        let traversal = Traversal::Certified;
        let settings = PaperSettings { traversal, ..PaperSettings::default() };
        // Two metres from the ball, and known to half a metre.
        ask(&[floor, ball], &at(0.0, 0.0, 2.6), settings).stats.leaf_pairs
    };
    assert_eq!(leaf_pairs(true), 0);
    assert!(leaf_pairs(false) > 0);
}

/// Poses and meshes were exact, and clouds stood still.
#[test]
fn motion_of_a_body_adds_to_its_noise() {
    let probability = |motion: MotionNoise| {
        let clouds = floor_and_ball(|settings| {
            // The other way of combining would keep Ψ as the bound on any noise.
            settings.model.noise = PaperNoise::Convolution;
            settings.model.motion = motion;
        });
        let settings = PaperSettings { stop_above: 1.0, ..PaperSettings::amended() };
        ask(&clouds, &at(0.0, 0.0, 0.09), settings).collision_probability
    };
    let still = probability(MotionNoise::default());
    let falling = MotionNoise { translation_std: [0.0, 0.0, 0.02], ..MotionNoise::default() };
    let sliding = MotionNoise { translation_std: [0.02, 0.0, 0.0], ..MotionNoise::default() };
    let bending = MotionNoise { deformation_std: 0.02, ..MotionNoise::default() };
    assert!(probability(falling) > still + 0.01, "{still} and {}", probability(falling));
    assert!(probability(bending) > still + 0.01);
    assert!(probability(sliding) < probability(falling));
}

/// The printed limit (fig. 3 c): leaves see only the surface about them, and an object wholly inside
/// another reads as free. The default path finds it.
#[test]
fn an_object_inside_a_closed_mesh_is_missed_as_printed_and_found_by_default() {
    let block = mesh(&scene::cuboid([0.6, 0.6, 0.6]));
    let points = measured(&scene::sphere(0.05, 3), 0.015, STD, 2);
    let ball = cloud(points.clone(), |_| {});
    let asked = |settings| {
        let query = PaperQuery::new(settings).expect("good settings");
        query.run(&block, &ball, &Pose::identity()).expect("a finite pose")
    };
    let printed = asked(PaperSettings::default());
    assert!(printed.collision_probability < 0.1, "{printed:?}");
    assert_eq!(asked(PaperSettings::amended()).verdict, Verdict::InCollision);
    let scan = Cloud::prepare(&PointCloud::from_points(points), &CloudSettings::new(SENSOR));
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let found = query.run(&block, &scan.expect("a good cloud"), &Pose::identity());
    assert_eq!(found.expect("a finite pose").verdict, Verdict::InCollision);
}
