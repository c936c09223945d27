//! Turning a cloud into a quantised collision map.

use cloudtouch_geom::Point3;

use crate::error::{NoiseError, check_value_positive};

/// The centres of the occupied cells of a grid, one for each cell, sorted by x, then y, then z.
///
/// Cell (i, j, k) spans [i, i+1) · `resolution` on x, and likewise on y and z, in metres in the
/// frame of the points. Together with [`SensorModel::Grid`](crate::SensorModel::Grid) this is a
/// collision map: which cells are occupied is known, where in the cell the surface is, is not.
/// Points that are not finite are passed over. The order of the points does not matter.
///
/// # Errors
/// When `resolution` is not positive and at most 1e10, or a point is more than 2⁵³ cells from the
/// origin, where neighbouring cells can no longer be told apart.
pub fn quantize_to_grid(points: &[Point3], resolution: f64) -> Result<Vec<Point3>, NoiseError> {
    check_value_positive("the grid resolution", resolution)?;
    let mut cells = Vec::with_capacity(points.len());
    for (index, point) in points.iter().enumerate() {
        if !point.coords.iter().all(|v| v.is_finite()) {
            continue;
        }
        let cell = point.coords.map(|v| (v / resolution).floor());
        if cell.amax() > MAX_CELL {
            return Err(NoiseError::GridRange { index, point: *point, resolution });
        }
        cells.push([cell.x as i64, cell.y as i64, cell.z as i64]);
    }
    cells.sort_unstable();
    cells.dedup();
    let centre = |cell: i64| (cell as f64 + 0.5) * resolution;
    Ok(cells.iter().map(|c| Point3::from(c.map(centre))).collect())
}

/// 2⁵³: beyond it not every whole number is a double.
const MAX_CELL: f64 = 9_007_199_254_740_992.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_centre_for_each_occupied_cell() {
        let points = [
            Point3::new(0.019, 0.0, -0.001),
            Point3::new(0.011, 0.009, -0.009),
            Point3::new(f64::NAN, 0.0, 0.0),
            Point3::new(-0.005, 0.0, 0.0),
        ];
        let centres = quantize_to_grid(&points, 0.01).unwrap();
        let expected = [Point3::new(-0.005, 0.005, 0.005), Point3::new(0.015, 0.005, -0.005)];
        assert_eq!(centres.len(), 2);
        for (got, want) in centres.iter().zip(&expected) {
            assert!((got - want).norm() < 1e-15, "{got} against {want}");
        }
        let reversed: Vec<_> = points.iter().rev().copied().collect();
        assert_eq!(quantize_to_grid(&reversed, 0.01).unwrap(), centres);
        assert!(quantize_to_grid(&[], 0.01).unwrap().is_empty());
    }

    #[test]
    fn bad_grids_are_refused() {
        for resolution in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                quantize_to_grid(&[], resolution),
                Err(NoiseError::SensorValue { .. })
            ));
        }
        let far = Point3::new(0.0, 1e20, 0.0);
        assert!(matches!(
            quantize_to_grid(&[Point3::origin(), far], 0.01),
            Err(NoiseError::GridRange { index: 1, .. })
        ));
    }
}
