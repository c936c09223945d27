//! How far the classifier is believed: where the noise is small beside the spacing.
//!
//! ΣP (eq. 16) grows with the noise whether surfaces meet or not: with much noise it tells free poses from
//! collisions no better than geometry has, and takes both for collisions. What it brings is told in
//! docs/decisions/0023-where-the-classifier-pays.md.

use crate::body::BodyRef;
use crate::judge::Judge;

/// Noise over spacing, of both bodies together, up to which the classifier is believed in full.
const CLEAR: f64 = 0.5;
/// ... and from which on it is not asked.
const BLURRED: f64 = 1.0;

/// The judge for two bodies: it believes the classifier the less, the more noise they have for their spacing.
pub(super) fn judge_of(judge: &Judge, (a, b): (BodyRef<'_>, BodyRef<'_>)) -> Judge {
    judge.trusting(share(blur(a).hypot(blur(b))))
}

/// Standard deviation over spacing, in the median; none of a mesh, and of what has no neighbours.
fn blur(body: BodyRef<'_>) -> f64 {
    match body {
        BodyRef::Mesh(_) => 0.0,
        BodyRef::Cloud(cloud) => {
            let makeup = cloud.prepared().makeup();
            if makeup.spacing > 0.0 { makeup.std / makeup.spacing } else { 0.0 }
        }
    }
}

fn share(blur: f64) -> f64 {
    ((BLURRED - blur) / (BLURRED - CLEAR)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trust_ends_gradually_where_noise_is_as_large_as_the_spacing() {
        assert_eq!([0.0, 0.5, 0.75, 1.0, f64::INFINITY].map(share), [1.0, 1.0, 0.5, 0.0, 0.0]);
    }

    #[test]
    fn full_trust_changes_no_bit_and_none_asks_nobody() {
        let judge = Judge::default();
        assert_eq!(judge.trusting(1.0), judge);
        assert_eq!(judge.trusting(0.0), judge.without_classifier());
        let [full, half] = [1.0, 0.5].map(|share| judge.trusting(share).revise(0.3, 0.1) - 0.3);
        assert!((half - 0.5 * full).abs() < 1e-12 && full < -0.1, "{full} {half}");
        assert_eq!(judge.trusting(0.5).validate(), Ok(()));
    }
}
