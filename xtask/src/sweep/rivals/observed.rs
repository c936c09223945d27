//! Two observed clouds in a pose, checked.

use cloudtouch_geom::{Point3, Pose};

use super::{RivalError, Side};

/// Coordinates beyond this are no scene, and their squares lose what is compared, m.
const LARGEST_COORDINATE: f64 = 1e9;

/// What every method is given: two clouds that are not empty, all of it finite.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observed<'a> {
    a: &'a [Point3],
    b: &'a [Point3],
    a_from_b: &'a Pose,
    std: f64,
}

impl<'a> Observed<'a> {
    /// Checks and takes points in their own frames (m), the pose that maps B into the frame of A,
    /// and the standard deviation of the sensor along every axis, m.
    ///
    /// # Errors
    /// When a cloud is empty, or something is not finite or out of its range.
    pub(crate) fn try_new(
        a: &'a [Point3],
        b: &'a [Point3],
        a_from_b: &'a Pose,
        std: f64,
    ) -> Result<Self, RivalError> {
        for (side, points) in [(Side::A, a), (Side::B, b)] {
            if points.is_empty() {
                return Err(RivalError::Empty { side });
            }
            // A comparison with NaN is false.
            let is_sound = |p: &Point3| p.iter().all(|v| v.abs() <= LARGEST_COORDINATE);
            if let Some(index) = points.iter().position(|p| !is_sound(p)) {
                return Err(RivalError::Point { side, index, point: points[index].coords.into() });
            }
        }
        if let Some(value) = a_from_b.non_finite_entry() {
            return Err(RivalError::Pose { value });
        }
        if !(std >= 0.0 && std.is_finite()) {
            return Err(RivalError::Std { value: std });
        }
        Ok(Self { a, b, a_from_b, std })
    }

    /// The points of A in their own frame, m.
    pub(crate) fn a(&self) -> &'a [Point3] {
        self.a
    }

    /// The points of B in their own frame, m.
    pub(crate) fn b(&self) -> &'a [Point3] {
        self.b
    }

    /// Maps the frame of B into that of A.
    pub(crate) fn a_from_b(&self) -> &'a Pose {
        self.a_from_b
    }

    /// Standard deviation of the sensor along every axis, m.
    pub(crate) fn std(&self) -> f64 {
        self.std
    }

    /// The points of B in the frame of A, m.
    pub(crate) fn b_in_a(&self) -> Vec<Point3> {
        self.b.iter().map(|p| self.a_from_b.transform_point(p)).collect()
    }
}

/// All indices below `count`, coarse steps first: what comes early is spread over the whole, so
/// that a running bound is soon tight.
pub(crate) fn spread(count: usize) -> impl Iterator<Item = usize> {
    const STEP: usize = 64;
    (0..STEP).flat_map(move |start| (start..count).step_by(STEP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_refused_with_its_place() {
        let good = [Point3::origin()];
        let bad = [Point3::origin(), Point3::new(0.0, f64::NAN, 0.0)];
        let far = [Point3::new(0.0, 0.0, -1e12)];
        let here = Pose::identity();
        let refused = |a: &[Point3], b: &[Point3], std| Observed::try_new(a, b, &here, std).err();
        assert_eq!(refused(&[], &good, 0.0), Some(RivalError::Empty { side: Side::A }));
        assert_eq!(refused(&good, &[], 0.0), Some(RivalError::Empty { side: Side::B }));
        assert!(matches!(
            refused(&good, &bad, 0.0),
            Some(RivalError::Point { side: Side::B, index: 1, .. })
        ));
        assert!(matches!(refused(&far, &good, 0.0), Some(RivalError::Point { index: 0, .. })));
        assert_eq!(refused(&good, &good, -1.0), Some(RivalError::Std { value: -1.0 }));
        let nowhere = Pose::from_translation(cloudtouch_geom::Vector3::new(f64::INFINITY, 0., 0.));
        assert!(matches!(
            Observed::try_new(&good, &good, &nowhere, 0.0),
            Err(RivalError::Pose { .. })
        ));
    }

    #[test]
    fn spread_names_every_index_once() {
        for count in [0, 1, 63, 64, 65, 1000] {
            let mut all: Vec<usize> = spread(count).collect();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..count), "{count}");
        }
    }
}
