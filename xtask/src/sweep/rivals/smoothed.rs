//! The distance between two clouds after their noise was smoothed: between the expected surface
//! points of our own noise model, without its covariances.

use std::time::Instant;

use cloudtouch_geom::{Covariance, Point3};
use cloudtouch_noise::{Neighborhoods, NoiseModel, Scratch, SensorNoise, typical_spacing};

use super::index::Index;
use super::observed::spread;
use super::smallest::Smallest;
use super::{Distances, Observed, RivalError, micros_since};

/// The smallest distances from smoothed points of B to the smoothed cloud A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SmoothedDistance {
    rank: usize,
}

/// Smoothed distances, and their natural unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Smoothed {
    /// The distances.
    pub distances: Distances,
    /// √(σ² + c h²), m, for [`Distances::in_units_of`], there or for raw distances.
    ///
    /// c = 2·0.35²: a sample stands for a disc of surface with standard deviation 0.35 h in its
    /// plane, and a difference has two ends. h² is the mean of the squared typical spacings.
    pub scale: f64,
}

/// Standard deviation of the surface that belongs to a sample, in spacings.
const DISC_STD: f64 = 0.35;
/// Points whose spacing is looked at for the typical one.
const SPACING_SAMPLE: usize = 500;
/// Clouds without noise or spacing have this unit, m: any distance of theirs is large in it.
const LEAST_SCALE: f64 = 1e-9;

impl SmoothedDistance {
    /// Distances up to that of `rank`: 1 for the minimum alone.
    pub(crate) fn new(rank: usize) -> Self {
        Self { rank }
    }

    /// The distances of all smoothed points to all smoothed points.
    ///
    /// Smooths only points that can matter: smoothing moves a point by three standard deviations
    /// of the sensor at most, so raw distances bound smoothed ones. That is part of the query.
    ///
    /// # Errors
    /// When the rank is 0, B has fewer different points, or the noise model refuses a cloud.
    pub(crate) fn measure(&self, observed: &Observed<'_>) -> Result<Smoothed, RivalError> {
        let start = Instant::now();
        let mut a = SmoothedCloud::try_new(observed.a(), observed.std())?;
        let mut b = SmoothedCloud::try_new(observed.b(), observed.std())?;
        let index = Index::try_new(observed.a())?;
        let squared =
            |cloud: &SmoothedCloud| typical_spacing(&cloud.neighborhoods, SPACING_SAMPLE).powi(2);
        let scale = observed.std().hypot(DISC_STD * (squared(&a) + squared(&b)).sqrt());
        let prepare_micros = micros_since(start);

        let start = Instant::now();
        let ascending = self.ascending(observed, &mut a, &mut b, &index);
        let micros = micros_since(start);
        let distances = Distances { ascending, micros, prepare_micros }.reaching(self.rank)?;
        Ok(Smoothed { distances, scale: scale.max(LEAST_SCALE) })
    }

    fn ascending(
        &self,
        observed: &Observed<'_>,
        a: &mut SmoothedCloud,
        b: &mut SmoothedCloud,
        index: &Index,
    ) -> Vec<f64> {
        let raw = observed.b_in_a();
        // Both ends of the nearest raw pairs may move apart, and both of others toward each other.
        let both = a.shift + b.shift;
        let mut smallest = Smallest::new(self.rank);
        let mut candidates = Vec::new();
        for i in spread(raw.len()) {
            if let Some(nearest) = index.nearest_within(&raw[i], smallest.bound() + 2.0 * both) {
                smallest.take(nearest.distance, raw[i]);
                candidates.push((nearest.distance, i));
            }
        }
        candidates.sort_unstable_by(|(d, i), (e, j)| d.total_cmp(e).then(i.cmp(j)));

        let mut smallest = Smallest::new(self.rank);
        for (distance, i) in candidates {
            if distance - both > smallest.bound() {
                break;
            }
            let point = observed.a_from_b().transform_point(&b.point(i));
            // Any point of A will do until there are enough; the nearest raw one is in reach.
            let reach = smallest.bound().min(distance + both) + a.shift;
            let nearest = index
                .within(&point, reach)
                .map(|found| (a.point(found.index) - point).norm())
                .fold(f64::INFINITY, f64::min);
            if nearest.is_finite() {
                smallest.take(nearest, raw[i]);
            }
        }
        smallest.distances()
    }
}

/// A cloud whose points are smoothed when they are first asked for.
struct SmoothedCloud {
    neighborhoods: Neighborhoods,
    sensor: SensorNoise,
    model: NoiseModel,
    scratch: Scratch,
    known: Vec<Option<Point3>>,
    /// Smoothing moves no point farther, m.
    shift: f64,
}

