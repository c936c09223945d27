//! Where the most probable points of a leaf pair meet its surface, when several are equally probable.

use std::cmp::Ordering;

use cloudtouch_geom::{Point3, Vector3};

use crate::classifier::{PairPoint, PairPoints, SETTLED, Surface, centroid};

/// Points within this share of the largest probability are equally good witnesses: the best plane
/// has the same distance, in standard deviations, from several, and rounding must not choose. From
/// there to twice this share they count ever less: one that left all at once would take the contact
/// with it, and on which side of a limit it is hangs on the last digits of the surface.
const TIE: f64 = 1e-3;
/// A contact is not farther from the samples it stands for than this many spacings and their noise.
const KNOWN_SPACINGS: f64 = 2.0;

/// A point that is as probable as the most probable one, or nearly so.
#[derive(Debug, Clone, Copy)]
struct Witness {
    point: PairPoint,
    /// From 1, in a tie, to 0.
    weight: f64,
}

/// Where the equally probable points project to on the surface, and the normal there: their middle
/// or, where it does not, the one of them whose foot is next to it.
///
/// Where the surface is near none, the middle itself is the contact, and the normal is the
/// direction from one leaf to the other.
pub(super) fn foot_of_the_tied(
    points: &PairPoints,
    (a, b): (&[f64], &[f64]),
    surface: &Surface,
    probability: f64,
    reach: f64,
) -> (Point3, Vector3) {
    let all = points.a.iter().zip(a).chain(points.b.iter().zip(b));
    let witness = |(&point, &p)| Witness { point, weight: weight(p, probability) };
    let tied: Vec<Witness> = all.map(witness).filter(|witness| witness.weight > 0.0).collect();
    let middle = middle(&tied);
    // The surface is known near the samples; where it bulges away from them it means nothing.
    let known = |Witness { point, .. }: &Witness| {
        KNOWN_SPACINGS * point.spacing + 3.0 * point.point.covariance.std_bound()
    };
    let nearby = tied.iter().map(known).fold(0.0, f64::max).min(reach);
    surface
        .project(&middle, nearby)
        .or_else(|| foot_of_one(&tied, &middle, surface, nearby))
        .unwrap_or_else(|| {
            let across = centroid(&points.b) - centroid(&points.a);
            (middle, across.try_normalize(0.0).unwrap_or_else(Vector3::z))
        })
}

fn weight(probability: f64, largest: f64) -> f64 {
    let short = largest - probability;
    // Where the largest is 0 all are equal.
    if short <= TIE * largest { 1.0 } else { (2.0 - short / (TIE * largest)).max(0.0) }
}

fn middle(tied: &[Witness]) -> Point3 {
    let sum: Vector3 = tied.iter().map(|of| of.point.point.mean.coords * of.weight).sum();
    Point3::from(sum / tied.iter().map(|of| of.weight).sum::<f64>())
}

/// The foot next to the middle. In deep overlap points all around may be equally certain, and their
/// middle far from the surface. The feet are compared, not the points: two points are as far from
/// their middle.
///
/// Between feet that are equally far, as far as a projection tells, the point that comes first in
/// space decides, so that it makes no difference which body is named first.
fn foot_of_one(
    tied: &[Witness],
    middle: &Point3,
    surface: &Surface,
    nearby: f64,
) -> Option<(Point3, Vector3)> {
    let foot = |of: &Witness| {
        let foot = surface.project(&of.point.point.mean, nearby)?;
        // The less a point counts, the farther off it is.
        Some((of.point.point.mean, foot, (foot.0 - middle).norm() / of.weight))
    };
    let feet: Vec<_> = tied.iter().filter_map(foot).collect();
    let least = feet.iter().map(|of| of.2).fold(f64::INFINITY, f64::min);
    let nearest = feet.iter().filter(|of| of.2 <= least + SETTLED * nearby);
    nearest.min_by(|p, q| by_place(&p.0, &q.0)).map(|of| of.1)
}

fn by_place(p: &Point3, q: &Point3) -> Ordering {
    p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_witness_leaves_little_by_little() {
        assert_eq!([1.0, 0.9995].map(|p| weight(p, 1.0)), [1.0; 2]);
        assert!((weight(0.9985, 1.0) - 0.5).abs() < 1e-9);
        assert_eq!(weight(0.997, 1.0), 0.0);
        // Of nothing but zeros all are equal.
        assert_eq!(weight(0.0, 0.0), 1.0);
    }
}
