//! A kernel classifier without robust terms: trained on the measured points as if they were exact,
//! with the sensor's noise only in the probabilities read off it.

use std::num::NonZeroUsize;
use std::time::Instant;

use cloudtouch_geom::{Covariance, Point3, UncertainPoint};
use cloudtouch_svm::{
    Class, Classifier, Kernel, Problem, Sample, Settings, UnitBox, balanced_penalties,
};

use super::index::Index;
use super::observed::spread;
use super::{Answer, Observed, RivalError, micros_since};

/// The classifier at the place where the clouds come closest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlainSvm {
    /// Points on either side: those nearest to the middle of the closest pair.
    pub points_per_side: NonZeroUsize,
    /// γ of the Gaussian kernel, per squared side of the unit box.
    pub gamma: f64,
    /// Mean penalty C of a point; the two sides weigh the same.
    pub penalty: f64,
}

/// The gap between primal and dual that a solve is driven to.
const RELATIVE_GAP: f64 = 1e-4;
/// What is said when nothing separates the points, as between a cloud and itself: f = 0 everywhere.
const UNDETERMINED: f64 = 0.5;

impl Default for PlainSvm {
    /// 60 points a side, γ = 10, C = 100: as the robust classifier has them by default.
    fn default() -> Self {
        let points_per_side = NonZeroUsize::MIN.saturating_add(59);
        Self { points_per_side, gamma: 10.0, penalty: 100.0 }
    }
}

impl PlainSvm {
    /// The largest probability of a point of the patch to be on the wrong side (eq. 16), which is
    /// score and probability.
    ///
    /// Without noise it is 1 when a point is on the wrong side, else 0.
    ///
    /// # Errors
    /// When a setting is out of its range.
    pub(crate) fn answer(&self, observed: &Observed<'_>) -> Result<Answer, RivalError> {
        let start = Instant::now();
        let index_a = Index::try_new(observed.a())?;
        let index_b = Index::try_new(observed.b())?;
        let prepare_micros = micros_since(start);

        let start = Instant::now();
        let (a, b) = self.patch(observed, &index_a, &index_b);
        let probability = self.largest(&a, &b)?;
        let micros = micros_since(start);
        Ok(Answer { score: probability, probability: Some(probability), micros, prepare_micros })
    }

    /// The points of both clouds nearest to the middle of the closest pair, in the frame of A.
    fn patch(
        &self,
        observed: &Observed<'_>,
        index_a: &Index,
        index_b: &Index,
    ) -> (Vec<UncertainPoint>, Vec<UncertainPoint>) {
        let (a, b) = (observed.a(), observed.b_in_a());
        let mut least = f64::INFINITY;
        let mut middle = a[0];
        for i in spread(b.len()) {
            if let Some(nearest) = index_a.nearest_within(&b[i], least)
                && nearest.distance < least
            {
                least = nearest.distance;
                middle = nalgebra::center(&a[nearest.index], &b[i]);
            }
        }
        let covariance = Covariance::isotropic(observed.std().powi(2));
        let uncertain = |mean: Point3| UncertainPoint { mean, covariance };
        let near_a = index_a.nearest(&middle, self.points_per_side);
        let in_b = observed.a_from_b().inverse().transform_point(&middle);
        let near_b = index_b.nearest(&in_b, self.points_per_side);
        (
            near_a.iter().map(|found| uncertain(a[found.index])).collect(),
            near_b.iter().map(|found| uncertain(b[found.index])).collect(),
        )
    }

