//! Whether bounds contain what they should.

use super::Sample;

/// Share of poses whose bounds contain the reference probability, ends included; NaN without
/// bounds or reference.
///
/// The truth of a single pose is yes or no, and bounds on a probability contain neither: the
/// reference is another answer to the same pose, such as one without approximations.
pub(super) fn coverage(sample: &Sample, weights: &[f64]) -> f64 {
    let (Some(bounds), Some(reference)) = (&sample.bounds, &sample.reference) else {
        return f64::NAN;
    };
    if reference.len() != bounds.len() {
        return f64::NAN;
    }
    sample.mean(weights, |i| {
        let [low, high] = bounds[i];
        f64::from((low..=high).contains(&reference[i]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::record::{Said, Truth};

    #[test]
    fn ends_are_contained_and_a_missing_reference_is_nothing() {
        let truths = [Truth { collides: true, signed_distance: -1.0 }; 3];
        let said = [[0.1, 0.2], [0.3, 0.5], [0.0, 1.0]].map(|bounds| Said {
            score: 0.0,
            probability: None,
            bounds: Some(bounds),
            evidence: None,
            micros: 1.0,
        });
        let sample = Sample::new(&truths, &said);
        assert!(coverage(&sample, &[1.0; 3]).is_nan());
        let judged = sample.with_reference(&[0.2, 0.6, 0.7]);
        assert_eq!(coverage(&judged, &[1.0; 3]), 2.0 / 3.0);
        assert_eq!(coverage(&judged, &[1.0, 3.0, 0.0]), 0.25);
        assert!(coverage(&judged.with_reference(&[0.5]), &[1.0; 3]).is_nan());
    }
}
