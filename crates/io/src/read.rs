//! Files by their extension: opens, parses, converts to metres.

use std::{
    fs::File,
    io::{self, Read as _},
    path::Path,
};

use cloudtouch_geom::{PointCloud, Pose, TriangleMesh};

#[cfg(feature = "mcap")]
use crate::recording::Recording;
use crate::{
    depth,
    depth_camera::DepthCamera,
    error::ReadError,
    fault::{Fault, FormatError, Place},
    geometry::Geometry,
    limits::ReadLimits,
    obj, pcd, ply,
    recording::{RecordedScan, ScanName},
    stl,
    unit::LengthUnit,
    xyz,
};

/// Reads a point cloud in metres: `.pcd`, `.ply`, `.xyz`, `.txt` or `.csv`; with the feature `mcap`
/// also a scan of a recording, see [`read_scan_within`].
///
/// Rows without a return stay as NaN rows. A PLY with faces is a mesh: what is between its vertices would be lost.
///
/// # Errors
/// When the file cannot be opened, has another extension, or is malformed; see [`Fault`].
pub fn read_cloud(path: impl AsRef<Path>) -> Result<PointCloud, ReadError> {
    read_cloud_within(path, &ReadLimits::default())
}

/// As [`read_cloud`], with other limits than the default ones.
///
/// # Errors
/// As [`read_cloud`].
pub fn read_cloud_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    let parse: Parser<PointCloud> = match extension(path).as_str() {
        "pcd" => pcd::parse_within,
        "ply" => |bytes, limits| match ply::parse_within(bytes, limits)? {
            Geometry::Cloud(cloud) => Ok(cloud),
            Geometry::Mesh(mesh) => {
                let found = mesh.triangles().len();
                Err(Place::Line(1).error(Fault::FacesOfCloud { found }))
            }
        },
        "xyz" | "txt" | "csv" => xyz::parse_within,
        "mcap" => return Ok(read_scan_within(path, limits)?.scan.cloud),
        _ => return Err(unsupported(path, ".pcd, .ply, .xyz, .txt, .csv (point clouds)")),
    };
    read(path, parse, limits)
}

/// Reads a depth image, a 16-bit greyscale PNG (`.png`), as an organised cloud in metres in the optical
/// frame of its camera: see [`depth::parse`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is no depth image, or is none of this camera.
pub fn read_depth_image(
    path: impl AsRef<Path>,
    camera: &DepthCamera,
) -> Result<PointCloud, ReadError> {
    read_depth_image_within(path, camera, &ReadLimits::default())
}

/// As [`read_depth_image`], with other limits than the default ones.
///
/// # Errors
/// As [`read_depth_image`].
pub fn read_depth_image_within(
    path: impl AsRef<Path>,
    camera: &DepthCamera,
    limits: &ReadLimits,
) -> Result<PointCloud, ReadError> {
    let path = path.as_ref();
    if !depth::is_depth_image(path) {
        return Err(unsupported(path, ".png (depth images)"));
    }
    read(path, |bytes, limits| depth::parse_within(bytes, camera, limits), limits)
}

/// Reads a triangle mesh and converts it from `unit` to metres: `.stl`, `.obj` or `.ply`.
///
/// Polygons become fans about their first corner. Vertices are left as the file has them:
/// those of an STL are repeated in every triangle until [`TriangleMesh::merged`].
///
/// # Errors
/// When the file cannot be opened, has another extension, is malformed, has no faces or a
/// coordinate that is not finite; see [`Fault`].
pub fn read_mesh(path: impl AsRef<Path>, unit: LengthUnit) -> Result<TriangleMesh, ReadError> {
    read_mesh_within(path, unit, &ReadLimits::default())
}

/// As [`read_mesh`], with other limits than the default ones.
///
/// # Errors
/// As [`read_mesh`].
pub fn read_mesh_within(
    path: impl AsRef<Path>,
    unit: LengthUnit,
    limits: &ReadLimits,
) -> Result<TriangleMesh, ReadError> {
    let path = path.as_ref();
    let parse: Parser<TriangleMesh> = match extension(path).as_str() {
        "stl" => stl::parse_within,
        "obj" => obj::parse_within,
        "ply" => |bytes, limits| match ply::parse_within(bytes, limits)? {
            Geometry::Mesh(mesh) => Ok(mesh),
            Geometry::Cloud(_) => Err(Place::Line(1).error(Fault::NoTriangles)),
        },
        _ => return Err(unsupported(path, ".stl, .obj, .ply (meshes)")),
    };
    Ok(read(path, parse, limits)?.scaled(unit.in_metres()))
}

