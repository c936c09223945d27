//! Round and bent solids: profiles turned about an axis, tubes along paths.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use nalgebra::{Unit, UnitQuaternion};

use super::{
    assemble::mesh,
    primitives::{ring, unit_circle},
};

/// A closed solid of revolution about the z axis, of so many `sides`: the profile is given as
/// (distance from the axis, z) from the axis out and back to it, anticlockwise, so that a solid
/// goes up outside. Corners of the polygon are at the profile's distances.
///
/// # Panics
/// When the profile does not begin and end on the axis, or touches it in between.
pub fn revolved(profile: &[[f64; 2]], sides: usize) -> TriangleMesh {
    let [first, rim @ .., last] = profile else { panic!("a profile has ends") };
    assert!(first[0] == 0.0 && last[0] == 0.0, "a profile begins and ends on the axis");
    assert!(rim.len() > 1 && rim.iter().all(|[r, _]| *r > 0.0), "a profile leaves the axis");
    let circle = unit_circle(sides);
    let around = |&[x, y]: &[f64; 2]| rim.iter().map(move |&[r, z]| Point3::new(r * x, r * y, z));
    let mut vertices: Vec<Point3> = circle.iter().flat_map(around).collect();
    let poles = [vertices.len() as u32, vertices.len() as u32 + 1];
    vertices.extend([first, last].map(|[_, z]| Point3::new(0.0, 0.0, *z)));
    let index = |i: usize, j: usize| ((i % sides) * rim.len() + j) as u32;
    let mut triangles = Vec::new();
    for i in 0..sides {
        triangles.push([poles[0], index(i + 1, 0), index(i, 0)]);
        for j in 1..rim.len() {
            let [a, b] = [index(i, j - 1), index(i + 1, j - 1)];
            triangles.push([a, b, index(i + 1, j)]);
            triangles.push([a, index(i + 1, j), index(i, j)]);
        }
        triangles.push([index(i, rim.len() - 1), index(i + 1, rim.len() - 1), poles[1]]);
    }
    mesh(vertices, triangles)
}

/// A closed ring about the z axis, of so many `sides`: its closed profile, (distance from the axis,
/// z), is given anticlockwise and stays off the axis.
pub fn revolved_ring(profile: &[[f64; 2]], sides: usize) -> TriangleMesh {
    ring(
        unit_circle(sides)
            .iter()
            .map(|&[x, y]| profile.iter().map(|&[r, z]| Point3::new(r * x, r * y, z)).collect()),
    )
}

/// A closed tube of so many `sides` along a path of straight pieces, mitred at its corners, with
/// flat ends; `radius` is that of the polygon's corners.
///
/// # Panics
/// When the path has fewer than two points, or turns back on itself at a corner.
pub fn tube(path: &[Point3], radius: f64, sides: usize) -> TriangleMesh {
    let ahead: Vec<Vector3> = path.windows(2).map(|ends| (ends[1] - ends[0]).normalize()).collect();
    let mut across = ahead[0].cross(&Vector3::ith(ahead[0].iamin(), 1.0)).normalize();
    let mut vertices = Vec::new();
    for (k, corner) in path.iter().enumerate() {
        let before = ahead[k.saturating_sub(1)];
        let after = ahead[k.min(ahead.len() - 1)];
        let up = before.cross(&across);
        // The plane that halves the corner; reflection in it leads the tube around.
        let halfway = (before + after).try_normalize(1e-6).expect("a path does not turn back");
        vertices.extend(unit_circle(sides).iter().map(|[cos, sin]| {
            let out = (across * *cos + up * *sin) * radius;
            corner + out - before * (out.dot(&halfway) / before.dot(&halfway))
        }));
        across -= halfway * (2.0 * across.dot(&halfway));
        across = (across - after * across.dot(&after)).normalize();
    }
    let (n, end) = (sides as u32, (vertices.len() - sides) as u32);
    let mut triangles = Vec::new();
    for start in (0..end).step_by(sides) {
        for i in 0..n {
            let [a, b] = [start + i, start + (i + 1) % n];
            triangles.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    for i in 1..n - 1 {
        triangles.extend([[0, i + 1, i], [end, end + i, end + i + 1]]);
    }
    mesh(vertices, triangles)
}

/// A path of arcs: `center` plus the vector `from` turned about `axis` by 0 to `angle` rad, in
/// `steps` steps, moving by `rise` metres along the axis on the way (a spring when not zero).
pub fn arc(
    center: Point3,
    from: Vector3,
    axis: Unit<Vector3>,
    angle: f64,
    rise: f64,
    steps: usize,
) -> Vec<Point3> {
    (0..=steps)
        .map(|i| {
            let share = i as f64 / steps as f64;
            let turn = UnitQuaternion::from_axis_angle(&axis, angle * share);
            center + turn * from + axis.as_ref() * (rise * share)
        })
        .collect()
}

/// The same path with its corners cut `reach` metres before and after and bridged by parabolas.
///
/// `reach` must be less than half of every piece.
pub fn rounded(path: &[Point3], reach: f64) -> Vec<Point3> {
    let mut smooth = vec![path[0]];
    for corner in path.windows(3) {
        let [from, to] = [corner[0], corner[2]].map(|p| (p - corner[1]).normalize() * reach);
        smooth.extend(
            [0.0, 0.25, 0.5, 0.75, 1.0]
                .map(|t: f64| corner[1] + from * ((1.0 - t) * (1.0 - t)) + to * (t * t)),
        );
    }
    smooth.extend(path.last());
    smooth
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::*;
    use crate::surface::volume;

    fn check(solid: &TriangleMesh, expected: f64) {
        assert_eq!((solid.open_edges(), solid.merged().open_edges()), (0, 0));
        let ratio = volume(solid) / expected;
        assert!((0.97..1.0 + 1e-9).contains(&ratio), "{ratio}");
    }

    #[test]
    fn revolved_profiles_enclose_their_volume() {
        let cup =
            [[0.0, 0.0], [0.05, 0.0], [0.05, 0.1], [0.045, 0.1], [0.045, 0.005], [0.0, 0.005]];
        check(&revolved(&cup, 48), PI * (0.05 * 0.05 * 0.1 - 0.045 * 0.045 * 0.095));
        let cone = [[0.0, 0.0], [0.2, 0.0], [0.1, 0.3], [0.0, 0.3]];
        check(&revolved(&cone, 48), PI * 0.1 * (0.04 + 0.02 + 0.01));
    }

    #[test]
    fn bent_tubes_have_the_volume_of_their_middle_line() {
        let elbow = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0, 0.4, 0.3], [0.5, 0.4, 0.3]];
        let elbow = elbow.map(Point3::from);
        check(&tube(&elbow, 0.03, 32), PI * 0.0009 * 1.2);
        let quarter = arc(Point3::origin(), Vector3::x(), Vector3::z_axis(), FRAC_PI_2, 0.0, 16);
        check(&tube(&quarter, 0.1, 32), PI * 0.01 * FRAC_PI_2);
        let spring = arc(Point3::origin(), Vector3::x(), Vector3::z_axis(), 3.0 * TAU, 1.5, 96);
        check(&tube(&spring, 0.1, 32), PI * 0.01 * (3.0 * TAU).hypot(1.5));
        let soft = rounded(&elbow, 0.1);
        assert_eq!((soft[0], *soft.last().unwrap()), (elbow[0], elbow[3]));
        check(&tube(&soft, 0.03, 32), PI * 0.0009 * 1.1246);
    }
}
