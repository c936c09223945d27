//! Bodies that lie so far from all others that their pose or a unit cannot be meant.

use cloudtouch_geom::{Point3, Pose};

use crate::placement::moved;
use crate::shape::Shape;

type Corners = [Point3; 2];

/// For each body whether it is farther from the box around all others than a hundred times the size of
/// either. Most bodies of a scene are far from most others, which is no sign of a slip; from all it is.
pub(super) fn strays(bodies: &[(Shape<'_>, Pose)]) -> Vec<bool> {
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
    boxes.iter().zip(others).map(|(own, others)| is_astray(own, &others)).collect()
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

/// A body alone is not: nothing is infinitely large the wrong way round.
fn is_astray([low, high]: &Corners, [other_low, other_high]: &Corners) -> bool {
    let apart = (other_low - high).sup(&(low - other_high)).map(|along| along.max(0.0)).norm();
    let larger = (high - low).norm().max((other_high - other_low).norm());
    larger > 0.0 && apart > FARTHEST_SIZES * larger
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
        assert_eq!(strays(&[at(0.0)]), [false]);
        assert_eq!(strays(&[at(0.0), at(17.0)]), [false; 2]);
        assert_eq!(strays(&[at(0.0), at(18.0)]), [true; 2]);
        // Beside a third the first two are a scene of 18 m.
        assert_eq!(strays(&[at(0.0), at(18.0), at(900.0)]), [false; 3]);
        assert_eq!(strays(&[at(0.0), at(1.0), at(900.0)]), [false, false, true]);
        assert_eq!(strays(&[]), [false; 0]);
    }
}
