//! How far the points of a body that moves get from their places at the middle of the motion.

use crate::vectors::{Matrix3, Point3, Vector3};

/// A motion about its middle: at s from −1 to 1 a point x is at c + s·l + R(s·ω)(x − c), with a pivot
/// c, a shift l and a turn ω, the pose at the middle being s = 0.
///
/// To first order a point moves by s·u, u = l + ω × (x − c); bounds are |n·u| along a direction n and
/// what the arc adds, so that a motion along a surface keeps its distance to it. What stays at its
/// place, seen from the body that moves, drifts too: [`Self::inverse`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drift {
    pivot: Point3,
    linear: Vector3,
    angular: Vector3,
    /// Unit vector along the axis; zero without a turn.
    axis: Vector3,
    /// 2 sin(|ω|/2): no unit vector turns by more.
    chord: f64,
    /// Length of R(ω)w − w − ω × w for a unit vector w across the axis.
    bend: f64,
    /// |l × axis|·chord: what the turn does to the shift in the inverse motion, m; nothing in the motion
    /// itself.
    skew: f64,
}

impl Drift {
    /// `linear` (m) and `angular` (radians about its own direction, at most half a turn) are the shift
    /// and the turn from the middle to either end.
    ///
    /// ```
    /// use cloudtouch_geom::{Drift, Point3, Vector3};
    /// // A turntable that has turned by 0.1 rad either way.
    /// let drift = Drift::new(Point3::origin(), Vector3::zeros(), Vector3::new(0.0, 0.0, 0.1));
    /// let rim = Point3::new(0.5, 0.0, 0.0);
    /// assert_eq!(drift.along(&Vector3::z(), &rim), 0.0);
    /// assert!((0.05..0.06).contains(&drift.along(&Vector3::y(), &rim)));
    /// ```
    pub fn new(pivot: Point3, linear: Vector3, angular: Vector3) -> Self {
        let angle = angular.norm();
        let axis = angular.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let chord = 2.0 * (0.5 * angle.min(std::f64::consts::PI)).sin();
        let bend = (angle - angle.sin()).hypot(1.0 - angle.cos());
        Self { pivot, linear, angular, axis, chord, bend, skew: 0.0 }
    }

    /// How what keeps still drifts as the body that moves sees it, in the frame of the middle: at s, to
    /// first order, by −s·u with the u of the motion itself, and farther off that where a turn meets a
    /// shift.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { skew: self.linear.cross(&self.axis).norm() * self.chord, ..*self }
    }

    /// u: where a point at a place is headed, m.
    #[inline]
    pub fn first_order(&self, place: &Point3) -> Vector3 {
        self.linear + self.angular.cross(&(place - self.pivot))
    }

    /// How far along a unit vector a point gets from a place at most, either way, m.
    #[inline]
    pub fn along(&self, direction: &Vector3, place: &Point3) -> f64 {
        // What the arc adds is across the axis.
        let across = self.across_axis(direction);
        self.first_order(place).dot(direction).abs() + across * self.beyond_first_order(place, 0.0)
    }

    /// How long the part of a unit vector across the axis is: what the arc adds along it is that share of
    /// [`Self::beyond_first_order`]. 0 without a turn.
    #[inline]
    pub fn across_axis(&self, direction: &Vector3) -> f64 {
        direction.cross(&self.axis).norm()
    }

    /// How far in any direction, m.
    #[inline]
    pub fn in_any_direction(&self, place: &Point3) -> f64 {
        self.first_order(place).norm() + self.beyond_first_order(place, 0.0)
    }

    /// What it does to a box, given by its middle and its half axes (columns), and to what is `around`
    /// metres about it.
    #[inline]
    pub fn of_box(&self, middle: &Point3, half_axes: &Matrix3, around: f64) -> BoxDrift {
        let way = self.first_order(middle);
        if self.angular == Vector3::zeros() {
            return BoxDrift { way, turning: None };
        }
        let beyond = self.beyond_first_order(middle, half_axes.norm() + around);
        let angle = self.angular.norm();
        BoxDrift {
            way,
            turning: Some(Turning {
                axis: self.axis,
                half_ways: half_axes * angle,
                beside: angle * around + beyond,
            }),
        }
    }

    /// By how much a direction that turns with the body gets from itself at most, as a length of the
    /// difference; 0 along the axis.
    #[inline]
    pub fn turn_of(&self, direction: &Vector3) -> f64 {
        self.chord * self.across_axis(direction)
    }

    /// The same of any direction.
    #[inline]
    pub fn turn(&self) -> f64 {
        self.chord
    }

    /// What the arc adds anywhere within a radius of a place, m; no more is left out of s·u.
    #[inline]
    pub fn beyond_first_order(&self, place: &Point3, radius: f64) -> f64 {
        if self.bend == 0.0 {
            return self.skew;
        }
        self.bend * (self.axis.cross(&(place - self.pivot)).norm() + radius) + self.skew
    }
}

