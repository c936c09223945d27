//! Exact duplicates: placeholders and points recorded twice.

use std::collections::HashSet;

use cloudtouch_geom::PointCloud;

pub(super) fn keep_first(cloud: &PointCloud, kept: &mut Vec<usize>) {
    let mut seen = HashSet::with_capacity(kept.len());
    // Adding zero makes −0 and 0 the same key.
    kept.retain(|&i| seen.insert(cloud.points[i].coords.map(|v| (v + 0.0).to_bits())));
}
