//! Tables without column names that are no points in their first three columns.

use cloudtouch_geom::Point3;

use crate::fault::Fault;

/// A row has no more numbers than this.
const MOST_COLUMNS: usize = 20;

/// Fewer rows in equal steps may be chance, or a few points set by hand.
const FEWEST_COUNTED: usize = 10;

/// A share of a step: times are rounded as they are written, such as .033, .067, .100.
const STEP_TOLERANCE: f64 = 0.05;

/// Normals, colours and an intensity are columns of a point; more numbers are more points.
pub(super) fn refuse_many_columns(found: usize, points: usize) -> Result<(), Fault> {
    let are_points = found > MOST_COLUMNS || points == 1 && found >= 6 && found.is_multiple_of(3);
    if are_points { Err(Fault::ManyColumns { found }) } else { Ok(()) }
}

/// A time or a row number taken for x puts the cloud where nothing is, which reads free. Points in rows
/// and columns go back to their first x, so only a single line of them along x is taken for a count.
pub(super) fn refuse_a_count(
    points: &[Point3],
    columns: usize,
    separator: Option<u8>,
) -> Result<(), Fault> {
    if columns <= 3 {
        return Ok(());
    }
    let [first, .., last] = points else { return Ok(()) };
    let step = (last.x - first.x) / (points.len() - 1) as f64;
    let is_counted = |(row, point): (usize, &Point3)| {
        (point.x - (first.x + row as f64 * step)).abs() <= STEP_TOLERANCE * step
    };
    if points.len() < FEWEST_COUNTED || step <= 0.0 || !points.iter().enumerate().all(is_counted) {
        return Ok(());
    }
    Err(Fault::CountedRows {
        rows: points.len(),
        first: first.x,
        step,
        separator: char::from(separator.unwrap_or(b' ')),
    })
}
