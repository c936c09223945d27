//! Separating directions of two convex hulls by the method of Gilbert, Johnson and Keerthi.

use cloudtouch_geom::Vector3;

/// How far a search for a separating direction goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Any direction that separates.
    First,
    /// The direction of the closest points, to a tenth of the distance.
    Closest,
}

/// More iterations only polish the distance of smooth bodies, which the caller does not need.
const MAX_ITERATIONS: usize = 48;

/// A direction n with n·z > 0 for every z of a convex set, or `None` when none was found.
///
/// `lowest(n)` returns the point of the set lowest along n. `None` is no proof of contact: the
/// iteration may have run out, or the set may touch the origin within rounding.
pub(crate) fn separating_direction(
    lowest: impl Fn(&Vector3) -> Vector3,
    start: &Vector3,
    effort: Effort,
) -> Option<Vector3> {
    let mut best: Option<(Vector3, f64)> = None;
    let mut nearest = lowest(start);
    let mut simplex = vec![nearest];
    let mut size = nearest.norm();
    for _ in 0..MAX_ITERATIONS {
        let distance = nearest.norm();
        // Not above zero also holds for NaN.
        if distance.is_nan() || distance <= 1e-13 * size {
            break;
        }
        let direction = nearest / distance;
        let vertex = lowest(&direction);
        size = size.max(vertex.norm());
        let bound = direction.dot(&vertex);
        if bound > best.map_or(0.0, |(_, bound)| bound) {
            best = Some((direction, bound));
            if effort == Effort::First || bound >= 0.9 * distance {
                break;
            }
        }
        let progress = distance - bound;
        if progress.is_nan() || progress <= 1e-12 * size || simplex.contains(&vertex) {
            break;
        }
        simplex.push(vertex);
        let closer = nearest_on_simplex(&mut simplex);
        if closer.norm() >= distance {
            break;
        }
        nearest = closer;
    }
    best.map(|(direction, _)| direction)
}

/// The point nearest the origin on the hull of up to four points; keeps only the points that span
/// the face it lies on.
fn nearest_on_simplex(simplex: &mut Vec<Vector3>) -> Vector3 {
    let mut best: Option<(f64, Vector3, usize)> = None;
    for mask in 1..(1_usize << simplex.len()) {
        let face: Vec<Vector3> =
            (0..simplex.len()).filter(|k| mask >> k & 1 == 1).map(|k| simplex[k]).collect();
        if let Some(point) = nearest_in_face(&face) {
            let squared = point.norm_squared();
            if best.is_none_or(|(least, _, _)| squared < least) {
                best = Some((squared, point, mask));
            }
        }
    }
    let Some((_, point, mask)) = best else { return simplex[0] };
    let mut index = 0;
    simplex.retain(|_| {
        index += 1;
        mask >> (index - 1) & 1 == 1
    });
    point
}

/// The point of the affine hull nearest the origin, when it is a convex combination.
fn nearest_in_face(face: &[Vector3]) -> Option<Vector3> {
    let origin = face[0];
    let edges: Vec<Vector3> = face[1..].iter().map(|p| p - origin).collect();
    let inside =
        |weights: &[f64]| weights.iter().all(|w| *w >= 0.0) && weights.iter().sum::<f64>() <= 1.0;
    let weights = match edges[..] {
        [] => return Some(origin),
        [e] => vec![-origin.dot(&e) / e.norm_squared()],
        [e, f] => {
            let normal = e.cross(&f);
            let area = normal.norm_squared();
            // Barycentric coordinates of the projection of the origin.
            vec![f.cross(&origin).dot(&normal) / area, origin.cross(&e).dot(&normal) / area]
        }
        [e, f, g] => {
            let volume = e.cross(&f).dot(&g);
            let to = -origin;
            vec![
                to.cross(&f).dot(&g) / volume,
                e.cross(&to).dot(&g) / volume,
                e.cross(&f).dot(&to) / volume,
            ]
        }
        _ => return None,
    };
    inside(&weights)
        .then(|| edges.iter().zip(&weights).fold(origin, |point, (edge, w)| point + edge * *w))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    fn lowest_of(points: &[Vector3], n: &Vector3) -> Vector3 {
        points.iter().copied().min_by(|a, b| n.dot(a).total_cmp(&n.dot(b))).unwrap()
    }

    #[test]
    fn a_direction_is_found_exactly_when_random_hulls_are_apart() {
        let (mut apart, mut around) = (0, 0);
        for case in 0..300 {
            let number = |k: u64| 2.0 * seed::unit(seed::derive(7, case, k)) - 1.0;
            let offset = 1.5 * number(1000);
            let points: Vec<Vector3> = (0..12)
                .map(|k| Vector3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2) + offset))
                .collect();
            let found =
                separating_direction(|n| lowest_of(&points, n), &Vector3::x(), Effort::Closest);
            // A fine search over directions stands for the truth.
            let best = (0..20_000)
                .map(|k| {
                    let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / 20_000.0;
                    let (r, turn) = ((1.0 - z * z).sqrt(), f64::from(k) * 2.399_963_229_728_653);
                    let n = Vector3::new(r * turn.cos(), r * turn.sin(), z);
                    n.dot(&lowest_of(&points, &n))
                })
                .fold(f64::NEG_INFINITY, f64::max);
            match found {
                Some(n) => {
                    let height = n.dot(&lowest_of(&points, &n));
                    assert!(height > 0.0 && height >= 0.85 * best, "{height} of {best}");
                    apart += 1;
                }
                None => {
                    assert!(best < 0.01, "case {case}: missed a distance of {best}");
                    around += 1;
                }
            }
        }
        assert!(apart > 50 && around > 50, "{apart} apart, {around} around");
    }
}
