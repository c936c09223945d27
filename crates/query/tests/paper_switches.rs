//! Each setting of the paper's path acts in a query, one at a time, and by default each has its printed
//! value.

mod common;

use cloudtouch::geom::{Point3, PointCloud, Pose};
use cloudtouch::noise::{MotionNoise, SensorModel};
use cloudtouch::paper::{Closeness, Kernel, MeshPoints, RadiusRule, Scaling};
use cloudtouch::{
    PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings, Pooling, Report, Verdict,
};
use cloudtouch_testkit::scene;
use common::{assert_sound, at, measured, mesh};

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
    let report = PaperQuery::new(settings).expect("good settings").run(&clouds[0], &clouds[1], pose);
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
    let gap = 0.008;
    let printed = with(|_| {}, gap).collision_probability;
    let changes: [(&str, fn(&mut PaperSettings)); 6] = [
        ("balanced", |s| s.balanced = true),
        ("scaling", |s| s.scaling = Scaling::LeafPair),
        ("kernel", |s| s.kernel = Kernel::Linear),
        ("penalty", |s| s.penalty = 10.0),
        ("kappa", |s| s.kappa = 0.99),
        ("radius rule", |s| s.radius_rule = RadiusRule::Chebyshev),
    ];
    for (name, change) in changes {
        let changed = with(change, gap).collision_probability;
        assert!((changed - printed).abs() > 1e-3, "{name}: {changed} and {printed}");
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
