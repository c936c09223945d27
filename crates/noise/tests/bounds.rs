//! What must hold of every refined point, whatever the cloud: bounds, order, purity.

use cloudtouch_geom::{Covariance, Matrix3, Point3, seed};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseModel, NoiseSettings, PosteriorSettings, Representatives,
    Scratch, SensorNoise, spacings_at,
};
use proptest::prelude::*;

use crate::common::{isotropic, model};

const ALL: [Combination; 3] =
    [Combination::Precision, Combination::Convolution, Combination::SurfacePosterior];

/// A covariance of any scale and rank.
fn any_covariance() -> impl Strategy<Value = Covariance> {
    let entry = prop_oneof![1 => Just(0.0), 3 => -1.0..1.0_f64];
    (prop::array::uniform9(entry), -5..2_i32).prop_map(|(entries, exponent)| {
        let root = Matrix3::from_row_slice(&entries) * 10_f64.powi(exponent);
        Covariance::from_symmetric(&(root * root.transpose()))
    })
}

/// Of a rough sheet, a lattice (and so at times one that is there already), or a far outlier.
fn any_point() -> impl Strategy<Value = Point3> + Clone {
    let lattice = prop::array::uniform3((-2..3_i32).prop_map(|v| 0.1 * f64::from(v)));
    let sheet = (-0.5..0.5_f64, -0.5..0.5_f64, -0.02..0.02_f64).prop_map(|(x, y, z)| [x, y, z]);
    let outlier = prop::array::uniform3(-5.0..5.0_f64);
    prop_oneof![6 => sheet, 2 => lattice, 1 => outlier].prop_map(Point3::from)
}

/// Points with their noise.
fn any_cloud() -> impl Strategy<Value = Vec<(Point3, Covariance)>> {
    let rough = prop::collection::vec((any_point(), any_covariance()), 1..120);
    // One noise for all is the common case, and the one in which fits succeed most.
    let even = (prop::collection::vec(any_point(), 1..120), any_covariance())
        .prop_map(|(points, noise)| points.into_iter().map(|p| (p, noise)).collect());
    prop_oneof![rough, even]
}

fn any_cap() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 1e-6..1.0_f64, Just(1e3)]
}

