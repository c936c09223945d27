//! The first values for a seed are pinned: a changed stream changes fixtures and must be announced.

use cloudtouch_geom::Point3;
use cloudtouch_testkit::{
    noise::{NoiseKind, add_noise},
    scene,
    surface::{positions, sample_surface},
};

/// Platforms differ in the last bits of `exp` and `ln`.
const LAST_BITS: f64 = 1e-13;

fn check(found: &[Point3], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - Point3::from(*e)).amax() < LAST_BITS, "found {found:?}");
    }
}

#[test]
fn surface_samples_are_stable() {
    let points = positions(&sample_surface(&scene::piano(), 3, 42));
    check(
        &points,
        &[
            [0.6918758176950696, -0.06906835308022508, 0.98],
            [-0.6480717297161076, -0.0141163339083345, 1.054553445951622],
            [0.594884279834202, -0.925, 0.7414896144457223],
        ],
    );
}

#[test]
fn gaussian_noise_is_stable() {
    check(
        &add_noise(&[Point3::origin(); 2], NoiseKind::Gaussian, 1.0, 42),
        &[
            [0.47798123835102174, 1.3340706102318078, -0.21086668327103028],
            [0.4763469238088213, -0.5120906220561634, -0.9339784493906981],
        ],
    );
}

#[test]
fn heavy_tailed_noise_is_stable() {
    check(
        &add_noise(&[Point3::origin(); 2], NoiseKind::HeavyTailed, 1.0, 42),
        &[
            [0.25472709497509105, 0.7109566312860887, -0.11237566110746773],
            [-0.2872477668144421, -0.3082841980140328, 0.2819225225004828],
        ],
    );
}
