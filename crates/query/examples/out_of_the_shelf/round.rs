//! One round: the evidence taken for straight about the path there is, and the best path by that, not far
//! away.
//!
//! Evidence has steps, where crossings come into reach of a place, at which a line search over it gives up.
//! So none is made over it: poses are asked once a round, and what `argmin` minimises between two rounds is
//! smooth and convex.

use anyhow::{Context, Result};
use argmin::core::{CostFunction, Error, Executor, Gradient, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{PoseGradient, Query};

use crate::scene::Bodies;

/// What the log odds of a collision are to be below: P < .01.
const LOG_ODDS: f64 = -4.6;
/// What the clearance is to be above where it is told, m: enough for what lies between the poses, which are
/// all that is asked. Deep in a collision, where log odds stand still, it says where to.
const CLEARANCE: f64 = 0.02;
/// What counts as much as one in the log odds: of clearance, of the path's bend at a pose, and of moving it in
/// one round, m. The path is so stiff that poses beside one another leave a board on the same side.
const SCALES: [f64; 3] = [0.002, 0.002, 0.006];
const ITERATIONS: u64 = 100;

/// A number of a pose, and what it changes by for a shift of it in the frame of the scene, per m.
struct Slope {
    /// By how much it is worse than it is to be.
    missing: f64,
    by_shift: Vector3,
}

/// The path after shifts of its inner poses, all coordinates in a row, m.
struct Around<'a> {
    places: &'a [Vector3],
    /// Of each inner pose.
    slopes: Vec<Vec<Slope>>,
}

/// Moves the inner poses of a path to where a collision is less likely.
pub(crate) fn round(query: &Query, bodies: &Bodies, path: &mut [Pose]) -> Result<()> {
    let places: Vec<Vector3> = path.iter().map(Pose::translation).collect();
    let inner = 1..path.len() - 1;
    let slopes = path[inner.clone()].iter().map(|pose| slopes(query, bodies, pose));
    let around = Around { places: &places, slopes: slopes.collect::<Result<_>>()? };
    let solver = LBFGS::new(MoreThuenteLineSearch::new(), 8).with_tolerance_cost(1e-9)?;
    let still = vec![0.0; 3 * inner.len()];
    let solved = Executor::new(around, solver)
        .configure(|state| state.param(still).max_iters(ITERATIONS))
        .run()?;
    let best = solved.state.get_best_param().context("no step was taken")?;
    for (pose, shift) in path[inner].iter_mut().zip(shifts(best)) {
        *pose = Pose::from_translation(shift).after(pose);
    }
    Ok(())
}

fn slopes(query: &Query, bodies: &Bodies, pose: &Pose) -> Result<Vec<Slope>> {
    let (report, gradient) = query.gradient(&bodies.scan, &bodies.hand, pose)?;
    let PoseGradient { log_odds, clearance, .. } = gradient;
    // Of the six only the first three: along the object's own axes.
    let by_shift = |[x, y, z, ..]: [f64; 6]| pose.transform_vector(&Vector3::new(x, y, z));
    let likely = report.log_likelihood_ratio.context("a cloud has evidence")?;
    let of_odds = Slope { missing: likely - LOG_ODDS, by_shift: by_shift(log_odds) };
    let of_clearance = report.clearance_m.zip(clearance).map(|(gap, clearance)| Slope {
        missing: (CLEARANCE - gap.mean) / SCALES[0],
        by_shift: -by_shift(clearance) / SCALES[0],
    });
    Ok([of_odds].into_iter().chain(of_clearance).collect())
}

fn shifts(of: &[f64]) -> impl Iterator<Item = Vector3> {
    of.chunks_exact(3).map(Vector3::from_column_slice)
}

impl Around<'_> {
    /// The sum of squares of all that is missing, all bends and all shifts, and its gradient.
    fn value(&self, of: &[f64]) -> (f64, Vec<f64>) {
        let mut places = self.places.to_vec();
        let mut by_place = vec![Vector3::zeros(); places.len()];
        let mut sum = 0.0;
        for (k, (shift, slopes)) in shifts(of).zip(&self.slopes).enumerate() {
            places[k + 1] += shift;
            sum += (shift / SCALES[2]).norm_squared();
            by_place[k + 1] += 2.0 * shift / SCALES[2].powi(2);
            for slope in slopes {
                let missing = (slope.missing + slope.by_shift.dot(&shift)).max(0.0);
                sum += missing.powi(2);
                by_place[k + 1] += 2.0 * missing * slope.by_shift;
            }
        }
        for k in 1..places.len() - 1 {
            let bend = (places[k - 1] - 2.0 * places[k] + places[k + 1]) / SCALES[1];
            sum += bend.norm_squared();
            for (k, share) in [(k - 1, 2.0), (k, -4.0), (k + 1, 2.0)] {
                by_place[k] += share * bend / SCALES[1];
            }
        }
        let inner = &by_place[1..places.len() - 1];
        (sum, inner.iter().flat_map(|of| [of.x, of.y, of.z]).collect())
    }
}

impl CostFunction for Around<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, of: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.value(of).0)
    }
}

impl Gradient for Around<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, of: &Vec<f64>) -> Result<Vec<f64>, Error> {
        Ok(self.value(of).1)
    }
}
