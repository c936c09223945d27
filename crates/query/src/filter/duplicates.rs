//! Exact duplicates: placeholders and points recorded twice.

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::repeated;

pub(super) fn keep_first(cloud: &PointCloud, kept: &mut Vec<usize>) {
    // So many points no index can hold: they are refused elsewhere.
    if u32::try_from(cloud.len()).is_err() {
        return;
    }
    let indices = kept.iter().map(|&index| index as u32);
    let mut repeated = repeated(&cloud.points, indices).into_iter().peekable();
    kept.retain(|&index| repeated.next_if_eq(&(index as u32)).is_none());
}
