//! A collision where the pose itself is known only so well.

use cloudtouch_geom::{Pose, Vector3, normal};
use nalgebra::{DMatrix, DVector, Matrix6, Matrix6xX, SymmetricEigen, UnitQuaternion, Vector6};
use serde::Serialize;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::run::Query;
use crate::query::settings::Detail;
use crate::report::Report;

/// Pairs of opposite poses that stand for all, with the most probable one: at first ...
const FIRST_PAIRS: usize = 3;
/// ... and where these differ by more than ...
const ALIKE: f64 = 0.02;
/// ... or where none collides, so many more, each of which stands for as large a share of all.
const MORE_PAIRS: usize = 8;
/// The outermost of these stand for all that is beyond 1.5 deviations. Where it is not sure that poses
/// farther out collide, some of them stand for themselves: how many deviations out, and the share of all
/// between 1.86, 2.4 and 3 deviations and beyond.
const TAIL: [(f64, f64); 3] = [(2.1, 0.0233), (2.65, 0.00685), (3.3, 0.00135)];
/// Farther out than this a collision is taken for sure.
const SURE: f64 = 0.98;
/// Where even what is twice as far out as the outermost of them is not within reach with this
/// probability, none is looked at.
const OUT_OF_REACH: f64 = 0.005;
/// See [`OUT_OF_REACH`].
const FARTHER: f64 = 2.0;
/// Relative rounding of a covariance.
const ROUNDING: f64 = 1e-9;

/// A pose that is known only so well: `mean` followed by a small motion in the object's own frame, by
/// translation (m) and rotation vector (rad), drawn from a normal distribution about nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseDistribution {
    /// The most probable pose.
    pub mean: Pose,
    /// Covariance of translation x, y, z (m) and rotation x, y, z (rad); may be singular.
    pub covariance: [[f64; 6]; 6],
}

/// How likely a collision is over all the poses that may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct UnderPoses {
    /// Mean collision probability of the poses.
    pub probability: f64,
    /// Means of the lower and the upper bounds; `probability` lies within.
    pub bounds: [f64; 2],
    /// The standard error that as many poses drawn at random would leave, and where none of so many
    /// collides, or all do, that of half a one that does not; what is left is less as a rule, since they
    /// are spread evenly. 0 where poses that come near enough are out of the question.
    pub std_error: f64,
    /// How many poses were asked about.
    pub poses: usize,
}

impl PoseDistribution {
    /// Independent errors with these standard deviations, of translation (m) and rotation (rad).
    pub fn from_std(mean: Pose, stds: [f64; 6]) -> Self {
        let mut covariance = [[0.0; 6]; 6];
        for (k, std) in stds.into_iter().enumerate() {
            covariance[k][k] = std * std;
        }
        Self { mean, covariance }
    }

