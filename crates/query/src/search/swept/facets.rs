//! Whether two triangles can touch while one of them drifts.

use cloudtouch_geom::Vector3;

use super::course::Course;
use crate::search::compare::facet::Facet;

/// No for certain where a plane keeps between them all the way: one across a normal, across an edge of
/// each, or across an edge and the way it is carried.
pub(super) fn may_touch(a: &Facet, b: &Facet, drift: &Course) -> bool {
    let edges = |facet: &Facet| {
        let [p, q, r] = facet.corners;
        [q - p, r - q, p - r]
    };
    let (of_a, of_b) = (edges(a), edges(b));
    let way = drift.first_order(&b.corners[0]);
    let apart = |n: Vector3| n.try_normalize(0.0).is_some_and(|n| is_apart_along(&n, a, b, drift));
    let is_apart = [a.normal, b.normal].into_iter().flatten().any(apart)
        || of_a.iter().chain(&of_b).any(|edge| apart(edge.cross(&way)))
        || of_a.iter().any(|p| of_b.iter().any(|q| apart(p.cross(q))));
    !is_apart
}

fn is_apart_along(n: &Vector3, a: &Facet, b: &Facet, drift: &Course) -> bool {
    let of_a = a.corners.map(|corner| n.dot(&corner.coords));
    let of_b = b.corners.map(|corner| (n.dot(&corner.coords), drift.along(n, &corner)));
    let lowest = |values: [f64; 3]| values.into_iter().fold(f64::INFINITY, f64::min);
    let highest = |values: [f64; 3]| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    // What coordinates of this size are rounded by.
    let size =
        of_a.iter().chain(of_b.iter().map(|(at, _)| at)).fold(0.0, |m: f64, v| m.max(v.abs()));
    let rounding = 16.0 * f64::EPSILON * size;
    lowest(of_b.map(|(at, by)| at - by)) > highest(of_a) + rounding
        || highest(of_b.map(|(at, by)| at + by)) < lowest(of_a) - rounding
}
