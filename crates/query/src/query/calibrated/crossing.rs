//! Evidence that two sampled surfaces cross between their samples, where a curved surface could
//! still separate the samples themselves.
//!
//! An edge joins two neighbouring samples of one cloud; it stands for the surface between them. A
//! disc about a sample of the other cloud, across its normal, stands for the surface around it. An
//! edge whose ends lie clearly on two sides of a disc, and that passes close to its middle, crosses
//! it.

use cloudtouch_geom::{Point3, Vector3, normal};

use crate::cloud::{DISC_SPACINGS, Edge, SLOPE, Surfel};

use super::leaf::Leaf;

/// The weight of a disc falls off like a normal density with this many spacings.
const WEIGHT_SPACINGS: f64 = 0.5;
/// No crossing is clearer than this many standard deviations.
const CLEAREST: f64 = 6.0;

/// An edge that crosses a disc.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// How clearly, in standard deviations: that of the less clear end, weighted by how near the
    /// middle of the disc it passes.
    pub clearness: f64,
    /// The same as a probability: both ends on their sides, times the weight.
    pub probability: f64,
    /// Where.
    pub place: Point3,
    /// Unit normal of the disc, of either sign.
    pub axis: Vector3,
    /// How far the end that is nearer to the disc has come through, m, and its standard deviation.
    pub depth: f64,
    pub std: f64,
}

/// Whether an edge may cross a disc of another leaf near its end at a piece of the first: that can be
/// told before the edges are known, for half of one is not longer than a disc reaches, and runs along
/// the surface.
pub(super) fn may_reach(of_edges: &Leaf<'_>, of_discs: &Leaf<'_>) -> bool {
    let Leaf { ball, slab, .. } = of_discs;
    of_edges.surfels.iter().any(|surfel| {
        let Some(normal) = surfel.normal else { return false };
        let half = DISC_SPACINGS * surfel.spacing;
        let middle = &surfel.point.mean;
        slab.is_within(middle, half * SLOPE.mul_add(slab.cosine(&normal), slab.sine(&normal)))
            && ball.is_within(middle, half + DISC_SPACINGS * ball.spacing)
    })
}

/// Clearness of all crossings of edges of one leaf with discs of another; the points they join, and
/// those of the discs, are as probable as their clearest crossing.
pub(super) fn add_crossings(
    of_edges: &mut Leaf<'_>,
    of_discs: &mut Leaf<'_>,
    best: &mut Option<Crossing>,
) -> f64 {
    let mut total = 0.0;
    let (around, slab) = (of_discs.ball, of_discs.slab);
    // Taken out, for the edges are borrowed while probabilities are raised.
    let mut of_ends = std::mem::take(&mut of_edges.crossing);
    for edge in of_edges.edges() {
        if !slab.may_hold(&edge.ends) {
            continue;
        }
        let middle = nalgebra::center(&edge.ends[0], &edge.ends[1]);
        if !around.is_within(&middle, edge.half_length + DISC_SPACINGS * around.spacing) {
            continue;
        }
        for (disc, of_disc) in of_discs.surfels.iter().zip(&mut of_discs.crossing) {
            let reach = edge.half_length + DISC_SPACINGS * disc.spacing;
            if (disc.point.mean - middle).norm_squared() > reach * reach {
                continue;
            }
            let Some(found) = crossing(edge, disc) else { continue };
            total += found.clearness;
            *of_disc = of_disc.max(found.probability);
            for place in edge.own.into_iter().flatten() {
                of_ends[place] = of_ends[place].max(found.probability);
            }
            if best.is_none_or(|best| found.probability > best.probability) {
                *best = Some(found);
            }
        }
    }
    of_edges.crossing = of_ends;
    total
}