    /// The axes of the covariance that are not nothing, each as long as its standard deviation.
    fn axes(&self) -> Result<Matrix6xX<f64>, QueryError> {
        let covariance = Matrix6::from_fn(|i, j| self.covariance[i][j]);
        let size = covariance.amax();
        let bad = |value: f64| Err(QueryError::PoseCovariance { value });
        if let Some(&value) = covariance.iter().find(|value| !value.is_finite()) {
            return bad(value);
        }
        let skew = (covariance - covariance.transpose()).amax();
        if skew > ROUNDING * size {
            return bad(skew);
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(covariance);
        if let Some(&value) = eigenvalues.iter().find(|value| **value < -ROUNDING * size) {
            return bad(value);
        }
        let axes: Vec<Vector6<f64>> = (0..6)
            .filter(|&k| eigenvalues[k] > ROUNDING * size)
            .map(|k| eigenvectors.column(k) * eigenvalues[k].sqrt())
            .collect();
        Ok(if axes.is_empty() { Matrix6xX::zeros(0) } else { Matrix6xX::from_columns(&axes) })
    }
}

/// Motions along axes that stand for all, in opposite pairs, out of so many nodes: those that are not in a pair
/// are at rest. They are spread evenly along the motion that matters, `along`, and over the rest by an even
/// sequence (the generalised golden ratio of M. Roberts).
fn motions(
    axes: &Matrix6xX<f64>,
    along: &Vector6<f64>,
    pairs: usize,
    nodes: usize,
) -> Vec<Vector6<f64>> {
    let mut even = spread(axes.ncols(), pairs, nodes);
    let mut across: DVector<f64> = axes.tr_mul(along);
    if across.try_normalize_mut(0.0).is_some() {
        // A reflection takes the first direction, along which they are most even, to that which matters.
        across[0] -= 1.0;
        if let Some(across) = across.try_normalize(f64::EPSILON) {
            even -= &across * (across.transpose() * &even) * 2.0;
        }
    }
    let motions = axes * even;
    motions.column_iter().flat_map(|m| [m.into_owned(), -m.into_owned()]).collect()
}

/// Columns that stand for a standard normal distribution of so many dimensions: with their opposites
/// they have its mean and, where they are enough, its covariance.
fn spread(dimensions: usize, pairs: usize, nodes: usize) -> DMatrix<f64> {
    let ratio = golden_ratio(dimensions.saturating_sub(1).max(1));
    let even = DMatrix::from_fn(dimensions, pairs, |k, number| {
        let share = match k {
            0 => (number as f64 + 0.5) / nodes as f64,
            k => (0.5 + ratio.powi(-(k as i32)) * (number + 1) as f64).fract(),
        };
        normal::quantile(share.clamp(1e-9, 1.0 - 1e-9))
    });
    let covariance = &even * even.transpose() / pairs as f64;
    let Some(factor) = covariance.cholesky() else { return even };
    factor.l().solve_lower_triangular(&even).unwrap_or(even)
}

/// The root above one of x^(d+1) = x + 1.
fn golden_ratio(dimensions: usize) -> f64 {
    let mut ratio = 1.5_f64;
    for _ in 0..60 {
        ratio = (1.0 + ratio).powf(1.0 / (dimensions + 1) as f64);
    }
    ratio
}

impl Query {
    /// How likely a collision is where the pose is uncertain: the mean over what it may be, and the
    /// report on the most probable pose.
    ///
    /// The error of the pose moves all of a body together; that is why no noise of single points can
    /// stand for it. Without any uncertainty it is the plain answer, to the bit. Takes two queries where no
    /// pose comes near, seven where all collide, and up to twenty-nine elsewhere: poses spread evenly along the
    /// motion that changes the clearance most, and some far out on it. On all threads of the pool.
    ///
    /// # Errors
    /// When the covariance is not finite, not symmetric or has a negative eigenvalue, and those of
    /// [`Self::run`].
    pub fn run_uncertain<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &PoseDistribution,
    ) -> Result<(Report, UnderPoses), QueryError> {
        let (a, b) = (a.into(), b.into());
        let this = self.begun_now();
        let mean = &a_from_b.mean;
        let axes = a_from_b.axes()?;
        if axes.is_empty() {
            let report = this.run(a, b, mean)?;
            let plain = UnderPoses::one(&report);
            return Ok((report, plain));
        }
        let (report, nearing) = this.run_and_nearing((a, b), mean)?;
        let plain = UnderPoses::one(&report);
        let first = motions(&axes, &nearing, FIRST_PAIRS, 2 * FIRST_PAIRS + 1);
        let more = motions(&axes, &nearing, MORE_PAIRS, 2 * MORE_PAIRS);
        if plain.probability < OUT_OF_REACH {
            let radius = b.shape().corners().map(|p| (p.coords + b.shape().origin()).abs());
            let radius = radius[0].sup(&radius[1]).norm();
            let moves = |motion: &Vector6<f64>| {
                let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
                shift.norm() + turn.norm() * radius
            };
            let farthest = first.iter().chain(&more).map(moves).fold(0.0, f64::max);
            let near = this.beyond_collision((a, b), mean, FARTHER * farthest, &report)?;
            if near.bounds[1] < OUT_OF_REACH {
                let [low, high] = plain.bounds;
                let bounds = [low, high.max(near.bounds[1])];
                return Ok((report, UnderPoses { bounds, ..plain }));
            }
        }
        let query = this.with_detail(Detail::Probability);
        let ask = |motions: &[Vector6<f64>]| -> Result<Vec<Said>, QueryError> {
            let poses: Vec<Pose> = motions.iter().map(|motion| moved(mean, motion)).collect();
            let answers = query.run_batch(a, b, &poses).into_iter();
            answers.map(|answer| answer.map(|report| said(&report))).collect()
        };
        let mut asked = vec![said(&report)];
        asked.extend(ask(&first)?);
        let (least, most) = asked
            .iter()
            .fold((1.0_f64, 0.0_f64), |(least, most), [p, ..]| (least.min(*p), most.max(*p)));
        if most - least <= ALIKE && most > 0.5 {
            return Ok((report, UnderPoses::mean(&asked, &[])));
        }
        let even = ask(&more)?;
        let mut tails = Vec::new();
        for (outermost, sign) in even.iter().zip([-1.0, 1.0]) {
            if outermost[0] < SURE {
                let said = ask(&farther_out(&axes, &nearing, sign))?;
                tails.push((*outermost, said));
            }
        }
        asked.extend(even);
        Ok((report, UnderPoses::mean(&asked, &tails)))
    }
}

