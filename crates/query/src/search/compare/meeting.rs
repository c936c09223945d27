//! Two pieces of surface: how many standard deviations are between them, and where they would meet.

use cloudtouch_geom::{Matrix3, Point3, UncertainPoint, Vector3, normal};

use crate::cloud::Surfel;

use crate::search::wrench::{Wrench, force_at};

/// No coordinate is known better than this, m: what keeps exact pieces at one place from dividing
/// nothing by nothing.
pub(in crate::search) const LEAST_STD: f64 = 1e-12;

/// A height of more deviations than wanted is told from its square by so much, relative, that rounding cannot
/// have made it so.
const CLEARLY_MORE: f64 = 1.0 + 1e-6;

/// Where two pieces of surface would meet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meeting {
    /// z: the Mahalanobis distance of the two pieces.
    pub deviations: f64,
    /// The place both are most likely to have in common.
    pub place: Point3,
    /// Unit normal of the plane that separates them best, from A to B; `None` where both are at one
    /// place.
    pub normal: Option<Vector3>,
}

/// The probability of pieces so many deviations apart, by the plane halfway between two that are
/// equally well known: it is z/√2 deviations from either.
///
/// A pair of boxes between whose points there are at least so many deviations has no point more
/// probable than this: with a gap g and standard deviations up to σ, z ≥ g/(√2σ) and P ≤ Φ(−g/(2σ)).
pub(crate) fn probability_at(deviations: f64) -> f64 {
    normal::upper_tail(deviations / std::f64::consts::SQRT_2)
}

/// Whether pieces have more squared deviations between them than some, by their height over one another along a
/// unit vector and its variance: along no direction are there more than in all.
pub(super) fn are_beyond(height: f64, variance: f64, squared: f64) -> bool {
    height * height > squared * (variance + LEAST_STD.powi(2)) * CLEARLY_MORE
}

/// Squared Mahalanobis distance δᵀ(Σa+Σb)⁻¹δ of two pieces; `None` where it is not below `limit`.
/// Exact pieces are at one place or as good as infinitely far from each other.
pub(in crate::search) fn squared_deviations(a: &Surfel, b: &Surfel, limit: f64) -> Option<f64> {
    let offset = b.point.mean - a.point.mean;
    // No direction has more variance than this: most pairs end here.
    if offset.norm_squared() > limit * (a.most_variance + b.most_variance) {
        return None;
    }
    // PERF: of the others most are told to be apart across the one of them.
    if let Some(normal) = &a.normal {
        let variance_of = |s: &Surfel| s.point.covariance.variance_along(normal);
        if are_beyond(offset.dot(normal), variance_of(a) + variance_of(b), limit) {
            return None;
        }
    }
    let joint = a.point.covariance.sum(&b.point.covariance);
    let squared = offset.dot(&solve(&joint.matrix(), &offset)?);
    (squared < limit).then_some(squared.max(0.0))
}

/// Whether two pieces, wherever they end, may be fewer deviations than some from being within a margin (m).
pub(in crate::search) fn may_be_beyond(a: &Surfel, b: &Surfel, margin: f64, limit: f64) -> bool {
    let joint = a.point.covariance.sum(&b.point.covariance).matrix();
    may_have_fewer(&joint, &(b.point.mean - a.point.mean), margin, limit)
}

/// The same of what is this way (m) off, given the covariance as it was fitted: where pieces end, there are no fewer
/// along the way.
pub(in crate::search) fn may_have_fewer(
    covariance: &Matrix3,
    way: &Vector3,
    margin: f64,
    limit: f64,
) -> bool {
    beyond_along((covariance, way), way, margin) <= limit.max(0.0) * CLEARLY_MORE
}

