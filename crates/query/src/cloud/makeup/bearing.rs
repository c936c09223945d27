//! Where the bearings of a scanner's view begin.

use std::f64::consts::{PI, TAU};

use cloudtouch_geom::{Point3, PointCloud, Vector3};

use super::panorama::Cones;
use crate::filter::is_return_to;

/// Steps of the turn that are looked at, at most.
const STEPS: usize = 400;
/// What turns by this part of a whole turn goes all around.
const ALL_AROUND: f64 = 0.97;

/// The bearing, about z in the frame of the scanner, that is opposite to the middle of what it turned by, so that no two
/// that it measured side by side are a turn apart; 0 of one that goes all around.
pub(super) fn begin(image: &PointCloud, place: &Point3, cones: &Cones) -> Option<f64> {
    let (width, height) = image.image_size?;
    let (steps, lines) = if cones.are_rows { (width, height) } else { (height, width) };
    let index = |step: usize, line: usize| {
        if cones.are_rows { line * width + step } else { step * width + line }
    };
    let turn = image.from_sensor();
    let bearing = |step: usize| {
        let returns = (0..lines).map(|line| &image.points[index(step, line)]);
        let rays = returns
            .filter(|p| is_return_to(place, p))
            .map(|p| turn.rotation().inverse_transform_vector(&(p - place)))
            .filter_map(|ray| Vector3::new(ray.x, ray.y, 0.0).try_normalize(0.0));
        let middle = rays.sum::<Vector3>().try_normalize(0.0)?;
        Some(middle.y.atan2(middle.x))
    };
    let mut bearings = (0..steps).step_by(steps.div_ceil(STEPS).max(1)).filter_map(bearing);
    let first = bearings.next()?;
    let wrapped = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
    let (turned, _) =
        bearings.fold((0.0, first), |(turned, before), now| (turned + wrapped(now - before), now));
    Some(if turned.abs() < ALL_AROUND * TAU { first + 0.5 * turned + PI } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;
    use crate::cloud::makeup::panorama::fit;

    /// Of 16 lines in a ball, from one bearing on by a part of a turn, in the rows or the columns of an image, in another
    /// frame.
    fn told(first: f64, turned: f64, are_rows: bool, pose: &Pose) -> f64 {
        let (steps, lines) = (300, 16);
        let ray = |step: usize, line: usize| {
            let at = first + turned * step as f64 / steps as f64;
            let up = 0.03 * (line as f64 - 7.5);
            Point3::new(up.cos() * at.cos(), up.cos() * at.sin(), up.sin()) * 4.0
        };
        let points = (0..steps * lines).map(|i| match are_rows {
            true => ray(i % steps, i / steps),
            false => ray(i / lines, i % lines),
        });
        let points = points.map(|point| pose.transform_point(&point)).collect();
        let image_size = Some(if are_rows { (steps, lines) } else { (lines, steps) });
        let image =
            PointCloud { image_size, sensor_pose: Some(*pose), ..PointCloud::from_points(points) };
        let place = image.sensor_origin();
        let cones = fit(&image, &place).expect("enough returns");
        begin(&image, &place, &cones).expect("bearings").rem_euclid(TAU)
    }

    #[test]
    fn bearings_begin_opposite_to_the_middle_of_a_part_of_a_turn() {
        let pose = Pose::from_translation_rpy(Vector3::new(3.0, -1.0, 1.2), [0.3, -1.0, 2.5]);
        for pose in [Pose::identity(), pose] {
            for (first, turned) in [(-0.5, 1.0), (0.3, -2.0), (-2.0, 4.0), (2.5, 5.5)] {
                for are_rows in [true, false] {
                    let found = told(first, turned, are_rows, &pose);
                    let middle: f64 = first + 0.5 * turned;
                    let off =
                        (found - middle - PI).sin().abs() + (1.0 + (found - middle).cos()).abs();
                    assert!(off < 0.02, "{first} {turned} {are_rows}: {found}");
                }
            }
            assert_eq!([1.0, -1.0].map(|side| told(0.1, side * TAU, true, &pose)), [0.0; 2]);
        }
    }
}
