//! What a query by the paper tells of its classifiers: f, ξ, α, v, b (eq. 10 to 15) and P (eq. 16).

use crate::common::{at, measured};
use cloudtouch::geom::{Point3, PointCloud, Vector3, normal};
use cloudtouch::noise::SensorModel;
use cloudtouch::paper::LeafClassifier;
use cloudtouch::{PaperCloud, PaperCloudSettings, PaperNoise, PaperQuery, PaperSettings};
use cloudtouch_testkit::scene;

const STD: f64 = 0.004;
/// Far from the origin, as maps are.
const FAR: f64 = 1000.0;

fn prepared(mesh: &cloudtouch::geom::TriangleMesh, seed: u64, offset: f64) -> PaperCloud {
    let sensor = SensorModel::Isotropic { std: STD };
    let mut settings = PaperCloudSettings::new(sensor);
    settings.model.noise = PaperNoise::Convolution;
    let mut points = measured(mesh, 0.015, STD, seed);
    for point in &mut points {
        point.x += offset;
    }
    PaperCloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

fn explained(settings: PaperSettings) -> (f64, Vec<LeafClassifier>) {
    let floor = prepared(&scene::plane_patch(0.2), 1, FAR);
    let ball = prepared(&scene::sphere(0.05, 3), 2, 0.0);
    let query = PaperQuery::new(settings).expect("good settings");
    let pose = at(FAR, 0.0, 0.056);
    let (report, classifiers) = query.explain(&floor, &ball, &pose).expect("a finite pose");
    let alone = query.run(&floor, &ball, &pose).expect("a finite pose");
    assert_eq!(report.collision_probability, alone.collision_probability);
    (report.max_probability, classifiers)
}

#[test]
fn what_is_told_satisfies_the_equations_of_the_paper() {
    let settings = PaperSettings { stop_above: 1.0, ..PaperSettings::default() };
    let (most, classifiers) = explained(settings);
    assert!(!classifiers.is_empty());
    let mut largest = 0.0_f64;
    for classifier in &classifiers {
        let mut balance = 0.0;
        let mut slack = 0.0;
        for point in &classifier.points {
            // Eq. 13: 0 ≤ α ≤ C, |v| ≤ rα with r = 1 and C as printed for all; Σ cα = 0.
            assert!((0.0..=settings.penalty * (1.0 + 1e-12)).contains(&point.alpha), "{point:?}");
            let v = Vector3::from(point.v).norm();
            assert!(v <= point.alpha * (1.0 + 1e-9) + 1e-12, "{point:?}");
            balance += point.class * point.alpha;
            // Eq. 10: what the ellipsoid misses the margin by.
            let margin = point.class * point.f - point.deviation;
            assert!((point.xi - (1.0 - margin).max(0.0)).abs() < 1e-9, "{point:?}");
            slack += settings.penalty * point.xi;
            // Eq. 16.
            let probability = normal::below_zero(point.class * point.f, point.deviation);
            assert!((point.probability - probability).abs() < 1e-9, "{point:?}");
            largest = largest.max(point.probability);
            // Eq. 14: f is the function that is told.
            let (f, gradient) = classifier.value_and_gradient(&Point3::from(point.position));
            assert!((f - point.f).abs() < 1e-6 * (1.0 + f.abs()), "{f} {point:?}");
            assert!(gradient.iter().all(|g| g.is_finite()));
        }
        let alphas: f64 = classifier.points.iter().map(|p| p.alpha).sum();
        assert!(balance.abs() <= 1e-9 * alphas.max(1.0), "{balance}");
        // The slack is part of the primal, which is no smaller than the dual.
        let [primal, dual] = classifier.objective;
        assert!(slack <= primal * (1.0 + 1e-6), "{slack} of {primal}");
        assert!(dual <= primal && primal - dual <= settings.relative_gap * primal);
        let [low, high] = classifier.bias_interval;
        assert!(low <= classifier.bias && classifier.bias <= high);
    }
    assert_eq!(largest, most);
}
