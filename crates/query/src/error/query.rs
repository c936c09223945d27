//! Why a query cannot be asked, or has no answer.

use cloudtouch_bvh::TreeError;
use cloudtouch_geom::message::number;

/// A mesh takes more parts than allowed to be sampled as densely as asked.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "samples of the mesh at a spacing of {} m take more than {max_parts} triangles: sample \
     it less densely, or raise the limit on parts",
    number(*spacing)
)]
pub struct SubdivisionError {
    /// Longest edge wanted, m.
    pub spacing: f64,
    /// Triangles allowed, before and after splitting.
    pub max_parts: usize,
}

/// A query setting that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// Two numbers that are no interval of probabilities.
    #[error(
        "{name} = [{}, {}]: need 0 <= lowest <= highest <= 1",
        number(*lowest), number(*highest)
    )]
    NotAnInterval {
        /// Which setting.
        name: &'static str,
        /// Its lower end.
        lowest: f64,
        /// Its upper end.
        highest: f64,
    },
    /// A judge goes against its evidence.
    #[error("judge: more evidence ({name}) would make a collision less probable at some knot")]
    Slope {
        /// Of which evidence.
        name: &'static str,
    },
    /// A judge lets the extent or the classifier change odds that are beyond doubt.
    #[error(
        "judge: the row of revisions at log odds of {} must repeat that number, or probabilities jump",
        number(*at)
    )]
    Revision {
        /// The outermost knot concerned.
        at: f64,
    },
    /// A number that has to be finite.
    #[error("{name} = {}: must be finite", number(*value))]
    NotFinite {
        /// Which setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The thresholds are not 0 ≤ reject ≤ ½ ≤ accept ≤ 1.
    #[error(
        "thresholds accept = {}, reject = {}: need 0 <= reject <= 0.5 <= accept <= 1",
        number(*accept), number(*reject)
    )]
    Thresholds {
        /// Probability above which a pair is in collision.
        accept: f64,
        /// Probability below which a pair is free.
        reject: f64,
    },
    /// A setting is not a positive finite number.
    #[error("{name} is {}: give a positive finite number", number(*value))]
    NotPositive {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A share of something is not one.
    #[error("{name} is {}: give a number from 0 to 1", number(*value))]
    NotAShare {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A setting is negative or not finite.
    #[error("{name} is {}: give a finite number that is not negative", number(*value))]
    Negative {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The probability mass of the ellipsoids is out of the range of its rule.
    #[error("kappa is {}: the rule needs a number {range}", number(*kappa))]
    Kappa {
        /// What was given.
        kappa: f64,
        /// The range it must be in.
        range: &'static str,
    },
    /// A probability or tolerance is not strictly between 0 and 1.
    #[error("{name} is {}: give a number between 0 and 1, ends excluded", number(*value))]
    NotAFraction {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
}

/// Why a query has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// The pose has an entry that is NaN, infinite, or a translation beyond 1e10 m.
    #[error("the pose contains {}: every entry must be finite, and at most 1e10 m", number(*value))]
    Pose {
        /// What was found.
        value: f64,
    },
    /// A margin that no two bodies can keep.
    #[error("the margin is {}: give a length in metres, finite and not negative", number(*value))]
    Margin {
        /// What was given.
        value: f64,
    },
    /// A covariance that no pose can have.
    #[error(
        "the covariance of the pose has {}: it must be finite, at most 1e18, symmetric and without negative \
         eigenvalue (m², m rad, rad²)",
        number(*value)
    )]
    PoseCovariance {
        /// What was found: an entry, a difference across the diagonal, or an eigenvalue.
        value: f64,
    },
    /// An interval that holds nothing, or everything.
    #[error("the share of an interval is {}: give a number between 0 and 1, ends excluded", number(*value))]
    Share {
        /// What was given.
        value: f64,
    },
    /// A probability to stay below that everything or nothing is below.
    #[error("the probability to stay below is {}: give a number between 0 and 1, ends excluded", number(*value))]
    Probability {
        /// What was given.
        value: f64,
    },
    /// A path has too few poses to move along.
    #[error("a path through {} give at least two, where it begins and where it ends", poses(*count))]
    TooFewPoses {
        /// How many there are.
        count: usize,
    },
    /// A pose of a path has an entry as in [`Self::Pose`].
    #[error(
        "pose {} of the path contains {}: every entry must be finite, and at most 1e10 m",
        index + 1, number(*value)
    )]
    PathPose {
        /// Which, from 0; the message counts from 1.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// All poses of a path are the same.
    #[error(
        "all {count} poses of the path are the same: ask for that one pose, or give another end"
    )]
    NoMotion {
        /// How many there are.
        count: usize,
    },
    /// The tolerance of a sweep is no share of the path, or too fine a one.
    #[error(
        "the tolerance is {}: give a share of the path from 1e-5 to 1, such as 0.001",
        number(*value)
    )]
    Tolerance {
        /// What was given.
        value: f64,
    },
    /// A mesh cannot be sampled as densely as the cloud that it faces.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The trees could not be traversed.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The two shapes cannot be tested against each other exactly.
    #[error("the two meshes cannot be tested against each other: is one of them degenerate?")]
    Unsupported,
}

fn poses(count: usize) -> String {
    match count {
        0 => "no pose:".to_owned(),
        1 => "one pose:".to_owned(),
        more => format!("{more} poses:"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_spelled_in_few_digits_and_ordinary_ones_plainly() {
        for (value, spelled) in [(-0.5, "is -0.5:"), (1e300, "is 1e300:"), (f64::NAN, "is NaN:")] {
            let message = SettingsError::NotPositive { name: "gamma", value }.to_string();
            assert!(message.contains(spelled), "{message}");
        }
        let spacing = SubdivisionError { spacing: 1e-300, max_parts: 20_000 }.to_string();
        assert!(
            spacing.contains("spacing of 1e-300 m take more than 20000 triangles"),
            "{spacing}"
        );
        let thresholds = SettingsError::Thresholds { accept: 0.25, reject: 0.75 }.to_string();
        assert!(
            thresholds.starts_with("thresholds accept = 0.25, reject = 0.75: "),
            "{thresholds}"
        );
    }
}
