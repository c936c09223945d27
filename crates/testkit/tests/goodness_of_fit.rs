//! Noise has the distribution it claims: Kolmogorov-Smirnov at a stated false-alarm rate.

use cloudtouch_geom::{Point3, normal};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// How often a right generator would fail one of these tests, were the seed drawn anew.
const FALSE_ALARM_RATE: f64 = 1e-6;
const SAMPLES: usize = 100_000;
const STD: f64 = 0.005;

/// The largest distance between the sample's and the claimed distribution function.
fn kolmogorov_smirnov(mut values: Vec<f64>, cdf: impl Fn(f64) -> f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    values
        .iter()
        .enumerate()
        .map(|(i, &v)| (cdf(v) - i as f64 / n).abs().max((cdf(v) - (i + 1) as f64 / n).abs()))
        .fold(0.0, f64::max)
}

/// What a sample of n values exceeds with probability `FALSE_ALARM_RATE` (Massart's bound).
fn critical(n: usize) -> f64 {
    ((2.0 / FALSE_ALARM_RATE).ln() / (2.0 * n as f64)).sqrt()
}

/// Student's t with three degrees of freedom.
fn student_cdf(t: f64) -> f64 {
    let s = t / 3.0_f64.sqrt();
    0.5 + (s / (1.0 + s * s) + s.atan()) / std::f64::consts::PI
}

fn errors(kind: NoiseKind, axis: usize) -> Vec<f64> {
    let moved = add_noise(&vec![Point3::new(1.0, 2.0, 3.0); SAMPLES], kind, STD, 17);
    moved.iter().map(|p| p[axis] - (axis + 1) as f64).collect()
}

#[test]
fn gaussian_noise_is_normal_along_every_axis() {
    for axis in 0..3 {
        let d = kolmogorov_smirnov(errors(NoiseKind::Gaussian, axis), |v| normal::cdf(v / STD));
        assert!(d < critical(SAMPLES), "axis {axis}: {d}");
    }
}

#[test]
fn heavy_tailed_noise_is_student_t_with_the_variance_asked_for() {
    let root3 = 3.0_f64.sqrt();
    for axis in 0..3 {
        let d = kolmogorov_smirnov(errors(NoiseKind::HeavyTailed, axis), |v| {
            student_cdf(v / STD * root3)
        });
        assert!(d < critical(SAMPLES), "axis {axis}: {d}");
    }
}

#[test]
fn the_test_tells_the_two_and_a_wrong_spread_apart() {
    let heavy = kolmogorov_smirnov(errors(NoiseKind::HeavyTailed, 0), |v| normal::cdf(v / STD));
    let wide =
        kolmogorov_smirnov(errors(NoiseKind::Gaussian, 0), |v| normal::cdf(v / (1.05 * STD)));
    assert!(heavy > critical(SAMPLES) && wide > critical(SAMPLES), "{heavy}, {wide}");
}

#[test]
fn axes_are_uncorrelated() {
    for kind in [NoiseKind::Gaussian, NoiseKind::HeavyTailed] {
        let (x, y) = (errors(kind, 0), errors(kind, 1));
        // Signs, because the fourth moment of t with three degrees of freedom is infinite.
        let agree = x.iter().zip(&y).filter(|(a, b)| (**a > 0.0) == (**b > 0.0)).count();
        let excess = agree as f64 - 0.5 * SAMPLES as f64;
        assert!(excess.abs() < 5.0 * 0.5 * (SAMPLES as f64).sqrt(), "{kind:?}: {excess}");
    }
}
