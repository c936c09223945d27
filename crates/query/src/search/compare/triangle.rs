//! The nearest place of a triangle.

use cloudtouch_geom::Vector3;

/// The place of a triangle nearest to the origin, by the regions of its corners, edges and inside
/// (Ericson, Real-Time Collision Detection, 5.1.5).
pub(in crate::search) fn nearest_to_origin([a, b, c]: &[Vector3; 3]) -> Vector3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    // Not of an edge without length.
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = Vector3> {
        (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y, z)| Vector3::new(x, y, z))
    }

    /// One lost its nearest place: a wire that two corners of became one read free.
    #[test]
    fn two_corners_at_one_place_leave_an_edge() {
        let (p, q) = (Vector3::new(-1.0, 0.5, 0.0), Vector3::new(1.0, 0.5, 0.0));
        for corners in [[p, p, q], [p, q, p], [q, p, p], [q, q, p], [q, p, q], [p, q, q]] {
            assert_eq!(nearest_to_origin(&corners), Vector3::new(0.0, 0.5, 0.0));
        }
        assert_eq!(nearest_to_origin(&[p; 3]), p);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_place_of_a_triangle_is_nearer(
            a in vector(), b in vector(), c in vector(), u in 0.0..1.0_f64, v in 0.0..1.0_f64,
        ) {
            let nearest = nearest_to_origin(&[a, b, c]).norm();
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let other = a + (b - a) * u + (c - a) * v;
            prop_assert!(nearest <= other.norm() + 1e-12);
        }
    }
}
