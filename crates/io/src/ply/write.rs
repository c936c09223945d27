//! From points to a binary PLY file with double coordinates.

use std::{
    io::{self, Write},
    path::Path,
};

use cloudtouch_geom::{Covariance, Point3, PointCloud};

use crate::{
    atomic::write_atomically,
    builder::{COLUMN_NAMES, check_cloud},
    error::WriteError,
};

/// Writes coloured points (red, green, blue), optionally with a `probability` for each, whole or
/// not at all.
///
/// Binary, little-endian; coordinates are doubles, as map coordinates need.
///
/// # Errors
/// When there is not one colour and one probability for each point, or the file cannot be written.
pub fn write_colored_ply(
    path: impl AsRef<Path>,
    points: &[Point3],
    colors: &[[u8; 3]],
    probabilities: Option<&[f64]>,
) -> Result<(), WriteError> {
    let path = path.as_ref();
    let counts = [
        ("colours", colors.len()),
        ("probabilities", probabilities.map_or(points.len(), <[_]>::len)),
    ];
    for (what, found) in counts {
        if found != points.len() {
            let points = points.len();
            return Err(WriteError::Length { path: path.to_owned(), what, found, points });
        }
    }
    let rows = Rows { points, colors: Some(colors), probabilities, covariances: None };
    write_atomically(path, |writer| rows.encode(writer))
}

/// Writes a cloud as a PLY file that many viewers open, whole or not at all.
///
/// Points and covariances come back with the same bits. A PLY has no place for the sensor origin
/// and the image layout: [`write_cloud_pcd`](crate::write_cloud_pcd) keeps them.
///
/// # Errors
/// When the covariances do not fit the points, or the file cannot be written.
pub fn write_cloud_ply(path: impl AsRef<Path>, cloud: &PointCloud) -> Result<(), WriteError> {
    let path = path.as_ref();
    check_cloud(path, cloud)?;
    let rows = Rows {
        points: &cloud.points,
        colors: None,
        probabilities: None,
        covariances: cloud.covariances.as_deref(),
    };
    write_atomically(path, |writer| rows.encode(writer))
}

/// Lists of one length.
struct Rows<'a> {
    points: &'a [Point3],
    colors: Option<&'a [[u8; 3]]>,
    probabilities: Option<&'a [f64]>,
    covariances: Option<&'a [Covariance]>,
}

impl Rows<'_> {
    fn encode(&self, writer: &mut dyn Write) -> io::Result<()> {
        writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
        writeln!(writer, "element vertex {}", self.points.len())?;
        let (coordinates, covariance) = COLUMN_NAMES.split_at(3);
        let doubles = |names: &[&str]| -> String {
            names.iter().map(|name| format!("property double {name}\n")).collect()
        };
        write!(writer, "{}", doubles(coordinates))?;
        if self.colors.is_some() {
            write!(writer, "property uchar red\nproperty uchar green\nproperty uchar blue\n")?;
        }
        if self.probabilities.is_some() {
            write!(writer, "{}", doubles(&["probability"]))?;
        }
        if self.covariances.is_some() {
            write!(writer, "{}", doubles(covariance))?;
        }
        writeln!(writer, "end_header")?;
        for (row, point) in self.points.iter().enumerate() {
            write_doubles(writer, point.coords.as_slice())?;
            if let Some(colors) = self.colors {
                writer.write_all(&colors[row])?;
            }
            if let Some(probabilities) = self.probabilities {
                write_doubles(writer, &[probabilities[row]])?;
            }
            if let Some(covariances) = self.covariances {
                write_doubles(writer, &covariances[row].upper_triangle())?;
            }
        }
        Ok(())
    }
}

fn write_doubles(writer: &mut dyn Write, values: &[f64]) -> io::Result<()> {
    values.iter().try_for_each(|value| writer.write_all(&value.to_le_bytes()))
}
