//! The scan near the gripper, with noise added to it.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch_geom::{Point3, PointCloud, Vector3, seed};
use cloudtouch_io::read_cloud;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// All randomness of the noise comes from this.
pub(super) const SEED: u64 = 2011;
/// How far around the gripper the scan is kept, m.
const MARGIN: f64 = 0.1;

/// Reads a depth image and forgets what is farther than 10 cm from a box around these points.
pub(super) fn read(path: &Path, around: Vec<Point3>) -> Result<PointCloud> {
    let mut scan = read_cloud(path)?;
    let corners = PointCloud::from_points(around).bounding_box().context("nothing to be near")?;
    let (low, high) = (corners.0.map(|v| v - MARGIN), corners.1.map(|v| v + MARGIN));
    for point in scan.points.iter_mut().filter(|p| !(low < **p && **p < high)) {
        *point = Vector3::repeat(f64::NAN).into();
    }
    Ok(scan)
}

/// The scan with normal errors of this standard deviation along each axis, m, added; those of one
/// draw differ in nothing but their size.
pub(super) fn with_noise(scan: &PointCloud, std: f64, draw: u64) -> PointCloud {
    let seed = seed::derive(SEED, 5, draw);
    let points = add_noise(&scan.points, NoiseKind::Gaussian, std, seed);
    PointCloud { points, ..scan.clone() }
}
