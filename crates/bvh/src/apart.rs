//! How far apart the points of two nodes are, in standard deviations, and their surfaces, in metres.
//!
//! This is the innermost loop of every search: plain arrays and loops, which compile to vectors.

use cloudtouch_geom::{BoxDrift, Drift, Matrix3, Motion, Point3, Vector3};
use wide::f64x4;

use crate::Obb;
use crate::bounds::SpreadBounds;
use crate::node::NodeData;

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

type Array = [f64; 3];

/// One number for each of three axes, and a spare one.
type Lanes = f64x4;

#[inline]
fn lanes(v: &Vector3) -> Lanes {
    f64x4::new([v.x, v.y, v.z, 0.0])
}

/// Σₖ scales\[k\] · of\[k\].
#[inline]
fn combined(scales: &Array, of: &[Lanes; 3]) -> Lanes {
    let scaled = |k: usize| f64x4::splat(scales[k]) * of[k];
    scaled(0) + scaled(1) + scaled(2)
}

/// Middle and axes of a box in another frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovedBox {
    centre: Array,
    /// The axes by coordinates.
    axes: [Lanes; 3],
}

impl MovedBox {
    pub(crate) fn new(obb: &Obb, motion: &Motion) -> Self {
        let axes = motion.rotation() * obb.axes;
        Self { centre: motion.point(&obb.centre).into(), axes: by_coordinates(&axes) }
    }

    fn axis(&self, k: usize) -> Array {
        self.axes.map(|coordinate| coordinate.as_array()[k])
    }
}

/// The rows of a matrix whose columns are axes.
#[inline]
fn by_coordinates(axes: &Matrix3) -> [Lanes; 3] {
    let row = |k: usize| f64x4::new([axes[(k, 0)], axes[(k, 1)], axes[(k, 2)], 0.0]);
    [row(0), row(1), row(2)]
}

/// What a drift does to a box, known once for all that it is tested against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried {
    drift: Drift,
    of_box: BoxDrift,
    /// The largest standard deviation and reach of what is in it, m.
    max_std: f64,
    max_reach: f64,
    along_own: Loss,
}

impl Carried {
    /// Of a box of B in the frame of A.
    pub(crate) fn new(b: &NodeData, moved: &MovedBox, drift: &Drift) -> Self {
        let own = [0, 1, 2].map(|k| moved.axis(k));
        let half_axes = Matrix3::from(own) * Matrix3::from_diagonal(&b.obb.half_extents);
        let SpreadBounds { max_std, max_reach, .. } = b.bounds;
        let around = b.bounds.shift + max_reach;
        let of_box = drift.of_box(&Point3::from(moved.centre), &half_axes, around);
        let none = Loss { room: Lanes::ZERO, std: Lanes::ZERO, reach: Lanes::ZERO };
        let mut carried = Self { drift: *drift, of_box, max_std, max_reach, along_own: none };
        carried.along_own = carried.along(&own);
        carried
    }

    /// Along unit vectors in the frame of A.
    #[inline]
    fn along(&self, axes: &[Array; 3]) -> Loss {
        let [mut room, mut std, mut reach] = [[0.0; 4]; 3];
        for (k, axis) in axes.iter().enumerate() {
            let axis = Vector3::from(*axis);
            let turn = self.drift.turn_of(&axis);
            room[k] = self.of_box.along(&axis);
            std[k] = turn * self.max_std;
            reach[k] = turn * self.max_reach;
        }
        Loss { room: f64x4::new(room), std: f64x4::new(std), reach: f64x4::new(reach) }
    }
}

/// What a drift of the second box takes off gaps and adds to spreads along three axes.
#[derive(Debug, Clone, Copy)]
struct Loss {
    /// How far the box gets along each axis, m.
    room: Lanes,
    /// What its turn adds to its deviations there, and to its reach, m.
    std: Lanes,
    reach: Lanes,
}

/// What two boxes are tested by: the second in the frame of the first.
pub(crate) struct Between<'a> {
    a: &'a NodeData,
    b: &'a NodeData,
    moved: &'a MovedBox,
    /// Middle to middle, in the frame of A, and along the axes of A.
    way: Array,
    offset: Lanes,
    /// aᵢ·bⱼ by j.
    cosines: [Lanes; 3],
    /// What is to be taken off every gap, m.
    slack: f64,
}