/// How far the points of a box get: what a [`Drift`] says of it along any direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxDrift {
    /// Where its middle is headed, m.
    way: Vector3,
    turning: Option<Turning>,
}

/// What a turn adds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Turning {
    axis: Vector3,
    /// The half axes (columns) times the angle, m.
    half_ways: Matrix3,
    /// What is about the box, times the angle, and what the arc adds, m.
    beside: f64,
}

impl BoxDrift {
    /// How far along a unit vector any point of it gets from its place at most, either way, m.
    #[inline]
    pub fn along(&self, direction: &Vector3) -> f64 {
        let of_middle = self.way.dot(direction).abs();
        self.turning.as_ref().map_or(of_middle, |turning| {
            // n·(ω × y) = (n × ω)·y.
            let across = direction.cross(&turning.axis);
            let ways = turning.half_ways.tr_mul(&across);
            let beside = across.norm() * turning.beside;
            of_middle + ways.x.abs() + ways.y.abs() + ways.z.abs() + beside
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    use super::*;

    fn vector(size: f64) -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-size..size).prop_map(Vector3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_point_drifts_farther_whichever_body_is_said_to_move(
            pivot in vector(2.0), linear in vector(0.5), angular in vector(1.7), middle in vector(1.0),
            half in prop::array::uniform3(0.0..0.3_f64), direction in vector(1.0), s in -1.0..1.0_f64,
            inside in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            prop_assume!(direction.norm() > 1e-3 && angular.norm() < 3.1);
            let direction = direction.normalize();
            let (pivot, middle) = (Point3::from(pivot), Point3::from(middle));
            let drift = Drift::new(pivot, linear, angular);
            let inverse = drift.inverse();
            let axes = *UnitQuaternion::new(linear).to_rotation_matrix().matrix();
            let half_axes = axes * Matrix3::from_diagonal(&Vector3::from(half));
            let place = middle + half_axes * Vector3::from(inside);
            let turn = UnitQuaternion::new(angular * s);
            let there = pivot + linear * s + turn * (place - pivot);
            let back = pivot + turn.inverse() * (place - pivot - linear * s);
            for (drift, s, moved) in [(drift, s, there), (inverse, -s, back)] {
                let in_box = drift.of_box(&middle, &half_axes, 0.0).along(&direction);
                prop_assert!(drift.along(&direction, &place) <= in_box + 1e-12);
                let by = moved - place;
                let rest = by - drift.first_order(&place) * s;
                let beyond = drift.beyond_first_order(&place, 0.0);
                prop_assert!(rest.norm() <= beyond + 1e-12);
                prop_assert!(
                    rest.dot(&direction).abs() <= drift.across_axis(&direction) * beyond + 1e-12
                );
                prop_assert!(by.dot(&direction).abs() <= drift.along(&direction, &place) + 1e-12);
                prop_assert!(by.norm() <= drift.in_any_direction(&place) + 1e-12);
            }
            let turned = (turn * direction - direction).norm();
            prop_assert!(turned <= drift.turn_of(&direction) + 1e-12);
            prop_assert!(drift.turn_of(&direction) <= drift.turn());
        }
    }
}
