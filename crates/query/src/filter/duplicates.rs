//! Exact duplicates: placeholders and points recorded twice.

use std::cmp::Ordering;

use cloudtouch_geom::{Covariance, PointCloud};
use cloudtouch_noise::repeated;

/// Of points at one place the first stays; of those that bring their noise the least certain, whichever comes first.
pub(super) fn keep_one(cloud: &PointCloud, kept: &mut Vec<usize>) {
    // So many points no index can hold: they are refused elsewhere.
    if u32::try_from(cloud.len()).is_err() {
        return;
    }
    let mut indices: Vec<u32> = kept.iter().map(|&index| index as u32).collect();
    let mut others = repeated(&cloud.points, indices.iter().copied());
    if let Some(noise) = cloud.covariances.as_ref().filter(|_| !others.is_empty()) {
        let noise = |index: &u32| &noise[*index as usize];
        indices.sort_by(|i, j| by_certainty(noise(i), noise(j)));
        others = repeated(&cloud.points, indices);
    }
    let mut others = others.into_iter().peekable();
    kept.retain(|&index| others.next_if_eq(&(index as u32)).is_none());
}

/// What is less certain comes first; what is equal is the same.
fn by_certainty(one: &Covariance, other: &Covariance) -> Ordering {
    let [one, other] = [one, other].map(|noise| {
        let [xx, xy, xz, yy, yz, zz] = noise.upper_triangle();
        [xx + yy + zz, xx, xy, xz, yy, yz, zz]
    });
    let entries = other.into_iter().zip(one);
    entries.fold(Ordering::Equal, |order, (q, p)| order.then(q.total_cmp(&p)))
}