/// Reads a cloud or a mesh, whichever the file holds, and converts it from `unit` to metres.
///
/// A PLY is a mesh when it has faces. The unit counts for clouds too: positions, covariances and
/// the sensor origin are converted.
///
/// # Errors
/// As [`read_cloud`] and [`read_mesh`]; and when most vertices of a PLY belong to no face, for it may be
/// a cloud as well as a mesh.
pub fn read_geometry(path: impl AsRef<Path>, unit: LengthUnit) -> Result<Geometry, ReadError> {
    read_geometry_within(path, unit, &ReadLimits::default())
}

/// As [`read_geometry`], with other limits than the default ones.
///
/// # Errors
/// As [`read_geometry`].
pub fn read_geometry_within(
    path: impl AsRef<Path>,
    unit: LengthUnit,
    limits: &ReadLimits,
) -> Result<Geometry, ReadError> {
    let path = path.as_ref();
    let factor = unit.in_metres();
    let parse: Parser<Geometry> = match extension(path).as_str() {
        "pcd" => |bytes, limits| pcd::parse_within(bytes, limits).map(Geometry::Cloud),
        "xyz" | "txt" | "csv" => {
            |bytes, limits| xyz::parse_within(bytes, limits).map(Geometry::Cloud)
        }
        "stl" => |bytes, limits| stl::parse_within(bytes, limits).map(Geometry::Mesh),
        "obj" => |bytes, limits| obj::parse_within(bytes, limits).map(Geometry::Mesh),
        "ply" => |bytes, limits| ply::parse_within(bytes, limits).and_then(one_of_both),
        "mcap" => {
            let cloud = read_scan_within(path, limits)?.scan.cloud;
            return Ok(Geometry::Cloud(scaled_cloud(cloud, factor)));
        }
        _ => return Err(unsupported(path, EVERYTHING)),
    };
    Ok(match read(path, parse, limits)? {
        Geometry::Cloud(cloud) => Geometry::Cloud(scaled_cloud(cloud, factor)),
        Geometry::Mesh(mesh) => Geometry::Mesh(mesh.scaled(factor)),
    })
}

/// Refuses a mesh most of whose vertices belong to no face: points would be lost without a word.
fn one_of_both(geometry: Geometry) -> Result<Geometry, FormatError> {
    if let Geometry::Mesh(mesh) = &geometry {
        let (vertices, used) = (mesh.vertices().len(), mesh.used_vertices().count());
        if 2 * used < vertices {
            let fault = Fault::LoosePoints { loose: vertices - used, vertices };
            return Err(Place::Line(1).error(fault));
        }
    }
    Ok(geometry)
}

/// Reads a scan of a recording, `run.mcap#/topic@SECONDS`, as [`ScanName`] explains it.
///
/// The cloud is in the frame of the message: transforms of the recording are not applied.
///
/// # Errors
/// When the path names no recording or no time, the recording cannot be read or has no such scan,
/// or the message is malformed. Always in a build without the feature `mcap`.
pub fn read_scan_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<RecordedScan, ReadError> {
    let path = path.as_ref();
    let name =
        ScanName::of(path).unwrap_or_else(|| Err(unsupported(path, ".mcap (recordings)")))?;
    recorded(&name, limits)
}

#[cfg(feature = "mcap")]
fn recorded(name: &ScanName, limits: &ReadLimits) -> Result<RecordedScan, ReadError> {
    Recording::open(&name.file, limits)?.scan(name.topic.as_deref(), name.at)
}

#[cfg(not(feature = "mcap"))]
fn recorded(name: &ScanName, _: &ReadLimits) -> Result<RecordedScan, ReadError> {
    Err(ReadError::NoRecordings { path: name.file.clone() })
}

