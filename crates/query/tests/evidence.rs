//! What a report tells of its evidence is all that its probability rests on.

use cloudtouch::{Cloud, CloudSettings, Judge, Query, QuerySettings};
use cloudtouch_geom::{PointCloud, Pose, Vector3};
use cloudtouch_noise::SensorModel;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

fn ball(std: f64, seed: u64) -> Cloud {
    let samples = surface::sample_surface(&scene::sphere(0.1, 3), 1500, seed);
    let points = add_noise(&surface::positions(&samples), NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

#[test]
fn log_odds_are_made_of_the_evidence_again() {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let mut asked = 0;
    for (std, blur) in [(0.0, 0.0..1e-9), (0.004, 0.4..0.7), (0.012, 1.2..2.0)] {
        let (a, b) = (ball(std, 1), ball(std, 2));
        for step in 0..20 {
            let distance = 0.215 - 0.002 * f64::from(step);
            let pose = Pose::from_translation(Vector3::new(distance, 0.0, 0.0));
            let report = query.run(&a, &b, &pose).expect("an answer");
            let evidence = report.evidence.expect("of clouds");
            assert!(blur.contains(&evidence.noise_over_spacing), "{evidence:?}");
            let again = Judge::default().log_odds(&evidence);
            let told = report.log_likelihood_ratio.expect("of clouds");
            assert!((again - told).abs() < 1e-12, "{std} {distance}: {again} {report:?}");
            asked += usize::from(evidence.misclassified.is_some());
        }
    }
    // With a classifier too.
    assert!(asked >= 2, "{asked}");
}
