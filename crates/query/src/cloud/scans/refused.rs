//! Scans that are refused, and what of them is looked at for that.

use cloudtouch_geom::{Point3, UnitVector3};
use cloudtouch_noise::{NoiseError, repeated};

use crate::error::PrepareError;
use crate::filter::StageReport;

pub(super) fn nothing_left(before: usize, stages: &[StageReport]) -> PrepareError {
    let removed: Vec<String> =
        stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
    PrepareError::NothingLeft { before, stages: removed.join(", ") }
}

/// What is wrong with one of several scans; `which` of them, counted from 0.
pub(super) fn of_scan(error: PrepareError, which: usize, count: usize) -> PrepareError {
    match count {
        1 => error,
        count => PrepareError::Scan { scan: which, count, error: Box::new(error) },
    }
}

/// Normals as they are, after a look at them: a `Unit` can be made without a check. `row` is that of a point in its
/// file.
pub(super) fn checked(
    normals: &[UnitVector3],
    row: impl Fn(usize) -> usize,
) -> Result<Vec<UnitVector3>, PrepareError> {
    let checked = |(index, normal): (usize, &UnitVector3)| {
        let is_unit = (normal.norm() - 1.0).abs() < 1e-6;
        if is_unit {
            Ok(*normal)
        } else {
            Err(PrepareError::Normal { index: row(index), normal: normal.into_inner() })
        }
    };
    normals.iter().enumerate().map(checked).collect()
}

/// What is wrong with the noise of some points, by the row of the point in its file.
pub(super) fn by_row(error: PrepareError, row: impl Fn(usize) -> usize) -> PrepareError {
    match error {
        PrepareError::Noise(NoiseError::CovarianceNotFinite { index, point }) => {
            NoiseError::CovarianceNotFinite { index: row(index), point }.into()
        }
        other => other,
    }
}

/// Whether no scan is one that was given before, whose points are as many: given where the points of each end
/// among those of all. Maps of cells may well hold all of a smaller one.
pub(super) fn check_for_repeats(points: &[Point3], ends: &[usize]) -> Result<(), PrepareError> {
    if ends.len() < 2 {
        return Ok(());
    }
    // So many points no index can hold: they are refused elsewhere.
    let Ok(count) = u32::try_from(points.len()) else { return Ok(()) };
    let repeated = repeated(points, 0..count);
    let before = |end: usize| repeated.partition_point(|&index| (index as usize) < end);
    let (mut start, mut counts) = (0, Vec::new());
    for (scan, &end) in ends.iter().enumerate() {
        let are_all_repeated = before(end) - before(start) == end - start;
        if are_all_repeated && counts.contains(&(end - start)) {
            return Err(PrepareError::RepeatedScan { scan });
        }
        counts.push(end - start);
        start = end;
    }
    Ok(())
}
