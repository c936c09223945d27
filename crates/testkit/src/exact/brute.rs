//! Triangle against triangle in double precision, every pair: slow and easy to check.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};

use crate::surface::scaled_normal;

/// Heights below this share of an edge are taken as zero.
const ROUNDING: f64 = 1e-13;

/// A triangle by its corners.
pub type Triangle = [Point3; 3];

/// Whether two surfaces have a point in common, trying every pair of triangles.
///
/// Coplanar triangles that overlap are found by their distance, not here: this may go either way
/// for surfaces that merely touch.
pub fn intersects(a: &TriangleMesh, b: &TriangleMesh, a_from_b: &Pose) -> bool {
    any_pair(a, b, a_from_b, triangles_cross)
}

/// The distance between two surfaces, m; zero when they intersect, trying every pair.
pub fn distance(a: &TriangleMesh, b: &TriangleMesh, a_from_b: &Pose) -> f64 {
    let mut least = f64::INFINITY;
    any_pair(a, b, a_from_b, |s, t| {
        least = least.min(triangle_distance(s, t));
        least == 0.0
    });
    least
}

/// The distance of a point from a surface, m, trying every triangle.
pub fn point_distance(mesh: &TriangleMesh, point: &Point3) -> f64 {
    (0..mesh.triangles().len())
        .map(|t| point_triangle_distance(point, &mesh.corners(t)))
        .fold(f64::INFINITY, f64::min)
}

fn any_pair(
    a: &TriangleMesh,
    b: &TriangleMesh,
    a_from_b: &Pose,
    mut found: impl FnMut(&Triangle, &Triangle) -> bool,
) -> bool {
    let placed: Vec<Triangle> = (0..b.triangles().len())
        .map(|t| b.corners(t).map(|p| a_from_b.transform_point(&p)))
        .collect();
    (0..a.triangles().len()).any(|s| {
        let s = a.corners(s);
        placed.iter().any(|t| found(&s, t))
    })
}

/// Whether an edge of one triangle goes through the other.
pub fn triangles_cross(s: &Triangle, t: &Triangle) -> bool {
    let pierces = |edges: &Triangle, face: &Triangle| {
        (0..3).any(|i| segment_pierces(&edges[i], &edges[(i + 1) % 3], face))
    };
    pierces(s, t) || pierces(t, s)
}

/// The distance of two triangles, m; zero when one pierces the other.
pub fn triangle_distance(s: &Triangle, t: &Triangle) -> f64 {
    if triangles_cross(s, t) {
        return 0.0;
    }
    let mut least = f64::INFINITY;
    for i in 0..3 {
        least = least.min(point_triangle_distance(&s[i], t));
        least = least.min(point_triangle_distance(&t[i], s));
        for j in 0..3 {
            least = least.min(segment_distance(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
        }
    }
    least
}

/// Whether the ends lie on two sides of the face and the line between passes through it.
fn segment_pierces(p: &Point3, q: &Point3, face: &Triangle) -> bool {
    let [a, b, c] = face;
    let normal = scaled_normal(face);
    let (above, below) = (normal.dot(&(p - a)), normal.dot(&(q - a)));
    // A segment in the face's plane pierces nothing; where it lies is then decided by rounding.
    let in_plane = ROUNDING * normal.norm() * (q - p).norm().max((b - a).norm());
    if above * below > 0.0 || (above.abs() <= in_plane && below.abs() <= in_plane) {
        return false;
    }
    let side = |x: &Point3, y: &Point3| (q - p).cross(&(x - p)).dot(&(y - p));
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|&v| v >= 0.0) || sides.iter().all(|&v| v <= 0.0)
}

/// The distance of a point from a triangle, m; a triangle without area counts as its edges.
pub fn point_triangle_distance(p: &Point3, triangle: &Triangle) -> f64 {
    let normal = scaled_normal(triangle);
    let [a, b, c] = triangle;
    let inside = |from: &Point3, to: &Point3| (to - from).cross(&(p - from)).dot(&normal) >= 0.0;
    if normal.norm_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return ((p - a).dot(&normal) / normal.norm()).abs();
    }
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(|(from, to)| (p - nearest_on_segment(p, from, &(to - from))).norm())
        .fold(f64::INFINITY, f64::min)
}

fn nearest_on_segment(p: &Point3, start: &Point3, along: &Vector3) -> Point3 {
    let squared = along.norm_squared();
    let t = if squared > 0.0 { ((p - start).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    start + along * t
}

/// The distance of two segments, m: an end of one to the other, or between inner points.
fn segment_distance(p: Point3, p_end: Point3, q: Point3, q_end: Point3) -> f64 {
    let (u, v, w) = (p_end - p, q_end - q, p - q);
    let ends = [
        (p - nearest_on_segment(&p, &q, &v)).norm(),
        (p_end - nearest_on_segment(&p_end, &q, &v)).norm(),
        (q - nearest_on_segment(&q, &p, &u)).norm(),
        (q_end - nearest_on_segment(&q_end, &p, &u)).norm(),
    ];
    let mut least = ends.into_iter().fold(f64::INFINITY, f64::min);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let determinant = uu * vv - uv * uv;
    // Nearly parallel segments are nearest at an end.
    if determinant > 1e-14 * uu * vv {
        let s = (uv * v.dot(&w) - vv * u.dot(&w)) / determinant;
        let t = (uu * v.dot(&w) - uv * u.dot(&w)) / determinant;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            least = least.min((w + u * s - v * t).norm());
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(z: f64) -> Triangle {
        [Point3::new(0.0, 0.0, z), Point3::new(1.0, 0.0, z), Point3::new(0.0, 1.0, z)]
    }

    #[test]
    fn distances_of_every_kind_of_pair() {
        // Face to corner, edge to edge, parallel faces, crossing.
        assert_eq!(point_triangle_distance(&Point3::new(0.2, 0.2, -0.5), &flat(0.0)), 0.5);
        assert_eq!(point_triangle_distance(&Point3::new(-3.0, -4.0, 0.0), &flat(0.0)), 5.0);
        let edge = [
            Point3::new(0.5, -1.0, 1.0),
            Point3::new(0.5, 1.0, -1.0),
            Point3::new(0.5, -1.0, -1.0),
        ];
        assert!(triangles_cross(&flat(-0.25), &edge));
        assert_eq!(triangle_distance(&flat(-0.25), &edge), 0.0);
        assert_eq!(triangle_distance(&flat(0.0), &flat(0.3)), 0.3);
        let skew = segment_distance(
            Point3::new(-1.0, 0.0, 0.0),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, -1.0, 0.7),
            Point3::new(0.0, 1.0, 0.7),
        );
        assert!((skew - 0.7).abs() < 1e-15);
    }
}
