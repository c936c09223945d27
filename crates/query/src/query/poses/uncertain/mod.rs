//! A collision where the pose itself is known only so well.

mod distribution;
mod mean;
mod spread;

use cloudtouch_geom::Pose;
use nalgebra::Vector6;

pub use self::distribution::PoseDistribution;
pub use self::mean::UnderPoses;
use self::mean::{Said, TAIL, said};
use self::spread::{Spread, moved};
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
/// Farther out than this a collision is taken for sure.
const SURE: f64 = 0.98;
/// Where even what is twice as far out as the outermost of them is not within reach with this
/// probability, none is looked at.
const OUT_OF_REACH: f64 = 0.005;
/// See [`OUT_OF_REACH`].
const FARTHER: f64 = 2.0;

impl Query {
    /// How likely a collision is where the pose is uncertain: the mean over what it may be, and the
    /// report on the most probable pose.
    ///
    /// The error of the pose moves all of a body together; that is why no noise of single points can
    /// stand for it. Without any uncertainty it is the plain answer, to the bit. Takes two queries where no
    /// pose comes near, seven where all collide alike, and up to twenty-nine elsewhere: poses spread evenly along the
    /// motion that changes the clearance most, and some far out on it. On all threads of the pool.
    ///
    /// # Errors
    /// When the covariance is not finite or beyond 1e18, not symmetric or has a negative eigenvalue, and those
    /// of [`Self::run`].
    pub fn run_uncertain<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &PoseDistribution,
    ) -> Result<(Report, UnderPoses), QueryError> {
        let bodies @ (a, b) = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let mean = &a_from_b.mean;
        let axes = a_from_b.axes()?;
        if axes.is_empty() {
            let report = this.run(a, b, mean)?;
            let plain = UnderPoses::one(&report);
            return Ok((report, plain));
        }
        let (report, along) = this.run_and_nearing(bodies, mean)?;
        let spread = Spread { axes, along };
        let first = spread.pairs(FIRST_PAIRS, 2 * FIRST_PAIRS + 1);
        let more = spread.pairs(MORE_PAIRS, 2 * MORE_PAIRS);
        let all = first.iter().chain(&more);
        if let Some(apart) = this.out_of_reach(bodies, mean, all, &report)? {
            return Ok((report, apart));
        }
        let mut asked = vec![said(&report)];
        asked.extend(this.ask_moved(bodies, mean, &first)?);
        if all_collide_alike(&asked) {
            return Ok((report, UnderPoses::mean(&asked, &[])));
        }
        let even = this.ask_moved(bodies, mean, &more)?;
        let mut tails = Vec::new();
        for (outermost, sign) in even.iter().zip([-1.0, 1.0]) {
            if outermost[0] < SURE {
                let farther = TAIL.map(|(deviations, _)| spread.out(sign * deviations));
                tails.push((*outermost, this.ask_moved(bodies, mean, &farther)?));
            }
        }
        asked.extend(even);
        Ok((report, UnderPoses::mean(&asked, &tails)))
    }

    /// The answer where motions twice as far as any of these bring the bodies no nearer than they may be apart.
    fn out_of_reach<'a>(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        mean: &Pose,
        motions: impl Iterator<Item = &'a Vector6<f64>>,
        report: &Report,
    ) -> Result<Option<UnderPoses>, QueryError> {
        let plain = UnderPoses::one(report);
        if plain.probability >= OUT_OF_REACH {
            return Ok(None);
        }
        let radius = b.shape().corners().map(|p| (p.coords + b.shape().origin()).abs());
        let radius = radius[0].sup(&radius[1]).norm();
        let moves = |motion: &Vector6<f64>| {
            let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
            shift.norm() + turn.norm() * radius
        };
        let farthest = motions.map(moves).fold(0.0, f64::max);
        let near = self.beyond_collision((a, b), mean, FARTHER * farthest, report)?;
        let [low, high] = plain.bounds;
        let bounds = [low, high.max(near.bounds[1])];
        Ok((near.bounds[1] < OUT_OF_REACH).then_some(UnderPoses { bounds, ..plain }))
    }

    /// What is said of the poses after these motions, on all threads.
    fn ask_moved(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        mean: &Pose,
        motions: &[Vector6<f64>],
    ) -> Result<Vec<Said>, QueryError> {
        let poses: Vec<Pose> = motions.iter().map(|motion| moved(mean, motion)).collect();
        let answers = self.with_detail(Detail::Probability).run_batch(a, b, &poses);
        answers.into_iter().map(|answer| answer.map(|report| said(&report))).collect()
    }
}

/// Whether more poses would say the same as these: that they collide.
fn all_collide_alike(asked: &[Said]) -> bool {
    let (least, most) = asked
        .iter()
        .fold((1.0_f64, 0.0_f64), |(least, most), [p, ..]| (least.min(*p), most.max(*p)));
    most - least <= ALIKE && most > 0.5
}
