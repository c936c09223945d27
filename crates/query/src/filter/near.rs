//! Things in an image that are nearer than returns are kept.

use cloudtouch_geom::{Point3, PointCloud};

use super::FilterSettings;
use super::lines::Image;
use super::range::is_return_to;

/// Columns and rows from a pixel to those beside it, to one side each.
const AROUND: [[isize; 2]; 4] = [[1, 0], [0, 1], [1, 1], [1, -1]];

/// The rows of an image that are nearer than returns are kept, said or not, in order, but for single pixels, as specks
/// are: things were there, however thin, and what is behind them nobody saw.
pub(super) fn too_near(cloud: &PointCloud, settings: &FilterSettings) -> Vec<usize> {
    let min = settings.min_range.or_else(|| settings.unstated_min_range(cloud));
    let (Some((width, height)), Some(min)) = (cloud.image_size, min) else {
        return Vec::new();
    };
    let image = &Image { cloud, size: [width, height] };
    let place = cloud.sensor_origin();
    let is_near = |p: &Point3| (p - place).norm() < min;
    let beside = |index: usize| {
        let around = move |step| {
            let line = image.line(index, step);
            [-1, 1].map(|side| image.on(index, line, side))
        };
        AROUND.into_iter().flat_map(around).flatten()
    };
    let is_thing = |&index: &usize| {
        let point = &cloud.points[index];
        is_near(point) && is_return_to(&place, point) && beside(index).any(is_near)
    };
    (0..cloud.len()).filter(is_thing).collect()
}
