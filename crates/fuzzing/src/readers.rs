//! File readers: any bytes give a cloud or mesh that they back, or an error that says where.

use cloudtouch::geom::PointCloud;
use cloudtouch_io::pointcloud2::{self, Encoding};
use cloudtouch_io::{DepthCamera, Fault, FormatError, Geometry, depth, obj, pcd, ply, stl, xyz};

/// What LZF makes of a byte at most; a compressed PCD may hold a point in every unpacked byte.
const LARGEST_EXPANSION: usize = 88;

/// What deflate makes of a byte at most, two bytes a pixel.
const PIXELS_PER_BYTE: usize = 516;

/// No message is longer: it holds an excerpt of the file, never the file.
pub(crate) const LONGEST_MESSAGE: usize = 500;

/// Bytes as a PCD file.
///
/// # Panics
/// When the reader makes more points of them than they can hold, or gives no good error.
pub fn read_pcd(bytes: &[u8]) {
    check(bytes, LARGEST_EXPANSION, pcd::parse(bytes).map(Geometry::Cloud));
}

/// Bytes as a PLY file.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_ply(bytes: &[u8]) {
    check(bytes, 1, ply::parse(bytes));
}

/// Bytes as a table of coordinates.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_xyz(bytes: &[u8]) {
    check(bytes, 1, xyz::parse(bytes).map(Geometry::Cloud));
}

/// Bytes as a depth image.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_depth(bytes: &[u8]) {
    let camera = DepthCamera::new(8.0, 8.0, 3.0, 3.0);
    check(bytes, PIXELS_PER_BYTE, depth::parse(bytes, &camera).map(Geometry::Cloud));
}

/// Bytes as a message of either version of ROS.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_pointcloud2(bytes: &[u8]) {
    for encoding in [Encoding::Cdr, Encoding::Ros1] {
        let scan = pointcloud2::parse(bytes, encoding);
        check(bytes, 1, scan.map(|scan| Geometry::Cloud(scan.cloud)));
    }
}

/// Bytes as an STL file.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_stl(bytes: &[u8]) {
    check(bytes, 1, stl::parse(bytes).map(Geometry::Mesh));
}

/// Bytes as an OBJ file.
///
/// # Panics
/// As [`read_pcd`].
pub fn read_obj(bytes: &[u8]) {
    check(bytes, 1, obj::parse(bytes).map(Geometry::Mesh));
}

fn check(bytes: &[u8], points_per_byte: usize, result: Result<Geometry, FormatError>) {
    let most = points_per_byte * bytes.len();
    match result {
        Ok(Geometry::Cloud(cloud)) => check_cloud(&cloud, most),
        Ok(Geometry::Mesh(mesh)) => {
            let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
            assert!(vertices <= most && triangles <= most, "{triangles} triangles");
            assert!(triangles > 0, "a mesh has triangles");
        }
        Err(error) => {
            let message = error.to_string();
            let is_of_whole = matches!(
                error.fault,
                Fault::Empty
                    | Fault::Utf16
                    | Fault::NoTriangles
                    | Fault::NoReturns { .. }
                    | Fault::TooManyVertices { .. }
                    | Fault::Camera(_)
            );
            let has_place = ["line ", "byte "].iter().any(|start| message.starts_with(start));
            assert!(has_place || is_of_whole, "no place in: {message}");
            assert!(message.len() < LONGEST_MESSAGE, "{} bytes of message", message.len());
        }
    }
}

/// A cloud of no more points than there are bytes for.
pub(crate) fn check_cloud(cloud: &PointCloud, most: usize) {
    assert!(cloud.len() <= most, "{} points, of at most {most}", cloud.len());
    if let Some(covariances) = &cloud.covariances {
        assert_eq!(covariances.len(), cloud.len(), "one covariance for each point");
        assert!(covariances.iter().all(|c| c.is_finite()), "covariances are finite");
    }
    if let Some((width, height)) = cloud.image_size {
        assert_eq!(width.checked_mul(height), Some(cloud.len()), "one point for each pixel");
    }
    assert!(cloud.from_sensor().non_finite_entry().is_none(), "the sensor is somewhere");
}