/// Whether an edge of a leaf crosses a disc; `None` too where the end nearer to the disc's plane is
/// not a point of that leaf: the other leaf has the same edge and counts it.
pub(super) fn crossing(edge: &Edge, disc: &Surfel) -> Option<Crossing> {
    let axis = disc.normal?;
    let middle = disc.point.mean;
    let [above, below] = edge.ends.map(|end| (end - middle).dot(&axis));
    if above * below >= 0.0 {
        return None;
    }
    let nearer = nearer_end(edge, [above.abs(), below.abs()]);
    edge.own[nearer]?;
    let share = above / (above - below);
    let place = edge.ends[0] + (edge.ends[1] - edge.ends[0]) * share;
    let off = (place - middle).norm() / disc.spacing;
    if off.is_nan() || off > DISC_SPACINGS {
        return None;
    }
    let of_disc = disc.variance_across();
    let stds = edge.across.map(|across| (across + of_disc).sqrt());
    let clear = (above.abs() / stds[0]).min(below.abs() / stds[1]);
    let near = (-0.5 * (off / WEIGHT_SPACINGS).powi(2)).exp();
    // Twice the excess over one half: none on the disc, certain far from it.
    let sure = |height: f64, std| 1.0 - 2.0 * normal::below_zero(height.abs(), std);
    Some(Crossing {
        clearness: clear.min(CLEAREST) * near,
        probability: sure(above, stds[0]) * sure(below, stds[1]) * near,
        place,
        axis,
        depth: above.abs().min(below.abs()),
        std: stds[nearer],
    })
}

/// The end with the smaller height; between equals the one that comes first in space, so that both
/// leaves of an edge say the same.
fn nearer_end(edge: &Edge, heights: [f64; 2]) -> usize {
    let key = |k: usize| {
        let end = edge.ends[k];
        (heights[k], end.x, end.y, end.z)
    };
    usize::from(key(1) < key(0))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint};

    use super::*;

    fn disc(std: f64) -> Surfel {
        let covariance = Covariance::from_axis(&Vector3::z_axis(), std, 0.35);
        Surfel {
            index: 0,
            point: UncertainPoint { mean: Point3::origin(), covariance },
            spacing: 1.0,
            most_variance: covariance.max_std().powi(2),
            normal: Some(Vector3::z()),
        }
    }

    fn upright(x: f64, low: f64, high: f64) -> Edge {
        Edge {
            ends: [Point3::new(x, 0.0, low), Point3::new(x, 0.0, high)],
            half_length: 0.5 * (high - low),
            across: [0.0; 2],
            own: [Some(0), None],
        }
    }

    #[test]
    fn an_edge_through_the_middle_crosses_as_clearly_as_its_nearer_end() {
        let found = crossing(&upright(0.0, -0.2, 0.5), &disc(0.1)).unwrap();
        assert!((found.clearness - 2.0).abs() < 1e-12, "{found:?}");
        assert!((found.depth - 0.2).abs() < 1e-12 && found.place == Point3::origin());
        // One spacing off the middle: two standard deviations of the weight.
        let aside = crossing(&upright(1.0, -0.2, 0.5), &disc(0.1)).unwrap();
        assert!((aside.clearness / found.clearness - (-2.0_f64).exp()).abs() < 1e-12);
        assert!(crossing(&upright(1.6, -0.2, 0.5), &disc(0.1)).is_none());
    }

    #[test]
    fn an_edge_on_one_side_does_not_cross() {
        assert!(crossing(&upright(0.0, 0.001, 0.5), &disc(0.1)).is_none());
        let mut unknown = disc(0.1);
        unknown.normal = None;
        assert!(crossing(&upright(0.0, -0.2, 0.5), &unknown).is_none());
    }

    #[test]
    fn noise_larger_than_the_crossing_says_little() {
        let found = crossing(&upright(0.0, -0.2, 0.5), &disc(30.0)).unwrap();
        assert!(found.clearness < 0.01 && found.probability < 0.001, "{found:?}");
    }

    #[test]
    fn of_the_two_leaves_of_an_edge_one_counts_a_crossing() {
        for (low, high) in [(-0.2, 0.5), (-0.5, 0.2), (-0.3, 0.3)] {
            let here = upright(0.0, low, high);
            let there = Edge { ends: [here.ends[1], here.ends[0]], ..here };
            let counted = [here, there].iter().filter_map(|e| crossing(e, &disc(0.1))).count();
            assert_eq!(counted, 1, "{low} {high}");
        }
    }
}