    fn largest(&self, a: &[UncertainPoint], b: &[UncertainPoint]) -> Result<f64, RivalError> {
        let all = || a.iter().chain(b);
        let Some(unit_box) = UnitBox::around(all()) else { return Ok(UNDETERMINED) };
        let (penalty_a, penalty_b) = balanced_penalties(self.penalty, a.len(), b.len());
        let sample = |point: &UncertainPoint, class, penalty| {
            unit_box.sample_inside(&Sample { point: *point, class, radius: 0.0, penalty })
        };
        let samples: Vec<Sample> = a
            .iter()
            .map(|point| sample(point, Class::A, penalty_a))
            .chain(b.iter().map(|point| sample(point, Class::B, penalty_b)))
            .collect();
        let problem = Problem::try_new(&samples, Kernel::Gaussian { gamma: self.gamma })?;
        let solution =
            problem.solve(&Settings { relative_gap: RELATIVE_GAP, ..Settings::default() })?;
        let Ok(classifier) = Classifier::try_new(&problem, &solution) else {
            return Ok(UNDETERMINED);
        };
        let classifier = classifier.outside(unit_box);
        let of = |points: &[UncertainPoint], class| {
            points
                .iter()
                .map(|point| classifier.probability(point, class).unwrap_or(UNDETERMINED))
                .fold(0.0, f64::max)
        };
        Ok(f64::max(of(a, Class::A), of(b, Class::B)))
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Pose, Vector3};
    use cloudtouch_testkit::{
        noise::{NoiseKind, add_noise},
        scene::sphere,
        surface::{positions, sample_surface},
    };

    use super::*;

    fn ball(seed: u64, std: f64) -> Vec<Point3> {
        let points = positions(&sample_surface(&sphere(0.2, 3), 800, seed));
        add_noise(&points, NoiseKind::Gaussian, std, seed)
    }

    fn probability(a: &[Point3], b: &[Point3], pose: &Pose, std: f64) -> f64 {
        let observed = Observed::try_new(a, b, pose, std).unwrap();
        let answer = PlainSvm::default().answer(&observed).unwrap();
        assert_eq!(answer.probability, Some(answer.score));
        answer.score
    }

    #[test]
    fn distant_balls_are_free_and_overlapping_ones_collide() {
        let std = 0.005;
        let (a, b) = (ball(1, std), ball(2, std));
        let at = |gap: f64| {
            let pose = Pose::from_translation(Vector3::new(0.4 + gap, 0.0, 0.0));
            probability(&a, &b, &pose, std)
        };
        let all: Vec<f64> = [0.1, 0.05, 0.02, 0.0, -0.1].map(at).to_vec();
        assert!(all[0] < 1e-6 && all[4] > 0.9, "{all:?}");
        assert!(all[2] < all[3], "{all:?}");
    }

    #[test]
    fn which_cloud_is_first_does_not_matter() {
        let std = 0.01;
        let (a, b) = (ball(3, std), ball(4, std));
        for (gap, turn) in [(0.06, 0.3), (0.02, 1.1), (0.0, 2.0), (-0.05, 0.9)] {
            let pose =
                Pose::from_translation_rpy(Vector3::new(0.4 + gap, 0.0, 0.0), [turn, 0., turn]);
            let there = probability(&a, &b, &pose, std);
            let back = probability(&b, &a, &pose.inverse(), std);
            assert!((there - back).abs() < 0.02, "{gap}: {there} {back}");
            assert_eq!(there, probability(&a, &b, &pose, std));
        }
    }

    #[test]
    fn exact_points_are_on_one_side_or_the_other() {
        let (a, b) = (ball(5, 0.0), ball(6, 0.0));
        let at = |x: f64| Pose::from_translation(Vector3::new(x, 0.0, 0.0));
        assert_eq!(probability(&a, &b, &at(0.5), 0.0), 0.0);
        assert_eq!(probability(&a, &b, &at(0.2), 0.0), 1.0);
    }

    #[test]
    fn a_cloud_and_itself_are_told_apart_by_nothing() {
        let here = Pose::identity();
        let a = ball(7, 0.0);
        assert!(probability(&a, &a, &here, 0.01) >= 0.5);
        let one = [Point3::new(0.1, 0.2, 0.3); 3];
        assert!(probability(&one, &one, &here, 0.0) >= 0.5);
        assert!(probability(&one[..1], &[Point3::origin()], &here, 0.01) < 0.01);
        let wrong = PlainSvm { gamma: 0.0, ..PlainSvm::default() };
        let observed = Observed::try_new(&a, &a, &here, 0.0).unwrap();
        assert!(matches!(wrong.answer(&observed), Err(RivalError::Problem(_))));
    }
}
