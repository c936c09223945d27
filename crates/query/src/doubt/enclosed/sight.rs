//! Whether a sensor looked at a place past no surface.

use cloudtouch_geom::Point3;

use crate::cloud::Prepared;

/// A way that keeps so many spacings of the cloud from every point passes no surface: of samples at random
/// four in a million ways through a surface do, and as many again from each further sensor.
const SURFACE_SPACINGS: f64 = 2.0;
/// Where the samples about a point are farther apart than those of the cloud, so many of theirs count ...
const LOCAL_SPACINGS: f64 = 1.5;
/// ... up to this many times as far: those of a floor far off are as a room is.
const MOST_SPARSE: f64 = 3.0;
/// A way of more balls than this is compared with all points.
const MOST_STEPS: f64 = 1000.0;
/// Relative, of where a ball ends.
const ROUNDING: f64 = 1e-9;

/// Whether no point of the cloud is near the way from a sensor to a place, both in the cloud's local frame.
pub(super) fn sees(cloud: &Prepared, sensor: &Point3, place: &Point3) -> bool {
    let reach = SURFACE_SPACINGS.max(LOCAL_SPACINGS * MOST_SPARSE) * cloud.makeup().spacing;
    let length = (place - sensor).norm();
    let steps = (0.5 * length / reach).ceil();
    // Of clumps the spacing is next to nothing, or nothing at all.
    let are_few = steps < MOST_STEPS;
    if !are_few {
        return cloud.points().iter().all(|point| is_off(cloud, (sensor, place), point));
    }
    // Balls along the way hold all that is so near to it.
    let step = (place - sensor) / steps.max(1.0);
    let radius = reach.hypot(0.5 * step.norm()) * (1.0 + ROUNDING) + ROUNDING * length;
    (0..steps.max(1.0) as usize).all(|ball| {
        let middle = sensor + step * (ball as f64 + 0.5);
        let mut is_free = true;
        cloud.visit_measured_within(&middle, radius, |point| {
            is_free = is_free && is_off(cloud, (sensor, place), point);
        });
        is_free
    })
}

/// Whether a point is not near the way.
fn is_off(cloud: &Prepared, (sensor, place): (&Point3, &Point3), point: &Point3) -> bool {
    let way = place - sensor;
    let length = way.norm();
    let spacing = cloud.makeup().spacing;
    let offset = point - sensor;
    let along = offset.dot(&way) / length.max(f64::MIN_POSITIVE);
    let aside = (offset.norm_squared() - along * along).max(0.0).sqrt();
    let is_between = along > 0.0 && along < length;
    let is_off_where_sparse = || {
        aside > LOCAL_SPACINGS * MOST_SPARSE * spacing
            || aside > LOCAL_SPACINGS * cloud.spacing_about(point)
    };
    !is_between || aside > SURFACE_SPACINGS * spacing && is_off_where_sparse()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, bounding_box, seed};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::{scene, surface};

    use super::*;
    use crate::{Cloud, CloudSettings};

    #[test]
    fn what_balls_along_the_way_find_is_what_all_points_tell() {
        let samples = surface::sample_surface(&scene::room(), 20_000, 3);
        let points = PointCloud::from_points(surface::positions(&samples));
        let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
        let cloud = Cloud::prepare(&points, &settings).unwrap();
        let cloud = cloud.prepared();
        let (low, high) = bounding_box(cloud.points()).unwrap();
        let mut seen = 0;
        for draw in 0..300 {
            let within = |k: u64| {
                let share = 1.2 * seed::unit(seed::derive(draw, k, 1)) - 0.1;
                low[k as usize % 3] + share * (high - low)[k as usize % 3]
            };
            let [sensor, place] =
                [0, 3].map(|k| Point3::new(within(k), within(k + 1), within(k + 2)));
            let by_all = cloud.points().iter().all(|point| is_off(cloud, (&sensor, &place), point));
            assert_eq!(sees(cloud, &sensor, &place), by_all, "{draw}");
            seen += usize::from(by_all);
        }
        assert!((30..270).contains(&seen), "{seen}");
    }
}
