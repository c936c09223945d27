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

/// Beyond such coordinates, m, single precision is not good for a tenth of a millimetre.
const SINGLE: f64 = 1000.0;

/// Writes coloured points (red, green, blue), optionally with a `probability` for each and with
/// triangles between some of them, whole or not at all.
///
/// Binary, little-endian. Coordinates and probabilities are floats where all coordinates are within
/// ±1000 m, and doubles otherwise, as map coordinates need.
///
/// # Errors
/// When there is not one colour and one probability for each point, or the file cannot be written.
pub fn write_colored_ply(
    path: impl AsRef<Path>,
    points: &[Point3],
    colors: &[[u8; 3]],
    probabilities: Option<&[f64]>,
    triangles: &[[u32; 3]],
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
    let is_single = !points.iter().any(|p| p.iter().any(|v| v.abs() > SINGLE));
    let rows = Rows {
        points,
        colors: Some(colors),
        probabilities,
        covariances: None,
        triangles,
        is_single,
    };
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
        triangles: &[],
        is_single: false,
    };
    write_atomically(path, |writer| rows.encode(writer))
}

/// Lists of one length, but for the triangles between the points.
struct Rows<'a> {
    points: &'a [Point3],
    colors: Option<&'a [[u8; 3]]>,
    probabilities: Option<&'a [f64]>,
    covariances: Option<&'a [Covariance]>,
    triangles: &'a [[u32; 3]],
    /// Whether numbers are written in single precision.
    is_single: bool,
}

impl Rows<'_> {
    fn encode(&self, writer: &mut dyn Write) -> io::Result<()> {
        writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
        writeln!(writer, "element vertex {}", self.points.len())?;
        let (coordinates, covariance) = COLUMN_NAMES.split_at(3);
        let kind = if self.is_single { "float" } else { "double" };
        let numbers = |names: &[&str]| -> String {
            names.iter().map(|name| format!("property {kind} {name}\n")).collect()
        };
        write!(writer, "{}", numbers(coordinates))?;
        if self.colors.is_some() {
            write!(writer, "property uchar red\nproperty uchar green\nproperty uchar blue\n")?;
        }
        if self.probabilities.is_some() {
            write!(writer, "{}", numbers(&["probability"]))?;
        }
        if self.covariances.is_some() {
            write!(writer, "{}", numbers(covariance))?;
        }
        if !self.triangles.is_empty() {
            writeln!(writer, "element face {}", self.triangles.len())?;
            writeln!(writer, "property list uchar int vertex_indices")?;
        }
        writeln!(writer, "end_header")?;
        for (row, point) in self.points.iter().enumerate() {
            self.write_numbers(writer, point.coords.as_slice())?;
            if let Some(colors) = self.colors {
                writer.write_all(&colors[row])?;
            }
            if let Some(probabilities) = self.probabilities {
                self.write_numbers(writer, &[probabilities[row]])?;
            }
            if let Some(covariances) = self.covariances {
                self.write_numbers(writer, &covariances[row].upper_triangle())?;
            }
        }
        for corners in self.triangles {
            writer.write_all(&[3])?;
            corners.iter().try_for_each(|corner| writer.write_all(&corner.to_le_bytes()))?;
        }
        Ok(())
    }

    fn write_numbers(&self, writer: &mut dyn Write, values: &[f64]) -> io::Result<()> {
        values.iter().try_for_each(|value| {
            if self.is_single {
                writer.write_all(&(*value as f32).to_le_bytes())
            } else {
                writer.write_all(&value.to_le_bytes())
            }
        })
    }
}
