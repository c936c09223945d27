//! Exact duplicates: placeholders and points recorded twice.

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::Places;

pub(super) fn keep_first(cloud: &PointCloud, kept: &mut Vec<usize>) {
    let mut places = Places::of(&cloud.points);
    kept.retain(|&i| places.is_first(i));
}