/// Motions of [`TAIL`] along the motion that matters, to one side.
fn farther_out(axes: &Matrix6xX<f64>, along: &Vector6<f64>, sign: f64) -> Vec<Vector6<f64>> {
    let across: DVector<f64> = axes.tr_mul(along);
    // Where none matters, the first of the axes.
    let first = DVector::from_fn(axes.ncols(), |k, _| f64::from(u8::from(k == 0)));
    let unit = across.try_normalize(0.0).unwrap_or(first);
    TAIL.iter().map(|(deviations, _)| axes * &unit * (sign * deviations)).collect()
}

/// A probability and its bounds.
type Said = [f64; 3];

/// What a report says.
fn said(report: &Report) -> Said {
    let [low, high] = report.bounds;
    [report.collision_probability, low, high]
}

impl UnderPoses {
    /// The plain answer.
    fn one(report: &Report) -> Self {
        let Report { collision_probability: probability, bounds, .. } = *report;
        Self { probability, bounds, std_error: 0.0, poses: 1 }
    }

    /// The mean of probabilities with their bounds; in the tails others take the place of the outermost.
    fn mean(asked: &[Said], tails: &[(Said, Vec<Said>)]) -> Self {
        let count = asked.len() as f64;
        let mut means = [0.0; 3];
        for said in asked {
            means.iter_mut().zip(said).for_each(|(mean, value)| *mean += value / count);
        }
        let square: f64 = asked.iter().map(|[p, ..]| p * p / count).sum();
        let mut poses = asked.len();
        for (outermost, said) in tails {
            poses += said.len();
            for (said, (_, share)) in said.iter().zip(TAIL) {
                let change =
                    |((mean, is), was): ((&mut f64, &f64), &f64)| *mean += share * (is - was);
                means.iter_mut().zip(said).zip(outermost).for_each(change);
            }
        }
        let [probability, low, high] = means.map(|mean| mean.clamp(0.0, 1.0));
        // Half a pose more that does otherwise: none of so many does not mean never.
        let half = 0.5 / (count + 1.0);
        let variance = (square - probability * probability).max(half * (1.0 - half));
        Self { probability, bounds: [low, high], std_error: (variance / count).sqrt(), poses }
    }
}

/// A pose followed by a small motion in the object's frame.
fn moved(mean: &Pose, motion: &Vector6<f64>) -> Pose {
    let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
    mean.after(&Pose::from_translation_rotation(Vector3::from(shift), turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_have_the_covariance_they_stand_for() {
        let mut covariance = [[0.0; 6]; 6];
        for (i, row) in covariance.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = if i == j {
                    1e-4
                } else if i / 3 == j / 3 {
                    3e-5
                } else {
                    0.0
                };
            }
        }
        let axes = PoseDistribution { mean: Pose::identity(), covariance }.axes().unwrap();
        let toward = Vector6::new(1.0, 0.2, 0.0, -0.1, 0.3, 0.0);
        let motions = motions(&axes, &toward, MORE_PAIRS, 2 * MORE_PAIRS);
        assert_eq!(motions.len(), 2 * MORE_PAIRS);
        let found: Matrix6<f64> =
            motions.iter().map(|m| m * m.transpose()).sum::<Matrix6<f64>>() / motions.len() as f64;
        let wanted = Matrix6::from_fn(|i, j| covariance[i][j]);
        assert!((found - wanted).amax() < 1e-15, "{found}");
    }

    #[test]
    fn one_direction_that_is_known_badly_takes_all_poses() {
        let of = |stds| {
            let axes = PoseDistribution::from_std(Pose::identity(), stds).axes().unwrap();
            motions(&axes, &Vector6::new(0.0, 0.3, 1.0, 0.0, 0.0, 0.0), MORE_PAIRS, 2 * MORE_PAIRS)
        };
        let known = PoseDistribution::from_std(Pose::identity(), [0.0; 6]);
        assert!(known.axes().unwrap().is_empty());
        let along = of([0.0, 0.0, 0.02, 0.0, 0.0, 0.0]);
        assert!(along.iter().all(|m| m[0] == 0.0 && m[3] == 0.0));
        // One of sixteen is in each of as many equally likely parts.
        let mut along: Vec<f64> = along.iter().map(|m| m[2] / 0.02).collect();
        along.sort_by(f64::total_cmp);
        for (place, z) in along.iter().enumerate() {
            let share = normal::cdf(*z) * along.len() as f64;
            assert!((share - place as f64 - 0.5).abs() < 0.5, "{place}: {share}");
        }
    }
}