impl<'a> Between<'a> {
    /// `rounding` is what the pose may misplace a box by, m.
    #[inline(always)]
    pub(crate) fn new(
        a: &'a NodeData,
        (b, moved): (&'a NodeData, &'a MovedBox),
        rounding: f64,
    ) -> Self {
        let of_a = by_coordinates(&a.obb.axes);
        let centre = &a.obb.centre;
        let way =
            [moved.centre[0] - centre.x, moved.centre[1] - centre.y, moved.centre[2] - centre.z];
        let cosine = |k| combined(&moved.axis(k), &of_a);
        let cosines = [cosine(0), cosine(1), cosine(2)];
        let offset = combined(&way, &of_a);
        let [x, y, z, _] = offset.to_array();
        let size =
            a.obb.half_extents.sum() + b.obb.half_extents.sum() + x.abs() + y.abs() + z.abs();
        let slack = a.bounds.shift + b.bounds.shift + rounding + 8.0 * f64::EPSILON * size;
        Self { a, b, moved, way, offset, cosines, slack }
    }

    /// Bounds by the six normals of faces; B may drift from where it is. Those of A alone are looked at
    /// where these say `enough` by themselves: of deviations, and of the gap of surfaces.
    #[inline(always)]
    pub(crate) fn by_faces(
        &self,
        margin: f64,
        carried: Option<&Carried>,
        enough: (f64, f64),
    ) -> Apart {
        match carried {
            None => self.by_faces_less(None, margin, enough),
            Some(carried) => self.by_faces_of_drifting(carried, margin, enough),
        }
    }

    /// Apart from the loop of a search at rest, which stays short.
    #[inline(never)]
    fn by_faces_of_drifting(&self, carried: &Carried, margin: f64, enough: (f64, f64)) -> Apart {
        let along_a = carried.along(self.a.obb.axes.as_ref());
        self.by_faces_less(Some([along_a, carried.along_own]), margin, enough)
    }

    #[inline(always)]
    fn by_faces_less(
        &self,
        losses: Option<[Loss; 2]>,
        margin: f64,
        (deviations, surfaces): (f64, f64),
    ) -> Apart {
        let (a, b) = (self.a, self.b);
        let mut apart =
            Apart { deviations: 0.0, points: f64::NEG_INFINITY, surfaces: f64::NEG_INFINITY };
        let [loss_along_a, loss_along_b] =
            losses.as_ref().map_or([None; 2], |[of_a, of_b]| [Some(of_a), Some(of_b)]);
        // Only B drifts.
        let gaps = (self.offset, &self.cosines, self.slack);
        raise_along(a, b, gaps, (None, loss_along_a), margin, &mut apart);
        let is_enough = apart.surfaces >= surfaces
            && apart.deviations >= deviations * deviations * (1.0 + 4.0 * f64::EPSILON);
        if !is_enough {
            let [x, y, z] = self.cosines.map(f64x4::to_array);
            let cosine = |k: usize| f64x4::new([x[k], y[k], z[k], 0.0]);
            let cosines = [cosine(0), cosine(1), cosine(2)];
            let gaps = (combined(&self.way, &self.moved.axes), &cosines, self.slack);
            raise_along(b, a, gaps, (loss_along_b, None), margin, &mut apart);
        }
        apart.deviations = apart.deviations.sqrt();
        apart
    }

    /// Whether the boxes of the surfaces are apart along one of the nine directions across an edge of
    /// each.
    pub(crate) fn edges_part_surfaces(&self) -> bool {
        let by_b = self.cosines.map(f64x4::to_array);
        let r = [0, 1, 2].map(|i| [by_b[0][i], by_b[1][i], by_b[2][i]]);
        let t = self.offset.to_array();
        let surface = |node: &NodeData| Array::from(node.obb.half_extents + node.bounds.axis_reach);
        let (half_a, half_b) = (surface(self.a), surface(self.b));
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                // eᵢ × rⱼ has the components −r[i2] at i1 and r[i1] at i2.
                let squared_sine = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
                let distance = (t[i2] * r[i1][j] - t[i1] * r[i2][j]).abs();
                let reach = half_a[i1] * r[i2][j].abs()
                    + half_a[i2] * r[i1][j].abs()
                    + half_b[j1] * r[i][j2].abs()
                    + half_b[j2] * r[i][j1].abs();
                // The direction is as long as the sine, at most one: the slack counts for more.
                if squared_sine >= PARALLEL && distance - reach >= self.slack {
                    return true;
                }
            }
        }
        false
    }
}

