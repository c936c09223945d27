//! Where the names of points go so that they hide nothing.

use std::ops::Range;

use crate::common::draw::text_width;

/// Height of a name, pixels.
const HEIGHT: i32 = 14;
/// From a point to its name, pixels.
const GAP: i32 = 8;

/// Left, top, right and bottom, pixels.
type Area = [i32; 4];

/// For each point the upper left corner of its name, pixels.
///
/// Names are placed in order, each at the first of eight places around its point that hides
/// least: of points, of obstacles (left, top, right, bottom), of names placed before, and of what
/// is outside of the given columns and rows.
pub(crate) fn place(
    names: &[&str],
    points: &[(i32, i32)],
    obstacles: &[[i32; 4]],
    columns: Range<i32>,
    rows: Range<i32>,
) -> Vec<(i32, i32)> {
    let mut taken: Vec<Area> =
        points.iter().map(|&(x, y)| [x - GAP + 2, y - GAP + 2, x + GAP - 2, y + GAP - 2]).collect();
    taken.extend(obstacles);
    let mut corners = Vec::new();
    for (name, &(x, y)) in names.iter().zip(points) {
        let width = text_width(name) as i32;
        let (left, middle, right) = (x - GAP - width, x - width / 2, x + GAP);
        let (above, level, below) = (y - GAP - HEIGHT, y - HEIGHT / 2, y + GAP);
        let cost = |&(x, y): &(i32, i32)| {
            let area = [x, y, x + width, y + HEIGHT];
            let inside = overlap(&area, &[columns.start, rows.start, columns.end, rows.end]);
            let outside = width * HEIGHT - inside;
            outside + taken.iter().map(|other| overlap(&area, other)).sum::<i32>()
        };
        let candidates = [
            (right, level),
            (right, above),
            (right, below),
            (left, level),
            (left, above),
            (left, below),
            (middle, above),
            (middle, below),
        ];
        // The first of several that are equally good.
        let best = candidates.into_iter().min_by_key(cost).unwrap_or((right, level));
        taken.push([best.0, best.1, best.0 + width, best.1 + HEIGHT]);
        corners.push(best);
    }
    corners
}

/// Pixels that two areas share.
fn overlap(a: &Area, b: &Area) -> i32 {
    let width = (a[2].min(b[2]) - a[0].max(b[0])).max(0);
    let height = (a[3].min(b[3]) - a[1].max(b[1])).max(0);
    width * height
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_avoid_points_one_another_and_the_edge() {
        let names = ["first", "second", "at the right edge"];
        let points = [(50, 50), (62, 52), (195, 100)];
        // A line to the right of the first.
        let line = [50, 48, 58, 52];
        let corners = place(&names, &points, &[line], 0..200, 0..200);
        let areas: Vec<Area> = names
            .iter()
            .zip(&corners)
            .map(|(name, &(x, y))| [x, y, x + text_width(name) as i32, y + HEIGHT])
            .collect();
        for (i, area) in areas.iter().enumerate() {
            assert!(area[0] >= 0 && area[2] <= 200, "{area:?}");
            assert_eq!(overlap(area, &line), 0, "{area:?}");
            for &(x, y) in &points {
                assert_eq!(overlap(area, &[x - 5, y - 5, x + 5, y + 5]), 0, "{area:?} {x} {y}");
            }
            for other in &areas[..i] {
                assert_eq!(overlap(area, other), 0, "{area:?} {other:?}");
            }
        }
    }
}
