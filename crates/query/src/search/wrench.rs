//! How a number changes with the pose of B: a force at a place, as in mechanics.
//!
//! B moves by a twist (v, ω) in the frame of A: its point at p by v + ω × p. A number that changes by
//! f·(v + ω × p) has the wrench (f, p × f).

use cloudtouch_geom::{Matrix3, Motion, Point3, Vector3};
use nalgebra::{Matrix3x6, Vector6};

/// What a number changes by with a twist of B: per metre along the axes of A, then per radian about
/// them through the origin of A.
pub(crate) type Wrench = Vector6<f64>;

/// Of a number that changes by `force` for each metre that the point of B at `place` moves.
pub(crate) fn force_at(place: &Point3, force: &Vector3) -> Wrench {
    let torque = place.coords.cross(force);
    Wrench::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
}

/// How far an end is above what it passes, or off its middle, m, and what that changes by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Height {
    pub value: f64,
    pub by_pose: Wrench,
}

/// What a vector changes by with a twist of B, by columns as in a [`Wrench`].
pub(crate) type Changes = Matrix3x6<f64>;

/// Of a place that moves with B.
pub(crate) fn of_place(place: &Point3) -> Changes {
    let mut changes = of_direction(&place.coords);
    changes.fixed_columns_mut::<3>(0).copy_from(&Matrix3::identity());
    changes
}

/// Of a direction that turns with B.
pub(crate) fn of_direction(direction: &Vector3) -> Changes {
    let mut changes = Changes::zeros();
    changes.fixed_columns_mut::<3>(3).copy_from(&(-direction.cross_matrix()));
    changes
}

/// What the nearest place of a triangle that moves with B changes by, by the lengths of a `metric` W
/// about a place that keeps: besides moving, it slides along the corner, edge or inside that it is on so
/// that the way there stays W-orthogonal to it.
pub(crate) fn way_to_triangle(
    corners: &[Point3; 3],
    nearest: &Point3,
    way: &Vector3,
    metric: &Matrix3,
) -> Changes {
    /// Nearer to a border than this share of the triangle it is on it.
    const BORDER: f64 = 1e-9;
    let [p, q, r] = *corners;
    let normal = (q - p).cross(&(r - p));
    let shares = [(q, r), (r, p), (p, q)].map(|(from, to)| {
        (to - from).cross(&(nearest - from)).dot(&normal) / normal.norm_squared()
    });
    let touched: Vec<Point3> = (0..3).filter(|&k| shares[k] > BORDER).map(|k| corners[k]).collect();
    let rides = of_place(nearest);
    let free: Vec<Vector3> = touched.iter().skip(1).map(|corner| corner - touched[0]).collect();
    let weighted = metric * way;
    // Of each direction d that it may slide along: dᵀW(way) stays nothing.
    let misses = free
        .iter()
        .map(|d| (rides.tr_mul(&(metric * d)) + of_direction(d).tr_mul(&weighted)).transpose());
    let misses: Vec<_> = misses.collect();
    match *free.as_slice() {
        [d] => rides - d * (misses[0] / d.dot(&(metric * d))),
        [d, e] => {
            let between = |x: &Vector3, y: &Vector3| x.dot(&(metric * y));
            let (dd, de, ee) = (between(&d, &d), between(&d, &e), between(&e, &e));
            let determinant = dd * ee - de * de;
            let along_d = (misses[0] * ee - misses[1] * de) / determinant;
            let along_e = (misses[1] * dd - misses[0] * de) / determinant;
            rides - d * along_d - e * along_e
        }
        _ => rides,
    }
}

/// By a small motion before the pose, in the frame of B (translation, then rotation vector, about
/// `origin` there), where `a_from_b` is the pose.
pub(crate) fn in_object_frame(wrench: &Wrench, a_from_b: &Motion, origin: &Vector3) -> [f64; 6] {
    let (force, torque) = (Vector3::from(wrench.fixed_rows::<3>(0)), wrench.fixed_rows::<3>(3));
    let here = a_from_b.point(&Point3::from(-origin));
    let about = a_from_b.vector_back(&(torque - here.coords.cross(&force)));
    let force = a_from_b.vector_back(&force);
    [force.x, force.y, force.z, about.x, about.y, about.z]
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;

    #[test]
    fn a_height_changes_as_a_small_motion_of_the_object_says() {
        let pose = Pose::from_translation_rpy(Vector3::new(0.3, -0.2, 0.5), [0.4, -1.0, 2.0]);
        let (at, axis) = (Point3::new(0.1, 0.2, -0.3), Vector3::new(1.0, 2.0, 2.0) / 3.0);
        let origin = Vector3::new(5.0, -3.0, 1.0);
        let motion = Motion::from(&pose);
        let found = in_object_frame(&force_at(&motion.point(&at), &axis), &motion, &origin);
        for (k, found) in found.into_iter().enumerate() {
            let height = |step: f64| {
                let (mut shift, mut turn) = (Vector3::zeros(), Vector3::zeros());
                if k < 3 {
                    shift[k] = step
                } else {
                    turn[k - 3] = step
                }
                let turn = nalgebra::UnitQuaternion::from_scaled_axis(turn);
                // About the origin of the object's file, which is `origin` away from that of its points.
                let moved = turn * (at.coords + origin) + shift - origin;
                pose.transform_point(&Point3::from(moved)).coords.dot(&axis)
            };
            let difference = (height(1e-6) - height(-1e-6)) / 2e-6;
            assert!((found - difference).abs() < 1e-7, "{k}: {found} {difference}");
        }
    }
}
