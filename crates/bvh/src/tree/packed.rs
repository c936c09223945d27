//! Boxes and bounds as nodes keep them: in single precision wherever that can be made the safe side.

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::Obb;
use crate::tree::bounds::SpreadBounds;

/// A box whose sides are rounded up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PackedObb {
    pub(crate) centre: Point3,
    pub(crate) axes: Matrix3,
    /// Half the sides and their squared sum, m and m².
    pub(crate) half_extents: [f32; 4],
}

impl PackedObb {
    pub(crate) fn unpacked(&self) -> Obb {
        Obb { centre: self.centre, axes: self.axes, half_extents: self.half_extents() }
    }

    /// The square of half the diagonal, m²: which of two boxes is the larger.
    pub(crate) fn squared_radius(&self) -> f32 {
        self.half_extents[3]
    }

    #[inline]
    pub(crate) fn half_extents(&self) -> Vector3 {
        let [x, y, z, _] = self.half_extents.map(f64::from);
        Vector3::new(x, y, z)
    }
}

impl From<&Obb> for PackedObb {
    fn from(obb: &Obb) -> Self {
        let Obb { centre, axes, half_extents } = *obb;
        let [x, y, z] = up(&half_extents);
        Self { centre, axes, half_extents: [x, y, z, x * x + y * y + z * z] }
    }
}

/// Bounds that are rounded up, in fours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PackedBounds {
    /// Along the axes and the largest, m.
    pub(crate) std: [f32; 4],
    /// The same.
    pub(crate) reach: [f32; 4],
    shift: f32,
}

impl PackedBounds {
    pub(crate) const NONE: Self = Self { std: [0.0; 4], reach: [0.0; 4], shift: 0.0 };

    pub(crate) fn shift(&self) -> f64 {
        self.shift.into()
    }

    pub(crate) fn unpacked(&self) -> SpreadBounds {
        let [x, y, z, max_std] = self.std.map(f64::from);
        let axis_std = Vector3::new(x, y, z);
        let [x, y, z, max_reach] = self.reach.map(f64::from);
        let axis_reach = Vector3::new(x, y, z);
        SpreadBounds { max_std, axis_std, shift: self.shift.into(), max_reach, axis_reach }
    }
}

impl From<&SpreadBounds> for PackedBounds {
    fn from(bounds: &SpreadBounds) -> Self {
        let four = |[x, y, z]: [f32; 3], most| [x, y, z, at_least(most)];
        Self {
            std: four(up(&bounds.axis_std), bounds.max_std),
            reach: four(up(&bounds.axis_reach), bounds.max_reach),
            shift: at_least(bounds.shift),
        }
    }
}

fn up(vector: &Vector3) -> [f32; 3] {
    [0, 1, 2].map(|k| at_least(vector[k]))
}

/// The least single that is no less: infinite beyond the largest.
fn at_least(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) < value { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singles_are_never_less() {
        for value in [0.0, 1e-60, 0.1, 1.0, 16_777_217.0, 1e39, f64::INFINITY] {
            let single = at_least(value);
            assert!(f64::from(single) >= value && f64::from(single.next_down()) < value.max(1e-60));
        }
        assert_eq!([0.0, 0.25, f64::INFINITY].map(at_least), [0.0, 0.25, f32::INFINITY]);
    }
}