/// Red, green and blue of every row of a cloud; `None` where the file has none, or is a pipe, whose contents went
/// to whoever read the points.
///
/// # Errors
/// As [`read_cloud`].
pub fn read_colors_within(
    path: impl AsRef<Path>,
    limits: &ReadLimits,
) -> Result<Option<Vec<[u8; 3]>>, ReadError> {
    let path = path.as_ref();
    match extension(path).as_str() {
        _ if path.metadata().is_ok_and(|about| !about.is_file()) => Ok(None),
        "pcd" => read(path, pcd::colors_within, limits),
        "ply" => read(path, ply::colors_within, limits),
        _ => Ok(None),
    }
}

/// Whether the extension of a file is one that is read, without a look at the file; the name of a
/// scan in a recording has to be well formed. Depth images count, which only [`read_depth_image`] reads.
///
/// # Errors
/// When it is not.
pub fn check_extension(path: impl AsRef<Path>) -> Result<(), ReadError> {
    let path = path.as_ref();
    match (extension(path).as_str(), ScanName::of(path)) {
        (_, Some(Ok(name))) if !cfg!(feature = "mcap") => {
            Err(ReadError::NoRecordings { path: name.file })
        }
        (_, Some(name)) => name.map(|_| ()),
        ("pcd" | "xyz" | "txt" | "csv" | "stl" | "obj" | "ply" | "png", None) => Ok(()),
        _ => Err(unsupported(path, WITH_IMAGES)),
    }
}

/// What [`read_geometry`] reads.
const EVERYTHING: &str = ".pcd, .ply, .xyz, .txt, .csv, .stl, .obj";
/// The same with what [`read_depth_image`] reads.
const WITH_IMAGES: &str = ".pcd, .ply, .xyz, .txt, .csv, .png (depth images), .stl, .obj";

type Parser<T> = fn(&[u8], &ReadLimits) -> Result<T, FormatError>;

fn read<T>(
    path: &Path,
    parse: impl FnOnce(&[u8], &ReadLimits) -> Result<T, FormatError>,
    limits: &ReadLimits,
) -> Result<T, ReadError> {
    let bytes = read_bytes(path, limits.bytes)?;
    parse(&bytes, limits)
        .map_err(|problem| ReadError::Format { path: path.to_owned(), problem: Box::new(problem) })
}

/// The contents of a file of at most `limit` bytes.
///
/// The limit holds whatever the file system says of its size: a device or a pipe has none.
///
/// # Errors
/// When it cannot be opened or read, or has more bytes.
pub fn read_bytes(path: impl AsRef<Path>, limit: u64) -> Result<Vec<u8>, ReadError> {
    let path = path.as_ref();
    let failed = |cause| ReadError::Io { path: path.to_owned(), cause };
    let too_large = || ReadError::TooLarge { path: path.to_owned(), limit };
    let file = File::open(path).map_err(|cause| ReadError::of_opening(path, cause))?;
    let about = file.metadata().map_err(failed)?;
    if about.is_dir() {
        return Err(failed(is_folder()));
    }
    let size = about.len();
    if size > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    let expected = usize::try_from(size).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(expected).map_err(|_| failed(io::ErrorKind::OutOfMemory.into()))?;
    let read = file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    if read as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

fn extension(path: &Path) -> String {
    // A topic may end as a file does.
    if ScanName::of(path).is_some() {
        return "mcap".to_owned();
    }
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// What is said of a folder in the place of a file.
fn is_folder() -> io::Error {
    io::Error::new(io::ErrorKind::IsADirectory, "it is a folder: give a file in it")
}

fn unsupported(path: &Path, supported: &'static str) -> ReadError {
    if path.is_dir() {
        return ReadError::Io { path: path.to_owned(), cause: is_folder() };
    }
    ReadError::Extension { path: path.to_owned(), found: extension(path), supported }
}

/// A cloud in another unit: positions, covariances and the place of the sensor times `factor`.
pub fn scaled_cloud(mut cloud: PointCloud, factor: f64) -> PointCloud {
    cloud.points.iter_mut().for_each(|p| p.coords *= factor);
    cloud.sensor_pose = cloud
        .sensor_pose
        .map(|pose| Pose::from_translation_rotation(pose.translation() * factor, *pose.rotation()));
    for covariance in cloud.covariances.iter_mut().flatten() {
        *covariance = covariance.scaled(factor);
    }
    cloud
}
