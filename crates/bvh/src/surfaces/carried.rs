//! What a drift of the second of two bodies does to a box of it.

use cloudtouch_geom::{BoxDrift, Drift, Matrix3, Point3, Vector3};

use crate::surfaces::placed::{Array, MovedBox};
use crate::tree::bounds::SpreadBounds;
use crate::tree::node::NodeData;

/// What a drift does to a box, known once for all that it is tested against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Carried {
    drift: Drift,
    of_box: BoxDrift,
    /// The largest standard deviation and reach of what is in it, m.
    max_std: f64,
    max_reach: f64,
    /// Along the axes of the box.
    pub(crate) along_own: Loss,
}

impl Carried {
    /// Of a box of B in the frame of A.
    pub(crate) fn new(b: &NodeData, moved: &MovedBox, drift: &Drift) -> Self {
        let half_axes = Matrix3::from(moved.axes) * Matrix3::from_diagonal(&b.obb.half_extents());
        let SpreadBounds { max_std, max_reach, shift, .. } = b.bounds.unpacked();
        let around = shift + max_reach;
        let of_box = drift.of_box(&Point3::from(moved.centre), &half_axes, around);
        let none = Loss { room: [0.0; 3], std: [0.0; 3], reach: [0.0; 3] };
        let mut carried = Self { drift: *drift, of_box, max_std, max_reach, along_own: none };
        carried.along_own = carried.along(&moved.axes);
        carried
    }

    /// Along unit vectors in the frame of A.
    #[inline]
    pub(crate) fn along(&self, axes: &[Array; 3]) -> Loss {
        let [mut room, mut std, mut reach] = [[0.0; 3]; 3];
        for (k, axis) in axes.iter().enumerate() {
            let axis = Vector3::from(*axis);
            let turn = self.drift.turn_of(&axis);
            room[k] = self.of_box.along(&axis);
            std[k] = turn * self.max_std;
            reach[k] = turn * self.max_reach;
        }
        Loss { room, std, reach }
    }
}

/// What a drift of the second box takes off gaps and adds to spreads along three axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Loss {
    /// How far the box gets along each axis, m.
    pub(crate) room: Array,
    /// What its turn adds to its deviations there, and to its reach, m.
    pub(crate) std: Array,
    pub(crate) reach: Array,
}
