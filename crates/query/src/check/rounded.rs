//! Coordinates that were kept in single precision far from the origin of their frame: in those of a map they are
//! half a metre apart.

use cloudtouch_geom::Point3;

/// Steps below this, m, are those of any file.
const LEAST_STEP: f64 = 1e-3;
/// Values so near to one of single precision, as a share of them, are one.
const ROUNDING: f64 = 1e-12;
/// Fewer points tell nothing: what is typed by hand is round.
const FEWEST: usize = 10;

/// How far apart coordinates of single precision are where these points are, m, along the axis where that is
/// farthest; `None` where they are of double precision or lie so near to the origin that it does not matter.
pub(crate) fn single_step(points: &[Point3]) -> Option<f64> {
    if points.len() < FEWEST {
        return None;
    }
    let of_axis = |axis: usize| {
        let most = points.iter().map(|p| p[axis].abs()).fold(0.0, f64::max);
        let step = step_at(most);
        let is_single = |p: &Point3| (p[axis] - f64::from(p[axis] as f32)).abs() <= ROUNDING * most;
        (step >= LEAST_STEP && points.iter().all(is_single)).then_some(step)
    };
    (0..3).filter_map(of_axis).max_by(f64::total_cmp)
}

/// Between two neighbouring numbers of single precision.
fn step_at(value: f64) -> f64 {
    let value = value as f32;
    f64::from(value.next_up() - value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(offset: f64) -> Vec<Point3> {
        (0..50).map(|k| Point3::new(offset + 0.013 * f64::from(k), 0.37, 0.01)).collect()
    }

    fn single(points: &[Point3]) -> Vec<Point3> {
        points.iter().map(|p| p.map(|x| f64::from(x as f32))).collect()
    }

    #[test]
    fn only_coarse_numbers_of_single_precision_are_told() {
        assert_eq!(single_step(&points(5.4e6)), None);
        assert_eq!(single_step(&single(&points(5.4e6))), Some(0.5));
        assert_eq!(single_step(&single(&points(-5.4e6))), Some(0.5));
        assert_eq!(single_step(&single(&points(1000.0))), None);
        assert_eq!(single_step(&single(&points(5.4e6))[..5]), None);
    }
}
