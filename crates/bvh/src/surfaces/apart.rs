//! How far apart the points of two nodes are, in standard deviations, and their surfaces, in metres.
//!
//! This is the innermost loop of every search. A node that is split has two halves, and both are tested
//! at once: each number of a test stands for one of them in either lane.

use wide::f64x2;

use crate::surfaces::carried::{Carried, Loss};
use crate::surfaces::placed::{Array, Placed};
use crate::tree::node::NodeData;

/// What the normals of the faces of two boxes say of what is in them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Apart {
    /// The Mahalanobis distance between a point of either, less a margin, is at least this; 0 where boxes
    /// are not beyond it.
    pub(crate) deviations: f64,
    /// The boxes of the points are at least so far apart, m; negative in overlap.
    pub(crate) points: f64,
    /// The same for the surfaces that these stand for.
    pub(crate) surfaces: f64,
}

/// One number for each of two tests, and three of these.
type Two = f64x2;
type Each = [Two; 3];

#[inline(always)]
fn dot(p: &Each, q: &Each) -> Two {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

#[inline(always)]
fn side_by_side(of: [&Array; 2]) -> Each {
    let lanes = |k: usize| Two::new([of[0][k], of[1][k]]);
    [lanes(0), lanes(1), lanes(2)]
}

/// What a drift takes off gaps and adds to spreads in two tests.
struct Losses {
    room: Each,
    std: Each,
    reach: Each,
}

impl Losses {
    fn of([one, other]: [Loss; 2]) -> Self {
        Self {
            room: side_by_side([&one.room, &other.room]),
            std: side_by_side([&one.std, &other.std]),
            reach: side_by_side([&one.reach, &other.reach]),
        }
    }
}

/// What two tests are by: the boxes of the first tree, or those of the second.
struct Boxes {
    centre: Each,
    axes: [Each; 3],
    half: Each,
    std: Each,
    reach: Each,
    max_std: Two,
    shift: Two,
}

impl Boxes {
    /// Where they were built.
    #[inline(always)]
    fn at_home([one, other]: [&NodeData; 2]) -> Self {
        let centre = [one, other].map(|node| node.obb.centre.coords.as_ref());
        let [p, q]: [&[Array; 3]; 2] = [one.obb.axes.as_ref(), other.obb.axes.as_ref()];
        let axis = |k: usize| side_by_side([&p[k], &q[k]]);
        Self::of([one, other], side_by_side(centre), [axis(0), axis(1), axis(2)])
    }

    #[inline(always)]
    fn moved([one, other]: [Placed<'_>; 2]) -> Self {
        let axis = |k: usize| side_by_side([&one.axes[k], &other.axes[k]]);
        let centre = side_by_side([one.centre, other.centre]);
        Self::of([one.node, other.node], centre, [axis(0), axis(1), axis(2)])
    }

    #[inline(always)]
    fn of(nodes: [&NodeData; 2], centre: Each, axes: [Each; 3]) -> Self {
        let fours = |of: fn(&NodeData) -> [f32; 4]| {
            let [p, q] = nodes.map(|node| of(node).map(f64::from));
            [0, 1, 2, 3].map(|k| Two::new([p[k], q[k]]))
        };
        let [hx, hy, hz, _] = fours(|node| node.obb.half_extents);
        let [sx, sy, sz, max_std] = fours(|node| node.bounds.std);
        let [rx, ry, rz, _] = fours(|node| node.bounds.reach);
        let [one, other] = nodes;
        Self {
            centre,
            axes,
            half: [hx, hy, hz],
            std: [sx, sy, sz],
            reach: [rx, ry, rz],
            max_std,
            shift: Two::new([one.bounds.shift(), other.bounds.shift()]),
        }
    }
}

/// What is asked of a test.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked {
    /// How far apart points may be and still count as at one place, m.
    pub(crate) margin: f64,
    /// What the pose may misplace a box by, m.
    pub(crate) rounding: f64,
    /// Deviations, and a gap of surfaces, that are enough: where the faces of A say so much of both tests,
    /// those of B are not asked.
    pub(crate) enough: (f64, f64),
}

/// Bounds by the six normals of the faces of two boxes, in two tests at once; B may drift from where it is.
#[inline(always)]
pub(crate) fn by_faces(
    a: [&NodeData; 2],
    b: [Placed<'_>; 2],
    carried: Option<[&Carried; 2]>,
    asked: Asked,
) -> [Apart; 2] {
    match carried {
        None => by_faces_less(Boxes::at_home(a), Boxes::moved(b), None, asked),
        Some(carried) => by_faces_of_drifting(a, b, carried, asked),
    }
}

/// Apart from the loop of a search at rest, which stays short.
#[inline(never)]
fn by_faces_of_drifting(
    a: [&NodeData; 2],
    b: [Placed<'_>; 2],
    [one, other]: [&Carried; 2],
    asked: Asked,
) -> [Apart; 2] {
    let along_a =
        Losses::of([(one, a[0]), (other, a[1])].map(|(b, a)| b.along(&a.obb.axes.into())));
    let along_b = Losses::of([one.along_own, other.along_own]);
    by_faces_less(Boxes::at_home(a), Boxes::moved(b), Some([along_a, along_b]), asked)
}

#[inline(always)]
fn by_faces_less(a: Boxes, b: Boxes, losses: Option<[Losses; 2]>, asked: Asked) -> [Apart; 2] {
    let Asked { margin, rounding, enough: (deviations, surfaces) } = asked;
    let way = [b.centre[0] - a.centre[0], b.centre[1] - a.centre[1], b.centre[2] - a.centre[2]];
    let along = |axes: &[Each; 3]| [dot(&way, &axes[0]), dot(&way, &axes[1]), dot(&way, &axes[2])];
    // |aᵢ·bⱼ|, for the faces of A by j and for those of B by i.
    let size = |i: usize, j: usize| dot(&b.axes[j], &a.axes[i]).abs();
    let by_b = |i: usize| [size(i, 0), size(i, 1), size(i, 2)];
    let sizes = [by_b(0), by_b(1), by_b(2)];
    let offset = along(&a.axes);
    let slack = {
        let sum = |v: &Each| v[0] + v[1] + v[2];
        let of_way = offset[0].abs() + offset[1].abs() + offset[2].abs();
        let size = sum(&a.half) + sum(&b.half) + of_way;
        a.shift + b.shift + Two::splat(rounding) + Two::splat(8.0 * f64::EPSILON) * size
    };
    let [of_a, of_b] = losses.as_ref().map_or([None; 2], |[of_a, of_b]| [Some(of_a), Some(of_b)]);
    let mut found = Found {
        squared: Two::ZERO,
        points: Two::splat(f64::NEG_INFINITY),
        surfaces: Two::splat(f64::NEG_INFINITY),
    };
    // Only B drifts.
    found.raise_along((&a, &b), (&offset, &sizes, slack), (None, of_a), margin);
    let squared = deviations * deviations * (1.0 + 4.0 * f64::EPSILON);
    if !found.is_enough(squared, surfaces) {
        let by_a = |j: usize| [sizes[0][j], sizes[1][j], sizes[2][j]];
        let sizes = [by_a(0), by_a(1), by_a(2)];
        found.raise_along((&b, &a), (&along(&b.axes), &sizes, slack), (of_b, None), margin);
    }
    found.of_each()
}

/// What two tests found so far.
struct Found {
    /// The square of the deviations.
    squared: Two,
    points: Two,
    surfaces: Two,
}

impl Found {
    /// Raises bounds by the three axes of a box, given the way to the middle of the other along each, how much of
    /// its axes lies along those of the other, and what is to be taken off every gap.
    #[inline(always)]
    fn raise_along(
        &mut self,
        (own, other): (&Boxes, &Boxes),
        (offset, sizes, slack): (&Each, &[Each; 3], Two),
        (own_loss, other_loss): (Option<&Losses>, Option<&Losses>),
        margin: f64,
    ) {
        for k in 0..3 {
            let along = |v: &Each| dot(v, &sizes[k]);
            let mut room = slack;
            let mut reach = own.reach[k] + along(&other.reach);
            let (mut own_std, mut std) = (own.std[k], along(&other.std));
            if let Some(loss) = own_loss {
                (room, reach, own_std) =
                    (room + loss.room[k], reach + loss.reach[k], own_std + loss.std[k]);
            }
            if let Some(loss) = other_loss {
                (room, reach, std) =
                    (room + loss.room[k], reach + loss.reach[k], std + loss.std[k]);
            }
            let std = std.fast_min(other.max_std);
            let points = offset[k].abs() - own.half[k] - along(&other.half) - room;
            let beyond = (points - Two::splat(margin)).fast_max(Two::ZERO);
            let squared = beyond * beyond / (own_std * own_std + std * std);
            // Nothing over nothing, of exact points that touch, is no bound: NaN raises nothing.
            self.squared = squared.simd_gt(self.squared).bitselect(squared, self.squared);
            self.points = points.fast_max(self.points);
            self.surfaces = (points - reach).fast_max(self.surfaces);
        }
    }

    fn is_enough(&self, squared: f64, surfaces: f64) -> bool {
        let (found, gaps) = (self.squared.to_array(), self.surfaces.to_array());
        gaps[0] >= surfaces && gaps[1] >= surfaces && found[0] >= squared && found[1] >= squared
    }

    fn of_each(&self) -> [Apart; 2] {
        let (deviations, points, surfaces) =
            (self.squared.sqrt().to_array(), self.points.to_array(), self.surfaces.to_array());
        [0, 1].map(|k| Apart {
            deviations: deviations[k],
            points: points[k],
            surfaces: surfaces[k],
        })
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Motion, Point3, Pose, UncertainPoint, Vector3, seed};
    use proptest::prelude::*;

    use super::*;
    use crate::surfaces::placed::MovedBox;
    use crate::{Primitive, Tree, TreeSettings};

    fn tree(stream: u64, std: f64) -> Tree {
        let point = |i: u64| {
            let draw = |k| seed::unit(seed::derive(stream, i, k)) - 0.5;
            let mean = Point3::new(draw(0), 0.3 * draw(1), 0.02 * draw(2));
            let covariance = Covariance::diagonal([std * std, 4.0 * std * std, 0.1 * std * std]);
            Primitive::point(UncertainPoint { mean, covariance })
        };
        let settings = TreeSettings { max_leaf_points: 12, ..TreeSettings::default() };
        Tree::build((0..80).map(point).collect(), &settings).unwrap()
    }

    /// The root and its two halves.
    fn nodes(tree: &Tree) -> [&NodeData; 3] {
        let root = tree.root.unwrap();
        let [left, right] = tree.nodes[root as usize].children().unwrap();
        [root, left, right].map(|node| &tree.nodes[node as usize])
    }

    const ALL: (f64, f64) = (f64::INFINITY, f64::INFINITY);

    /// Normal by normal, as it is said.
    fn one_by_one(a: &NodeData, b: &NodeData, a_from_b: &Pose, margin: f64) -> Apart {
        let (home, moved) = (a.obb.unpacked(), b.obb.unpacked().transformed(a_from_b));
        let size = (moved.centre - home.centre).norm() + home.radius() + moved.radius();
        let mut apart =
            Apart { deviations: 0.0, points: f64::NEG_INFINITY, surfaces: f64::NEG_INFINITY };
        for normal in home.axes.column_iter().chain(moved.axes.column_iter()) {
            let n: Vector3 = normal.into();
            let points = n.dot(&(moved.centre - home.centre)).abs()
                - home.half_width_along(&n)
                - moved.half_width_along(&n)
                - 1e-14 * size;
            let spreads = [(a.bounds.unpacked(), home.axes), (b.bounds.unpacked(), moved.axes)];
            let [of_a, of_b] = spreads.map(|(bounds, axes)| bounds.std_along(&axes, &n));
            let reach = spreads.map(|(bounds, axes)| axes.tr_mul(&n).abs().dot(&bounds.axis_reach));
            let deviations = (points - margin).max(0.0) / of_a.hypot(of_b);
            apart.deviations = apart.deviations.max(deviations);
            apart.points = apart.points.max(points);
            apart.surfaces = apart.surfaces.max(points - reach[0] - reach[1]);
        }
        apart
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_test_ends_early_only_where_the_rest_could_not_matter(
            std in 0.001..0.05_f64,
            offset in prop::array::uniform3(-1.0..1.0_f64),
            angles in prop::array::uniform3(-3.1..3.1_f64),
            enough in (0.0..20.0_f64, -0.1..0.5_f64),
            margin in 0.0..0.05_f64,
        ) {
            let (a, b) = (tree(1, std), tree(2, std));
            let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
            let ([a, ..], [_, one, other]) = (nodes(&a), nodes(&b));
            let moved = [one, other].map(|b| MovedBox::new(&b.obb.unpacked(), &Motion::from(&pose)));
            let placed = [Placed::moved(one, &moved[0]), Placed::moved(other, &moved[1])];
            let ask = |enough| {
                by_faces([a; 2], placed, None, Asked { margin, rounding: 0.0, enough })
            };
            for (early, full) in ask(enough).into_iter().zip(ask(ALL)) {
                prop_assert!(early.deviations <= full.deviations && early.surfaces <= full.surfaces);
                let is_all = early.deviations == full.deviations
                    && early.points == full.points
                    && early.surfaces == full.surfaces;
                prop_assert!(
                    is_all || early.deviations >= enough.0 && early.surfaces >= enough.1
                );
            }
        }

        #[test]
        fn two_tests_at_once_are_those_of_each_by_all_normals(
            std in 0.001..0.05_f64,
            offset in prop::array::uniform3(-1.0..1.0_f64),
            angles in prop::array::uniform3(-3.1..3.1_f64),
            margin in 0.0..0.05_f64,
        ) {
            let (a, b) = (tree(1, std), tree(2, 0.3 * std));
            let pose = Pose::from_translation_rpy(Vector3::from(offset), angles);
            let ([root, one, other], [b, ..]) = (nodes(&a), nodes(&b));
            let moved = MovedBox::new(&b.obb.unpacked(), &Motion::from(&pose));
            let asked = Asked { margin, rounding: 0.0, enough: ALL };
            for halves in [[one, other], [other, root]] {
                let found = by_faces(halves, [Placed::moved(b, &moved); 2], None, asked);
                for (half, found) in halves.into_iter().zip(found) {
                    let known = one_by_one(half, b, &pose, margin);
                    prop_assert!((found.points - known.points).abs() < 1e-12);
                    prop_assert!((found.surfaces - known.surfaces).abs() < 1e-12);
                    let off = (found.deviations - known.deviations).abs();
                    prop_assert!(off < 1e-8 * (1.0 + known.deviations), "{off}");
                }
            }
        }
    }
}