/// Raises bounds by the three axes of a node, given the way to the middle of the other along each, the
/// cosines of its axes by the axes of the other, and what is to be taken off every gap; the deviations are
/// squared.
#[inline(always)]
fn raise_along(
    own: &NodeData,
    other: &NodeData,
    (offset, cosines, slack): (Lanes, &[Lanes; 3], f64),
    (own_loss, other_loss): (Option<&Loss>, Option<&Loss>),
    margin: f64,
    apart: &mut Apart,
) {
    let sizes = cosines.map(f64x4::abs);
    let along = |v: &Vector3| combined(v.as_ref(), &sizes);
    let (bounds, of_other) = (&own.bounds, &other.bounds);
    let mut room = f64x4::splat(slack);
    let mut reach = lanes(&bounds.axis_reach) + along(&of_other.axis_reach);
    let mut own_std = lanes(&bounds.axis_std);
    let mut std = along(&of_other.axis_std);
    if let Some(loss) = own_loss {
        (room, reach, own_std) = (room + loss.room, reach + loss.reach, own_std + loss.std);
    }
    if let Some(loss) = other_loss {
        (room, reach, std) = (room + loss.room, reach + loss.reach, std + loss.std);
    }
    let std = std.fast_min(f64x4::splat(of_other.max_std));
    let points =
        offset.abs() - lanes(&own.obb.half_extents) - along(&other.obb.half_extents) - room;
    let surfaces = points - reach;
    let beyond = (points - f64x4::splat(margin)).fast_max(f64x4::ZERO);
    let squared = beyond * beyond / (own_std * own_std + std * std);
    let (squared, points, surfaces) = (squared.as_array(), points.as_array(), surfaces.as_array());
    for k in 0..3 {
        // Nothing over nothing, of exact points that touch, is no bound: `max` passes over NaN.
        apart.deviations = apart.deviations.max(squared[k]);
        apart.points = apart.points.max(points[k]);
        apart.surfaces = apart.surfaces.max(surfaces[k]);
    }
}

/// Below this sine² two edges count as parallel: their cross product is mostly rounding. Leaving a
/// direction out can only make boxes overlap, which is the safe side.
const PARALLEL: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Pose, UncertainPoint, seed};
    use proptest::prelude::*;

    use super::*;
    use crate::{Primitive, Tree, TreeSettings};

    fn tree(stream: u64, std: f64) -> Tree {
        let point = |i: u64| {
            let draw = |k| seed::unit(seed::derive(stream, i, k)) - 0.5;
            let mean = Point3::new(draw(0), 0.3 * draw(1), 0.02 * draw(2));
            let covariance = Covariance::diagonal([std * std, 4.0 * std * std, 0.1 * std * std]);
            Primitive::point(UncertainPoint { mean, covariance })
        };
        Tree::build((0..40).map(point).collect(), &TreeSettings::default()).unwrap()
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
            let [a, b] = [&a, &b].map(|tree| &tree.nodes[tree.root.unwrap() as usize]);
            let moved = MovedBox::new(&b.obb, &Motion::from(&pose));
            let between = Between::new(a, (b, &moved), 0.0);
            let early = between.by_faces(margin, None, enough);
            let full = between.by_faces(margin, None, (f64::INFINITY, f64::INFINITY));
            prop_assert!(early.deviations <= full.deviations && early.surfaces <= full.surfaces);
            let is_all = early.deviations == full.deviations
                && early.points == full.points
                && early.surfaces == full.surfaces;
            prop_assert!(is_all || early.deviations >= enough.0 && early.surfaces >= enough.1);
        }
    }
}