/// How many deviations two pieces are from being within a margin (m): the largest of
/// (n·δ − m)/√(nᵀΣn) over a few directions n, which none can exceed; negative where they are within
/// it. `None` where that is not below `limit`. Without a margin it is the Mahalanobis distance.
pub(in crate::search) fn deviations_beyond(
    a: &Surfel,
    b: &Surfel,
    margin: f64,
    limit: f64,
) -> Option<f64> {
    let offset = b.point.mean - a.point.mean;
    let reach = margin + limit.max(0.0) * (a.most_variance + b.most_variance).sqrt();
    if offset.norm_squared() > reach * reach {
        return None;
    }
    let joint = a.point.covariance.sum(&b.point.covariance).matrix();
    let beyond = beyond((&joint, &offset), &solve(&joint, &offset)?, margin);
    (beyond < limit).then_some(beyond)
}

/// (n·δ − m)/√(nᵀΣn), the larger of two: across what separates the pieces best, Σ⁻¹δ, and along the way
/// between them.
fn beyond((joint, offset): (&Matrix3, &Vector3), weighted: &Vector3, margin: f64) -> f64 {
    let of = |direction: &Vector3| beyond_along((joint, offset), direction, margin);
    of(weighted).max(of(offset))
}

/// (n·δ − m)/√(nᵀΣn) in one direction, n that of unit length. Pieces at one place have none: all that can be said is
/// that they are within the margin.
pub(super) fn beyond_along(
    (joint, offset): (&Matrix3, &Vector3),
    direction: &Vector3,
    margin: f64,
) -> f64 {
    let Some(n) = direction.try_normalize(0.0) else { return f64::NEG_INFINITY };
    let variance = n.dot(&(joint * n)) + LEAST_STD.powi(2);
    (offset.dot(&n) - margin) / variance.sqrt()
}

impl Meeting {
    /// The meeting of two pieces; `None` where numbers end.
    pub(in crate::search) fn of(a: &UncertainPoint, b: &UncertainPoint) -> Option<Self> {
        let offset = b.mean - a.mean;
        let joint = a.covariance.sum(&b.covariance);
        let weighted = solve(&joint.matrix(), &offset)?;
        let deviations = offset.dot(&weighted).max(0.0).sqrt();
        let place = a.mean + a.covariance.matrix() * weighted;
        let normal = weighted.try_normalize(0.0);
        Some(Self { deviations, place, normal })
    }
}

/// What the deviations z = √(δᵀ(Σa+Σb)⁻¹δ) of two pieces change by as B moves: Σ⁻¹δ/z per metre at the
/// place where they would meet, for Σb turns with B. Of a triangle the nearest place keeps to first
/// order. `None` where they are at one place.
pub(in crate::search) fn deviations_by_pose(
    a: &UncertainPoint,
    b: &UncertainPoint,
) -> Option<Wrench> {
    let offset = b.mean - a.mean;
    let joint = a.covariance.sum(&b.covariance);
    let weighted = solve(&joint.matrix(), &offset)?;
    let deviations = offset.dot(&weighted).sqrt();
    let place = a.mean + a.covariance.matrix() * weighted;
    (deviations > 0.0).then(|| force_at(&place, &(weighted / deviations)))
}

