//! How far apart the points of two nodes are, in standard deviations, and their surfaces, in metres.
//!
//! This is the innermost loop of every search: plain arrays and loops, which compile to vectors.

use cloudtouch_geom::{Drift, Matrix3, Motion, Point3, Vector3};

use crate::Obb;
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

/// Middle and axes of a box in another frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovedBox {
    centre: Array,
    axes: [Array; 3],
}

impl MovedBox {
    pub(crate) fn new(obb: &Obb, motion: &Motion) -> Self {
        let axes = motion.rotation() * obb.axes;
        Self { centre: motion.point(&obb.centre).into(), axes: axes.into() }
    }

    fn axis(&self, k: usize) -> Vector3 {
        Vector3::from(self.axes[k])
    }
}

/// What a drift takes off gaps and adds to spreads along an axis.
#[derive(Debug, Clone, Copy, Default)]
struct Loss {
    /// How far the second box gets along the axis, m.
    room: f64,
    /// What its turn adds to its deviations there, and to its reach, m.
    std: f64,
    reach: f64,
}

impl Loss {
    /// Along a unit vector in the frame of A.
    fn of(drift: &Drift, axis: &Vector3, (b, moved): (&NodeData, &MovedBox)) -> Self {
        let middle = Point3::from(moved.centre);
        let axes: Matrix3 = moved.axes.into();
        let half_axes = axes * Matrix3::from_diagonal(&b.obb.half_extents);
        let around = b.bounds.shift + b.bounds.max_reach;
        let turn = drift.turn_of(axis);
        Self {
            room: drift.along_of_box(axis, &middle, &half_axes, around),
            std: turn * b.bounds.max_std,
            reach: turn * b.bounds.max_reach,
        }
    }
}

#[inline]
fn dot(a: &Array, b: &Array) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The first box in the frame of the second and the other way round.
pub(crate) struct Between<'a> {
    a: &'a NodeData,
    b: &'a NodeData,
    /// aᵢ·bⱼ.
    cosines: [Array; 3],
    /// Middle to middle along the axes of A and of B.
    offset: [Array; 2],
    /// What is to be taken off every gap, m.
    slack: f64,
    /// What a drift of B does along the axes of A and of B; `None` where it keeps still.
    losses: Option<[[Loss; 3]; 2]>,
}

impl<'a> Between<'a> {
    /// `rounding` is what the pose may misplace a box by, m; B may drift from where it is.
    #[inline]
    pub(crate) fn new(
        a: &'a NodeData,
        (b, moved): (&'a NodeData, &MovedBox),
        rounding: f64,
        drift: Option<&Drift>,
    ) -> Self {
        let axes: &[Array; 3] = a.obb.axes.as_ref();
        let centre = &a.obb.centre;
        let way =
            [moved.centre[0] - centre.x, moved.centre[1] - centre.y, moved.centre[2] - centre.z];
        let mut cosines = [[0.0; 3]; 3];
        let mut offset = [[0.0; 3]; 2];
        let mut size = a.obb.half_extents.sum() + b.obb.half_extents.sum();
        for i in 0..3 {
            for j in 0..3 {
                cosines[i][j] = dot(&axes[i], &moved.axes[j]);
            }
            offset[0][i] = dot(&axes[i], &way);
            offset[1][i] = dot(&moved.axes[i], &way);
            size += offset[0][i].abs();
        }
        let slack = a.bounds.shift + b.bounds.shift + rounding + 8.0 * f64::EPSILON * size;
        let losses = drift.map(|drift| {
            let of = |axis: Vector3| Loss::of(drift, &axis, (b, moved));
            let own = |k: usize| a.obb.axes.column(k).into_owned();
            [[own(0), own(1), own(2)].map(of), [0, 1, 2].map(|k| of(moved.axis(k)))]
        });
        Self { a, b, cosines, offset, slack, losses }
    }

    /// Bounds by the six normals of faces.
    #[inline]
    pub(crate) fn by_faces(&self, margin: f64) -> Apart {
        let c = &self.cosines;
        let turned = [0, 1, 2].map(|j| [c[0][j], c[1][j], c[2][j]]);
        let mut apart =
            Apart { deviations: 0.0, points: f64::NEG_INFINITY, surfaces: f64::NEG_INFINITY };
        let none = [Loss::default(); 3];
        let [of_a, of_b] = &self.losses.unwrap_or([none; 2]);
        self.along_axes((self.a, &none), (self.b, of_a), (&self.offset[0], c), margin, &mut apart);
        let (a, b) = ((self.a, &none), (self.b, of_b));
        self.along_axes(b, a, (&self.offset[1], &turned), margin, &mut apart);
        apart.deviations = apart.deviations.sqrt();
        apart
    }

    /// Raises the bounds by the three axes of a node; its deviations are squared. Of the two losses one
    /// is none.
    #[inline]
    fn along_axes(
        &self,
        (own, own_loss): (&NodeData, &[Loss; 3]),
        (other, other_loss): (&NodeData, &[Loss; 3]),
        (offset, cosines): (&Array, &[Array; 3]),
        margin: f64,
        apart: &mut Apart,
    ) {
        for k in 0..3 {
            let [x, y, z] = [cosines[k][0].abs(), cosines[k][1].abs(), cosines[k][2].abs()];
            let along = |v: &Vector3| x * v.x + y * v.y + z * v.z;
            let (own_loss, other_loss) = (&own_loss[k], &other_loss[k]);
            let points = offset[k].abs()
                - own.obb.half_extents[k]
                - along(&other.obb.half_extents)
                - (self.slack + own_loss.room + other_loss.room);
            let reach = own.bounds.axis_reach[k]
                + along(&other.bounds.axis_reach)
                + (own_loss.reach + other_loss.reach);
            let own_std = own.bounds.axis_std[k] + own_loss.std;
            let std = (along(&other.bounds.axis_std) + other_loss.std).min(other.bounds.max_std);
            let variance = own_std * own_std + std * std;
            let positive = (points - margin).max(0.0);
            // Nothing over nothing, of exact points that touch, is no bound: `max` passes over NaN.
            apart.deviations = apart.deviations.max(positive * positive / variance);
            apart.points = apart.points.max(points);
            apart.surfaces = apart.surfaces.max(points - reach);
        }
    }

    /// Whether the boxes of the surfaces are apart along one of the nine directions across an edge of
    /// each.
    pub(crate) fn edges_part_surfaces(&self) -> bool {
        if self.losses.is_some() {
            // What a drift does across two edges is not known: not to tell is the safe side.
            return false;
        }
        let (r, t) = (&self.cosines, &self.offset[0]);
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

/// Below this sine² two edges count as parallel: their cross product is mostly rounding. Leaving a
/// direction out can only make boxes overlap, which is the safe side.
const PARALLEL: f64 = 1e-12;
