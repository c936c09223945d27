//! One leg of a path: a shift and a turn at constant speed.

use cloudtouch_geom::{Drift, Point3, Pose, Vector3};
use nalgebra::UnitQuaternion;

/// A turn about a pivot that is itself shifted, all in the file frame of A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    from: Pose,
    to: Pose,
    /// Where the pivot is at the beginning, and its whole way, m.
    pivot: Point3,
    shift: Vector3,
    /// The whole turn, radians about its own direction.
    turn: Vector3,
}

/// Turns of less than this have no axis to speak of, rad.
const NO_TURN: f64 = 1e-9;
/// So near to half a turn, rad, one that is written with few digits may go either way round.
const HALF_TURN_ROUNDING: f64 = 0.01;

impl Leg {
    /// The origin of B along a straight line, its turn by slerp.
    pub(super) fn linear(from: Pose, to: Pose) -> Self {
        let shift = to.translation() - from.translation();
        Self { from, to, pivot: from.translation().into(), shift, turn: turn_of(&from, &to) }
    }

    /// About one axis and along it.
    pub(super) fn screw(from: Pose, to: Pose) -> Self {
        let turn = turn_of(&from, &to);
        let angle = turn.norm();
        if angle < NO_TURN {
            return Self::linear(from, to);
        }
        let axis = turn / angle;
        let way = to.translation() - from.translation();
        let shift = axis * way.dot(&axis);
        let across = way - shift;
        // The axis passes where the way across is the chord of the turn.
        let aside = 0.5 * (across + axis.cross(&across) / (0.5 * angle).tan());
        Self { from, to, pivot: (from.translation() + aside).into(), shift, turn }
    }

    /// Whether rounding decides which way round it turns.
    pub(super) fn is_half_turn(&self) -> bool {
        self.turn.norm() > std::f64::consts::PI - HALF_TURN_ROUNDING
    }

    /// The pose at a time from 0 to 1; at the ends to the bit.
    pub(super) fn at(&self, time: f64) -> Pose {
        if time <= 0.0 {
            return self.from;
        }
        if time >= 1.0 {
            return self.to;
        }
        let turn = UnitQuaternion::new(self.turn * time);
        let arm = self.from.translation() - self.pivot.coords;
        let origin = self.pivot.coords + self.shift * time + turn * arm;
        Pose::from_translation_rotation(origin, turn * self.from.rotation())
    }

    /// How B drifts about the middle of a stretch, in a frame of A with its origin there.
    pub(super) fn drift(&self, [from, to]: [f64; 2], origin: &Vector3) -> Drift {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pivot = self.pivot + self.shift * middle - origin;
        Drift::new(pivot, self.shift * half, self.turn * half)
    }

    pub(super) fn is_still(&self) -> bool {
        self.from == self.to
    }
}

fn turn_of(from: &Pose, to: &Pose) -> Vector3 {
    (to.rotation() * from.rotation().inverse()).scaled_axis()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn pose() -> impl Strategy<Value = Pose> {
        let numbers = prop::array::uniform3(-3.0..3.0_f64);
        (numbers.clone(), numbers)
            .prop_map(|(offset, rpy)| Pose::from_translation_rpy(Vector3::from(offset), rpy))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_leg_ends_where_it_should_and_its_drift_holds_on_the_way(
            (from, to) in (pose(), pose()), is_screw in any::<bool>(),
            stretch in prop::array::uniform2(0.0..1.0_f64), s in -1.0..1.0_f64,
            place in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let leg = if is_screw { Leg::screw(from, to) } else { Leg::linear(from, to) };
            let place = Point3::from(place);
            let near_end = leg.at(1.0 - 1e-12).transform_point(&place);
            prop_assert!((near_end - to.transform_point(&place)).norm() < 1e-9);
            let near_start = leg.at(1e-12).transform_point(&place);
            prop_assert!((near_start - from.transform_point(&place)).norm() < 1e-9);
            let stretch = [stretch[0].min(stretch[1]), stretch[0].max(stretch[1])];
            let (middle, half) = (0.5 * (stretch[0] + stretch[1]), 0.5 * (stretch[1] - stretch[0]));
            let origin = Vector3::new(0.3, -2.0, 1.0);
            let drift = leg.drift(stretch, &origin);
            let at = |time: f64| leg.at(time).transform_point(&place) - origin;
            let (home, away) = (at(middle), at(middle + s * half));
            let by = away - home;
            let rest = (by - drift.first_order(&home) * s).norm();
            prop_assert!(rest <= drift.beyond_first_order(&home, 0.0) + 1e-9);
        }

        #[test]
        fn a_screw_keeps_its_axis_where_it_is(
            (from, to) in (pose(), pose()), time in 0.0..1.0_f64,
        ) {
            let leg = Leg::screw(from, to);
            let on_axis = leg.at(0.0).inverse().transform_point(&leg.pivot);
            let axis = leg.turn.normalize();
            prop_assume!(leg.turn.norm() > 1e-3);
            let moved = leg.at(time).transform_point(&on_axis) - leg.pivot;
            prop_assert!(moved.cross(&axis).norm() < 1e-9 * (1.0 + leg.pivot.coords.norm()));
        }
    }
}