/// Σ⁻¹v by cofactors, which round evenly for discs of any size; `None` where numbers end. What is
/// exact counts as known to [`LEAST_STD`].
pub(in crate::search) fn solve(sigma: &Matrix3, v: &Vector3) -> Option<Vector3> {
    let sigma = sigma + Matrix3::identity() * LEAST_STD.powi(2);
    let [x, y, z] = [0, 1, 2].map(|k| sigma.column(k).into_owned());
    let (yz, zx, xy) = (y.cross(&z), z.cross(&x), x.cross(&y));
    let determinant = x.dot(&yz);
    let solved = Vector3::new(yz.dot(v), zx.dot(v), xy.dot(v)) / determinant;
    solved.iter().all(|c| c.is_finite()).then_some(solved)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint, unit};
    use cloudtouch_noise::Refined;
    use proptest::prelude::*;

    use super::*;

    fn disc(mean: Point3, normal: Vector3, across: f64, along: f64) -> Surfel {
        let axis = unit(&normal).unwrap();
        let covariance = Covariance::from_axis(&axis, across, along);
        let point = UncertainPoint { mean, covariance };
        Surfel::new(0, &Refined { point, spacing: 1.0, normal: Some(axis), shared: 0.0 })
    }

    #[test]
    fn discs_facing_each_other_are_their_gap_over_their_noise_apart() {
        let a = disc(Point3::origin(), Vector3::z(), 0.03, 0.35);
        let b = disc(Point3::new(0.0, 0.0, 0.1), Vector3::z(), 0.04, 0.35);
        let meeting = Meeting::of(&a.point, &b.point).unwrap();
        assert!((meeting.deviations - 0.1 / 0.05).abs() < 1e-12);
        assert_eq!(meeting.normal, Some(Vector3::z()));
        // The better known one moves less.
        assert!((meeting.place.z - 0.1 * 0.0009 / 0.0025).abs() < 1e-12);
        let squared = squared_deviations(&a, &b, 100.0).unwrap();
        assert!((squared - 4.0).abs() < 1e-12);
        assert_eq!(squared_deviations(&a, &b, 3.9), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// By the solution alone.
        #[test]
        fn a_piece_is_left_out_by_its_height_only_where_it_has_more_deviations(
            mean in prop::array::uniform3(-0.3..0.3_f64),
            axes in prop::array::uniform2(prop::array::uniform3(-1.0..1.0_f64)),
            stds in prop::array::uniform4(1e-4..0.1_f64),
            limit in 0.0..40.0_f64,
        ) {
            let [p, q] = axes.map(Vector3::from);
            prop_assume!(p.norm() > 0.1 && q.norm() > 0.1);
            let a = disc(Point3::origin(), p.normalize(), stds[0], stds[1]);
            let b = disc(Point3::from(mean), q.normalize(), stds[2], stds[3]);
            let offset = b.point.mean - a.point.mean;
            let joint = a.point.covariance.sum(&b.point.covariance).matrix();
            let squared = offset.dot(&solve(&joint, &offset).unwrap());
            let expected = (squared < limit).then_some(squared.max(0.0));
            prop_assert_eq!(squared_deviations(&a, &b, limit), expected);
        }
    }

    #[test]
    fn a_margin_takes_what_it_is_off_the_gap_and_none_takes_nothing() {
        let a = disc(Point3::origin(), Vector3::z(), 0.03, 0.35);
        let b = disc(Point3::new(0.01, 0.0, 0.1), Vector3::z(), 0.04, 0.35);
        let of = |margin| deviations_beyond(&a, &b, margin, 100.0).unwrap();
        let plain = squared_deviations(&a, &b, 100.0).unwrap().sqrt();
        assert!((of(0.0) - plain).abs() < 1e-9);
        assert!((of(0.05) - 1.0).abs() < 0.02, "{}", of(0.05));
        // Along the way between them, a little aslant, less is known than across: the careful one counts.
        assert!((-2.0..-1.3).contains(&of(0.2)), "{}", of(0.2));
        assert_eq!(deviations_beyond(&a, &b, 0.05, 0.9), None);
        assert_eq!(deviations_beyond(&a, &a, 0.05, 9.0), Some(f64::NEG_INFINITY));
    }

    #[test]
    fn exact_pieces_are_apart_and_never_nan() {
        let exact = |x: f64| disc(Point3::new(x, 0.0, 0.0), Vector3::z(), 0.0, 0.0);
        assert_eq!(squared_deviations(&exact(0.0), &exact(1.0), 1e9), None);
        assert_eq!(squared_deviations(&exact(0.0), &exact(0.0), 9.0), Some(0.0));
        let one_place = disc(Point3::origin(), Vector3::z(), 0.1, 0.1);
        let meeting = Meeting::of(&one_place.point, &one_place.point).unwrap();
        assert_eq!((meeting.deviations, meeting.normal), (0.0, None));
    }
}