/// Whether `larger` − `smaller` is positive semidefinite up to rounding.
fn in_order(smaller: &Covariance, larger: &Covariance) -> bool {
    let difference = larger.matrix() - smaller.matrix();
    difference.symmetric_eigenvalues().min() >= -1e-9 * larger.matrix().trace()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn refined_points_keep_their_bounds(cloud in any_cloud(), cap in any_cap()) {
        let (points, sensor): (Vec<_>, Vec<_>) = cloud.into_iter().unzip();
        let sensor = SensorNoise::from(sensor);
        let index = Neighborhoods::new(points.clone()).unwrap();
        let mut scratch = Scratch::default();
        for combination in ALL {
            let model = model(combination);
            for i in 0..points.len() {
                let refined = model.refine(i, &index, &sensor, cap, &mut scratch);
                let bounds = model.bounds(sensor[i].max_std(), cap);
                let covariance = refined.point.covariance;
                let shift = (refined.point.mean - points[i]).norm();
                // The rounding of adding a shift to a coordinate of size 5.
                prop_assert!(shift <= bounds.shift + 1e-14, "{combination:?}: {shift} {bounds:?}");
                let std = covariance.max_std();
                prop_assert!(std <= bounds.std, "{combination:?}: {std} {bounds:?}");
                prop_assert!(Covariance::try_from_matrix(&covariance.matrix()).is_ok());
                prop_assert!(refined.spacing >= 0.0 && refined.spacing <= cap);
                if let Some(normal) = refined.normal {
                    prop_assert!((normal.norm() - 1.0).abs() < 1e-12);
                }
                match combination {
                    Combination::Precision => prop_assert!(in_order(&covariance, &sensor[i])),
                    Combination::Convolution => prop_assert!(in_order(&sensor[i], &covariance)),
                    Combination::SurfacePosterior => {}
                }
            }
        }
    }

    /// Points that stand for all where there are more than their noise can tell apart: copies, a lattice and strays too.
    #[test]
    fn points_that_stand_for_others_keep_their_bounds(
        cloud in prop::collection::vec((any_point(), 0.5..2.0_f64), 60..200),
        std in 0.02..0.5_f64,
        cap in any_cap(),
    ) {
        let (points, parts): (Vec<_>, Vec<_>) = cloud.into_iter().unzip();
        let noise: Vec<_> = parts.iter().map(|part| Covariance::isotropic((part * std).powi(2))).collect();
        let sensor = SensorNoise::from(noise);
        let index = Neighborhoods::new(points.clone()).unwrap();
        let all: Vec<usize> = (0..points.len()).collect();
        let spacings = spacings_at(&index, all.iter().copied());
        let chosen = Representatives::choose(&index, &sensor, (&all, &spacings)).unwrap();
        let model = model(Combination::SurfacePosterior);
        let mut scratch = Scratch::default();
        for i in chosen.iter().flat_map(Representatives::indices).map(|&i| i as usize) {
            let kept = chosen.as_ref().expect("of these");
            let refined = model.refine_representative(i, &index, kept, &sensor, cap, &mut scratch);
            let bounds = model.bounds(sensor[i].max_std(), cap);
            let shift = (refined.point.mean - points[i]).norm();
            prop_assert!(shift <= bounds.shift + 1e-14, "{shift} {bounds:?}");
            let largest = refined.point.covariance.max_std();
            prop_assert!(largest <= bounds.std, "{largest} {bounds:?}");
            prop_assert!(Covariance::try_from_matrix(&refined.point.covariance.matrix()).is_ok());
            prop_assert!(refined.spacing >= 0.0 && refined.spacing <= cap);
        }
    }

    #[test]
    fn refinement_depends_on_its_arguments_alone(cloud in any_cloud()) {
        let (points, sensor): (Vec<_>, Vec<_>) = cloud.into_iter().unzip();
        let sensor = SensorNoise::from(sensor);
        let index = Neighborhoods::new(points.clone()).unwrap();
        let mut scratch = Scratch::default();
        for combination in ALL {
            let model = model(combination);
            let mut refine = |i| model.refine(i, &index, &sensor, 1.0, &mut scratch);
            let forward: Vec<_> = (0..points.len()).map(&mut refine).collect();
            let backward: Vec<_> = (0..points.len()).rev().map(&mut refine).collect();
            prop_assert!(forward.iter().eq(backward.iter().rev()));
        }
    }
}

#[test]
fn models_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<NoiseModel>();
}

fn posterior(disc_std: f64, sampling_std: f64) -> NoiseModel {
    let posterior = PosteriorSettings { disc_std, sampling_std, ..PosteriorSettings::default() };
    NoiseModel::new(NoiseSettings { posterior, ..NoiseSettings::default() }).expect("valid")
}

/// Nothing times a spacing without a cap is no number.
#[test]
fn no_part_of_a_spacing_without_a_cap_had_no_bound() {
    for model in [model(Combination::Precision), posterior(0.0, 0.0)] {
        let std = model.bounds(0.002, f64::INFINITY).std;
        assert!((0.002..0.002 * (1.0 + 1e-6)).contains(&std), "{std}");
    }
}

/// What bends between samples counts for the diagonal of a spacing: 0.707 mm were found for a bound of 0.5 mm.
#[test]
fn what_bends_more_than_the_disc_is_wide_exceeded_its_bound() {
    let (model, cap, std) = (posterior(0.1, 0.1), 0.005, 1e-5);
    let draw = |i, k| seed::unit(seed::derive(1, i, k));
    let place = |i: u64| {
        let [x, y] = [i % 20, i / 20].map(|cell| 0.01 * cell as f64);
        Point3::new(x + 1e-4 * draw(i, 0), y + 1e-4 * draw(i, 1), 1e-5 * draw(i, 2))
    };
    let points: Vec<Point3> = (0..400).map(place).collect();
    let noise = isotropic(std, &points);
    let refined = model.refine_all(&Neighborhoods::new(points).unwrap(), &noise, cap);
    let largest = refined.iter().map(|one| one.point.covariance.max_std()).fold(0.0, f64::max);
    let bound = model.bounds(std, cap).std;
    assert!(largest <= bound && largest > 0.9 * bound, "{largest} for {bound}");
}
