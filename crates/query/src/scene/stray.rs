//! Bodies that lie far from all others: farther than large, they are told; so far that their pose or a unit
//! cannot be meant, nothing about them is believed.

use cloudtouch_geom::{Point3, Pose};

use crate::placement::moved;
use crate::shape::Shape;

type Corners = [Point3; 2];

/// Where a body lies beside the box around all others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beside {
    /// Between the two boxes, m; none where a body is alone: nothing is infinitely large the wrong way round.
    pub gap_m: f64,
    /// Diagonal of the larger box, m.
    pub size_m: f64,
}

impl Beside {
    /// Whether it is farther off than either is large. Most bodies of a scene are that far from most others,
    /// which is no sign of a slip; from all it is.
    pub(super) fn is_outside(&self) -> bool {
        self.size_m > 0.0 && self.gap_m > self.size_m
    }

    /// Whether its pose or a unit cannot be meant.
    pub(super) fn is_astray(&self) -> bool {
        self.size_m > 0.0 && self.gap_m > FARTHEST_SIZES * self.size_m
    }
}

/// For each body where it lies beside all others.
pub(super) fn beside_others(bodies: &[(Shape<'_>, Pose)]) -> Vec<Beside> {
    let boxes: Vec<Corners> = bodies.iter().map(|(shape, pose)| in_scene(*shape, pose)).collect();
    let nothing = [Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3])];
    // What is before each, and what is after it.
    let before = |around: &mut Corners, own: &Corners| {
        let so_far = *around;
        *around = union(around, own);
        Some(so_far)
    };
    let first: Vec<Corners> = boxes.iter().scan(nothing, before).collect();
    let mut last: Vec<Corners> = boxes.iter().rev().scan(nothing, before).collect();
    last.reverse();
    let others = first.iter().zip(&last).map(|(before, after)| union(before, after));
    boxes.iter().zip(others).map(|(own, others)| beside(own, &others)).collect()
}

fn in_scene(shape: Shape<'_>, pose: &Pose) -> Corners {
    moved(shape.corners(), &pose.after(&Pose::from_translation(shape.origin())))
}

fn union([low, high]: &Corners, [other_low, other_high]: &Corners) -> Corners {
    [
        Point3::from(low.coords.inf(&other_low.coords)),
        Point3::from(high.coords.sup(&other_high.coords)),
    ]
}

/// No body is so many sizes away from all others: farther than an object from its scene, for a robot may have
/// driven off.
const FARTHEST_SIZES: f64 = 100.0;

fn beside([low, high]: &Corners, [other_low, other_high]: &Corners) -> Beside {
    let apart = (other_low - high).sup(&(low - other_high)).map(|along| along.max(0.0)).norm();
    Beside { gap_m: apart, size_m: (high - low).norm().max((other_high - other_low).norm()) }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use cloudtouch_testkit::scene::cuboid;

    use super::*;
    use crate::mesh::Mesh;

    #[test]
    fn a_body_far_from_all_others_is_astray_and_none_among_many() {
        let cube = Mesh::prepare(&cuboid([0.1; 3])).unwrap();
        let at = |x: f64| (Shape::Mesh(&cube), Pose::from_translation(Vector3::new(x, 0.0, 0.0)));
        let strays = |bodies: &[_]| -> Vec<bool> {
            beside_others(bodies).iter().map(Beside::is_astray).collect()
        };
        assert_eq!(strays(&[at(0.0)]), [false]);
        assert_eq!(strays(&[at(0.0), at(17.0)]), [false; 2]);
        assert_eq!(strays(&[at(0.0), at(18.0)]), [true; 2]);
        // Beside a third the first two are a scene of 18 m.
        assert_eq!(strays(&[at(0.0), at(18.0), at(900.0)]), [false; 3]);
        assert_eq!(strays(&[at(0.0), at(1.0), at(900.0)]), [false, false, true]);
        assert_eq!(strays(&[]), [false; 0]);
    }

    #[test]
    fn a_body_is_outside_where_it_is_farther_off_than_either_is_large() {
        let cube = Mesh::prepare(&cuboid([0.1; 3])).unwrap();
        let at = |x: f64| (Shape::Mesh(&cube), Pose::from_translation(Vector3::new(x, 0.0, 0.0)));
        let outside = |bodies: &[_]| -> Vec<bool> {
            beside_others(bodies).iter().map(Beside::is_outside).collect()
        };
        assert_eq!(outside(&[at(0.0)]), [false]);
        assert_eq!(outside(&[at(0.0), at(0.27)]), [false; 2]);
        assert_eq!(outside(&[at(0.0), at(0.28)]), [true; 2]);
        assert_eq!(outside(&[at(0.0), at(0.5), at(1.3)]), [false, false, true]);
    }
}
