//! Bodies that lie far from all others: farther than large, they are told; so far that their pose or a unit
//! cannot be meant, nothing about them is believed.

use cloudtouch_geom::{Point3, Pose};

use crate::placement::{gap, moved};
use crate::shape::Shape;

type Corners = [Point3; 2];

/// Where a body lies beside the rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Beside {
    /// Between its half and the other, m; none where that is not more than either is large.
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

    /// That of two which is farther for its size.
    fn farther(self, other: Self) -> Self {
        let is_farther = other.gap_m * self.size_m > self.gap_m * other.size_m;
        if is_farther || self.size_m == 0.0 { other } else { self }
    }

    /// Whether its pose or a unit cannot be meant.
    pub(super) fn is_astray(&self) -> bool {
        self.size_m > 0.0 && self.gap_m > FARTHEST_SIZES * self.size_m
    }
}

/// For each body where it lies beside the rest: of all ways to part the boxes by a plane across an axis, the one
/// whose halves are farthest apart for their size, and of these the smaller half. What a slip has put elsewhere
/// may be several bodies, such as a hand with what it holds.
pub(super) fn beside_others(bodies: &[(Shape<'_>, Pose)]) -> Vec<Beside> {
    let boxes: Vec<Corners> = bodies.iter().map(|(shape, pose)| in_scene(*shape, pose)).collect();
    let mut found = vec![Beside { gap_m: 0.0, size_m: 0.0 }; boxes.len()];
    for axis in 0..3 {
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_by(|&p, &q| boxes[p][0][axis].total_cmp(&boxes[q][0][axis]));
        let around = |order: &mut dyn Iterator<Item = &usize>| -> Vec<Corners> {
            let all = order.scan(NOTHING, |so_far, &k| {
                *so_far = union(so_far, &boxes[k]);
                Some(*so_far)
            });
            all.collect()
        };
        let (first, mut last) = (around(&mut order.iter()), around(&mut order.iter().rev()));
        last.reverse();
        for cut in 1..boxes.len() {
            let (one, other) = (first[cut - 1], last[cut]);
            let [size, other_size] = [one, other].map(|corners| diagonal(&corners));
            let beside = Beside { gap_m: gap(&one, &other), size_m: size.max(other_size) };
            if !beside.is_outside() {
                continue;
            }
            let mut tell = |half: &[usize]| {
                for &k in half {
                    found[k] = found[k].farther(beside);
                }
            };
            if size <= ALIKE * other_size {
                tell(&order[..cut]);
            }
            if other_size <= ALIKE * size {
                tell(&order[cut..]);
            }
        }
    }
    found
}

const NOTHING: Corners = [
    Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
    Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
];

fn diagonal([low, high]: &Corners) -> f64 {
    (high - low).norm()
}

/// The box of a body along the axes of the scene, m; never too small.
pub(super) fn in_scene(shape: Shape<'_>, pose: &Pose) -> Corners {
    moved(shape.corners(), &pose.after(&Pose::from_translation(shape.origin())))
}

fn union([low, high]: &Corners, [other_low, other_high]: &Corners) -> Corners {
    [
        Point3::from(low.coords.inf(&other_low.coords)),
        Point3::from(high.coords.sup(&other_high.coords)),
    ]
}

/// Boxes up to so much larger are as large, up to the rounding of far places: both halves are told.
const ALIKE: f64 = 1.0 + 1e-6;

/// No body is so many sizes away from all others: farther than an object from its scene, for a robot may have
/// driven off.
const FARTHEST_SIZES: f64 = 100.0;

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
        // What holds another does not hide it: a hand and its cup, in millimetres.
        assert_eq!(strays(&[at(0.0), at(1.0), at(900.0), at(900.1)]), [false, false, true, true]);
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
        assert_eq!(outside(&[at(0.0), at(0.5), at(5.0), at(5.2)]), [false, false, true, true]);
    }
}
