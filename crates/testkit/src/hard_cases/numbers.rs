//! Numbers far from one, covariances that are hardly or not at all ones, and no numbers.

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use super::case::{HardCase, apart, crossing, isotropic, patch};

pub(super) fn scales() -> Vec<HardCase> {
    let utm = Vector3::new(512_345.0, 5_012_345.0, 812.0);
    vec![
        apart("utm", "millimetres at 5e6 m: squares of coordinates cancel").placed(1.0, utm),
        crossing("utm-crossing", "as utm, in collision").placed(1.0, utm),
        apart("micro", "the scene at 1e-6: absolute tolerances swallow it")
            .placed(1e-6, Vector3::zeros()),
        apart("mega", "the scene at 1e6: absolute tolerances never hold")
            .placed(1e6, Vector3::zeros()),
        crossing("micro-crossing", "as micro, in collision").placed(1e-6, Vector3::zeros()),
        crossing("mega-crossing", "as mega, in collision").placed(1e6, Vector3::zeros()),
    ]
}

pub(super) fn covariances() -> Vec<HardCase> {
    let flat = Matrix3::from_diagonal(&Vector3::new(4e-6, 4e-6, 0.0));
    let needle = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-16, 1e-16));
    let mut crooked = isotropic(0.002);
    crooked[(0, 2)] = 1e-6;
    let indefinite = Matrix3::from_diagonal(&Vector3::new(4e-6, -4e-6, 4e-6));
    let mut mixed = apart("exact-and-noisy", "exact points among points with 6 cm of noise");
    mixed.covariance_a.iter_mut().step_by(2).for_each(|c| *c = Matrix3::zeros());
    mixed.covariance_b.iter_mut().step_by(2).for_each(|c| *c = isotropic(0.06));
    let mut one_unknown = apart("one-unknown-point", "one point with 100 m of noise among 2 mm");
    one_unknown.covariance_a[7] = isotropic(100.0);
    let mut ladder = apart("noise-ladder", "from a nanometre to a decimetre in one cloud");
    for covariance in [&mut ladder.covariance_a, &mut ladder.covariance_b] {
        for (i, c) in covariance.iter_mut().enumerate() {
            *c = isotropic(10_f64.powi(-9 + (i % 9) as i32));
        }
    }
    vec![
        apart("zero-covariance", "nothing to divide by").with_covariance(Matrix3::zeros()),
        crossing("zero-covariance-crossing", "as zero-covariance, in collision")
            .with_covariance(Matrix3::zeros()),
        apart("singular-covariance", "no inverse: flat ellipsoids").with_covariance(flat),
        apart("needle-covariance", "condition 1e12").with_covariance(needle),
        // The paper's mode reads free, as printed: precisions are added (below eq. 8), and next to
        // 10 m of noise only the spread of neighbouring samples is left, some millimetres.
        HardCase {
            collides: None,
            ..apart("huge-covariance", "noise of 10 m on a scene of 0.2 m: nothing is known")
        }
        .with_covariance(isotropic(10.0))
        .invalid(),
        HardCase { collides: None, ..mixed },
        HardCase { collides: None, ..one_unknown },
        HardCase { collides: None, ..ladder },
        apart("tiny-covariance", "variances of 1e-300: their squares are zero")
            .with_covariance(isotropic(1e-150)),
        apart("unsymmetric-covariance", "not a covariance: mirrored entries differ")
            .with_covariance(crooked)
            .invalid(),
        apart("negative-covariance", "not a covariance: a negative variance")
            .with_covariance(indefinite)
            .invalid(),
        apart(
            "nan-covariance",
            "not a covariance: NaN ends as probability 0 when compared carelessly",
        )
        .with_covariance(Matrix3::repeat(f64::NAN))
        .invalid(),
        apart("infinite-covariance", "not a covariance: infinity times zero is NaN")
            .with_covariance(Matrix3::from_diagonal_element(f64::INFINITY))
            .invalid(),
    ]
}

pub(super) fn not_finite() -> Vec<HardCase> {
    let spoiled = |name, reason, value: f64| {
        let mut case = crossing(name, reason).invalid();
        case.cloud_a[17].y = value;
        case.cloud_b[5] = Point3::from(Vector3::repeat(value));
        case
    };
    vec![
        spoiled(
            "nan-points",
            "comparisons with NaN are false: sorting and minima go wrong",
            f64::NAN,
        ),
        spoiled("infinite-points", "boxes become infinite, differences NaN", f64::INFINITY),
        HardCase::new(
            "all-nan",
            "nothing is left after filtering: must not read as free",
            vec![Point3::from(Vector3::repeat(f64::NAN)); 20],
            patch(0.0, 100, 1),
        )
        .invalid(),
    ]
}
