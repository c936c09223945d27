//! From a cloud to a PCD file.

use std::{
    io::{self, Write},
    path::Path,
};

use cloudtouch_geom::PointCloud;

use crate::{
    atomic::write_atomically,
    builder::{COLUMN_NAMES, check_cloud},
    error::WriteError,
};

/// Writes a cloud as a PCD file, whole or not at all.
///
/// Binary doubles: reading it back gives the same bits, missing returns, covariances, sensor
/// pose and image size included, and the same cloud gives the same bytes everywhere. Normals are not written. A
/// sensor pose that is the identity comes back as none, for many files have it that say nothing by it. Compressing
/// doubles gains next to nothing, and single precision would lose the millimetres of map coordinates.
///
/// # Errors
/// When covariances or image size do not fit the points, the sensor pose is not finite, or the
/// file cannot be written.
pub fn write_cloud_pcd(path: impl AsRef<Path>, cloud: &PointCloud) -> Result<(), WriteError> {
    let path = path.as_ref();
    check_cloud(path, cloud)?;
    write_atomically(path, |writer| encode(cloud, writer))
}

/// The bytes of a checked cloud.
fn encode(cloud: &PointCloud, writer: &mut dyn Write) -> io::Result<()> {
    let columns = if cloud.covariances.is_some() { COLUMN_NAMES.len() } else { 3 };
    let per_column = |value: &str| [value].repeat(columns).join(" ");
    let (width, height) = cloud.image_size.unwrap_or((cloud.len(), 1));
    let from_sensor = cloud.from_sensor();
    let (origin, turn) = (from_sensor.translation(), from_sensor.rotation());
    writeln!(writer, "# .PCD v0.7 - Point Cloud Data file format")?;
    writeln!(writer, "VERSION 0.7")?;
    writeln!(writer, "FIELDS {}", COLUMN_NAMES[..columns].join(" "))?;
    writeln!(writer, "SIZE {}", per_column("8"))?;
    writeln!(writer, "TYPE {}", per_column("F"))?;
    writeln!(writer, "COUNT {}", per_column("1"))?;
    writeln!(writer, "WIDTH {width}\nHEIGHT {height}")?;
    write!(writer, "VIEWPOINT {} {} {} ", origin.x, origin.y, origin.z)?;
    writeln!(writer, "{} {} {} {}", turn.w, turn.i, turn.j, turn.k)?;
    writeln!(writer, "POINTS {}\nDATA binary", cloud.len())?;
    for (row, point) in cloud.points.iter().enumerate() {
        let covariance = cloud.covariances.as_ref().map(|all| all[row].upper_triangle());
        for value in point.iter().copied().chain(covariance.into_iter().flatten()) {
            writer.write_all(&value.to_le_bytes())?;
        }
    }
    Ok(())
}