impl SmoothedCloud {
    fn try_new(points: &[Point3], std: f64) -> Result<Self, RivalError> {
        let covariance = Covariance::isotropic(std * std);
        let model = NoiseModel::default();
        Ok(Self {
            neighborhoods: Neighborhoods::try_new(points.to_vec())?,
            sensor: SensorNoise::uniform(covariance, points.len()),
            model,
            scratch: Scratch::default(),
            known: vec![None; points.len()],
            shift: model.bounds(&covariance, f64::INFINITY).shift,
        })
    }

    /// The expected surface point behind a measured one, in the cloud's frame.
    fn point(&mut self, index: usize) -> Point3 {
        *self.known[index].get_or_insert_with(|| {
            let Self { neighborhoods, sensor, model, scratch, .. } = self;
            model.refine(index, neighborhoods, sensor, f64::INFINITY, scratch).point.mean
        })
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;
    use cloudtouch_testkit::{
        brute,
        noise::{NoiseKind, add_noise},
        scene::sphere,
        surface::{positions, sample_surface},
    };
    use proptest::prelude::*;

    use super::*;
    use crate::sweep::rivals::test_clouds::{cloud, pose};

    fn all_smoothed(points: &[Point3], std: f64) -> Vec<Point3> {
        let mut cloud = SmoothedCloud::try_new(points, std).unwrap();
        (0..points.len()).map(|i| cloud.point(i)).collect()
    }

    fn agrees_with_every_pair(a: &[Point3], b: &[Point3], pose: &Pose, std: f64) {
        let (smooth_a, smooth_b) = (all_smoothed(a, std), all_smoothed(b, std));
        let mut all: Vec<f64> = smooth_b
            .iter()
            .map(|q| brute::minimum_distance(&smooth_a, &[pose.transform_point(q)]))
            .collect();
        all.sort_by(f64::total_cmp);
        let observed = Observed::try_new(a, b, pose, std).unwrap();
        let found = SmoothedDistance::new(5).measure(&observed).unwrap().distances.ascending;
        assert_eq!(found.len(), 5);
        for (found, expected) in found.iter().zip(&all) {
            assert!((found - expected).abs() <= 1e-14, "{found} {expected}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..Default::default() })]

        #[test]
        fn points_left_out_do_not_matter(
            a in cloud(1..150), b in cloud(5..150), pose in pose(), std in 0.0..0.05_f64,
        ) {
            agrees_with_every_pair(&a, &b, &pose, std);
        }

        #[test]
        fn minimum_and_scale_are_symmetric(
            a in cloud(1..150), b in cloud(1..150), pose in pose(), std in 0.0..0.05_f64,
        ) {
            let measure = |a: &[Point3], b: &[Point3], pose: &Pose| {
                let observed = Observed::try_new(a, b, pose, std).unwrap();
                SmoothedDistance::new(1).measure(&observed).unwrap()
            };
            let (there, back) = (measure(&a, &b, &pose), measure(&b, &a, &pose.inverse()));
            let [there_least, back_least] = [&there, &back].map(|s| s.distances.ascending[0]);
            prop_assert!((there_least - back_least).abs() <= 1e-14);
            prop_assert!((there.scale - back.scale).abs() <= 1e-14);
        }
    }

    #[test]
    fn surfaces_are_measured_as_if_all_were_smoothed() {
        let ball = |seed| {
            let points = positions(&sample_surface(&sphere(0.2, 3), 600, seed));
            add_noise(&points, NoiseKind::Gaussian, 0.01, seed)
        };
        for gap in [-0.05, 0.0, 0.05] {
            let offset = cloudtouch_geom::Vector3::new(0.4 + gap, 0.0, 0.0);
            agrees_with_every_pair(&ball(1), &ball(2), &Pose::from_translation(offset), 0.01);
        }
    }

    #[test]
    fn the_scale_is_of_the_noise_or_of_the_spacing() {
        let grid: Vec<Point3> = (0..400)
            .map(|i| Point3::new(f64::from(i % 20) * 0.02, f64::from(i / 20) * 0.02, 0.0))
            .collect();
        let here = Pose::identity();
        let scale = |a: &[Point3], b: &[Point3], std| {
            let observed = Observed::try_new(a, b, &here, std).unwrap();
            SmoothedDistance::new(1).measure(&observed).unwrap().scale
        };
        // The sixth neighbour on a grid is a diagonal one: h = 0.02 √2 √(π/6).
        let h = 0.02 * (std::f64::consts::PI / 3.0).sqrt();
        let exact = 0.35 * 2.0_f64.sqrt() * h;
        assert!((scale(&grid, &grid, 0.0) - exact).abs() < 1e-12);
        assert!((scale(&grid, &grid, 0.1) - 0.1_f64.hypot(exact)).abs() < 1e-12);
        let one = [Point3::origin()];
        assert_eq!(scale(&one, &one, 0.0), LEAST_SCALE);
    }
}
