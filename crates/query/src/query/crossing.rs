//! Evidence that two sampled surfaces cross between their samples, where a curved surface could
//! still separate the samples themselves.
//!
//! An edge joins two neighbouring samples of one cloud; it stands for the surface between them. A
//! disc about a sample of the other cloud, across its normal, stands for the surface around it.
//! An edge whose ends lie clearly on two sides of a disc, and that passes close to its middle,
//! crosses it.

use cloudtouch_geom::{Vector3, normal};

use super::classify::PairPoint;

/// Edges join samples up to this many spacings apart.
const EDGE_SPACINGS: f64 = 2.2;
/// Edges run along the surface: the sine of their angle to it is at most this.
const EDGE_SLOPE: f64 = 0.5;
/// The weight of a disc falls off like a normal density with this many spacings.
const DISC_SPACINGS: f64 = 0.5;
/// Beyond this many spacings from its middle a disc says nothing.
const DISC_REACH: f64 = 1.5;

/// An edge to a sample of another leaf can cross outside the boxes of its pair, where the bound of
/// the pair says nothing; so much above that bound a point may be raised, and no farther: the other
/// leaf's own pair sees the same edge.
const ABOVE_BOUND: f64 = 3.0;

/// No point of a pair is more probable than this when a surface between its boxes leaves no point
/// more than `bound`.
pub(crate) fn bound_with_crossing(bound: f64) -> f64 {
    (ABOVE_BOUND * bound).min(1.0)
}

/// Pairs below this bound cannot hold a point more probable than `probability`.
pub(crate) fn bound_without_crossing(probability: f64) -> f64 {
    probability / ABOVE_BOUND
}

/// For every point of both sides, the probability that the surface at it crosses the other one.
///
/// The rims are the samples of other leaves that the surface of each side goes on to.
pub(crate) fn crossing(
    (a, rim_a): (&[PairPoint], &[PairPoint]),
    (b, rim_b): (&[PairPoint], &[PairPoint]),
) -> (Vec<f64>, Vec<f64>) {
    let (mut of_a, mut of_b) = (vec![0.0; a.len()], vec![0.0; b.len()]);
    edges_through_discs(a, rim_a, b, &mut of_a, &mut of_b);
    edges_through_discs(b, rim_b, a, &mut of_b, &mut of_a);
    (of_a, of_b)
}

/// Raises the probability of each point to that of the clearest crossing it takes part in. Edges
/// beside each other are one piece of evidence, so nothing is added up.
fn edges_through_discs(
    own: &[PairPoint],
    rim: &[PairPoint],
    discs: &[PairPoint],
    of_own: &mut [f64],
    of_discs: &mut [f64],
) {
    for (i, start) in own.iter().enumerate() {
        // Each edge within the leaf once, from its later end.
        for (j, end) in own[..i].iter().chain(rim).enumerate() {
            if !is_edge(start, end) {
                continue;
            }
            for (disc, of_disc) in discs.iter().zip(of_discs.iter_mut()) {
                let probability = passes_through(start, end, disc);
                of_own[i] = of_own[i].max(probability);
                if j < i {
                    of_own[j] = of_own[j].max(probability);
                }
                *of_disc = of_disc.max(probability);
            }
        }
    }
}

fn is_edge(p: &PairPoint, q: &PairPoint) -> bool {
    let step = q.point.mean - p.point.mean;
    let length = step.norm();
    let along = |n: Option<Vector3>| n.is_some_and(|n| step.dot(&n).abs() <= EDGE_SLOPE * length);
    length <= EDGE_SPACINGS * p.spacing.max(q.spacing) && along(p.normal) && along(q.normal)
}

fn passes_through(p: &PairPoint, q: &PairPoint, disc: &PairPoint) -> f64 {
    let Some(axis) = disc.normal else { return 0.0 };
    let height = |end: &PairPoint| (end.point.mean - disc.point.mean).dot(&axis);
    let (above, below) = (height(p), height(q));
    if above * below >= 0.0 {
        return 0.0;
    }
    let share = above / (above - below);
    let place = p.point.mean + (q.point.mean - p.point.mean) * share;
    let off = (place - disc.point.mean).norm() / disc.spacing;
    if off.is_nan() || off > DISC_REACH {
        return 0.0;
    }
    let across =
        |point: &PairPoint| point.normal.map_or(0.0, |n| point.point.covariance.variance_along(&n));
    let clearly = |end: &PairPoint, height: f64| {
        let std = (across(end) + across(disc)).sqrt();
        // Twice the excess over one half: none on the disc, certain far from it.
        1.0 - 2.0 * normal::below_zero(height.abs(), std)
    };
    let near = (-0.5 * (off / DISC_SPACINGS).powi(2)).exp();
    clearly(p, above) * clearly(q, below) * near
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;

    /// A 5×5 grid of spacing 1 in the plane across `normal`, spanned by `u` and `v`.
    fn sheet(origin: Point3, u: Vector3, v: Vector3, std: f64) -> Vec<PairPoint> {
        let normal = u.cross(&v);
        let at = |i: i32, j: i32| PairPoint {
            index: None,
            point: UncertainPoint {
                mean: origin + u * f64::from(i) + v * f64::from(j),
                covariance: Covariance::from_axis(&normal, std, 0.35),
            },
            spacing: 1.0,
            normal: Some(normal),
        };
        (-2..=2).flat_map(|i| (-2..=2).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect()
    }

    fn largest((a, b): (Vec<f64>, Vec<f64>)) -> f64 {
        a.into_iter().chain(b).fold(0.0, f64::max)
    }

    #[test]
    fn sheets_that_cross_between_their_rows_cross() {
        let flat = sheet(Point3::new(0.5, 0.0, 0.0), Vector3::x(), Vector3::y(), 0.05);
        let upright = sheet(Point3::new(0.0, 0.5, 0.5), Vector3::y(), Vector3::z(), 0.05);
        let both = largest(crossing((&flat, &[]), (&upright, &[])));
        assert!(both > 0.5, "{both}");
        assert_eq!(both, largest(crossing((&upright, &[]), (&flat, &[]))));
        // Half of a sheet in another leaf: what the other half lacks is in its rim.
        let (left, right): (Vec<_>, Vec<_>) = flat.iter().partition(|p| p.point.mean.x < 0.0);
        let above: Vec<_> = upright.iter().filter(|p| p.point.mean.z > 0.0).copied().collect();
        assert_eq!(largest(crossing((&left, &[]), (&above, &[]))), 0.0);
        assert!(largest(crossing((&left, &right), (&above, &[]))) > 0.5);
    }

    #[test]
    fn sheets_apart_do_not_cross_however_close() {
        let flat = sheet(Point3::origin(), Vector3::x(), Vector3::y(), 0.05);
        for gap in [0.01, 0.5] {
            let above = sheet(Point3::new(0.3, 0.3, gap), Vector3::x(), Vector3::y(), 0.05);
            assert_eq!(largest(crossing((&flat, &[]), (&above, &[]))), 0.0, "gap {gap}");
        }
    }

    #[test]
    fn noise_larger_than_the_crossing_says_little() {
        let flat = sheet(Point3::new(0.5, 0.0, 0.0), Vector3::x(), Vector3::y(), 30.0);
        let upright = sheet(Point3::new(0.0, 0.5, 0.5), Vector3::y(), Vector3::z(), 30.0);
        assert!(largest(crossing((&flat, &[]), (&upright, &[]))) < 0.01);
    }
}
