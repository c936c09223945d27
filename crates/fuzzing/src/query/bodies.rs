//! Small clouds and meshes: points anywhere, patches of a surface, boxes and triangles.

use arbitrary::{Result, Unstructured};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch::{Mesh, PrepareError};

use super::numbers::{count, covariance, number, point};

/// Points of a body at most: a few leaves, and thousands of runs a minute.
const MOST_POINTS: usize = 150;

/// A prepared cloud of either path, or a mesh.
#[allow(clippy::large_enum_variant, reason = "there are two, each far larger on the heap")]
pub(super) enum Body<C> {
    Cloud(C),
    Mesh(Mesh),
}

/// A prepared body, or the message of the error of preparing it.
pub(super) fn body<S, C>(
    u: &mut Unstructured<'_>,
    settings: impl Fn(&mut Unstructured<'_>) -> Result<S>,
    prepare: impl Fn(&PointCloud, &S) -> std::result::Result<C, PrepareError>,
) -> Result<std::result::Result<Body<C>, String>> {
    if u.arbitrary::<u8>()? < 192 {
        let settings = settings(u)?;
        let prepared = prepare(&cloud(u)?, &settings);
        Ok(prepared.map(Body::Cloud).map_err(|error| error.to_string()))
    } else {
        let mesh = match mesh(u)? {
            Ok(mesh) => Mesh::prepare(&mesh).map_err(|error| error.to_string()),
            Err(message) => Err(message),
        };
        Ok(mesh.map(Body::Mesh))
    }
}

fn cloud(u: &mut Unstructured<'_>) -> Result<PointCloud> {
    let points = if u.arbitrary()? { patch(u)? } else { scattered(u)? };
    let mut cloud = PointCloud::from_points(points);
    match u.arbitrary::<u8>()? {
        0..=99 => {}
        // The same for all, one for each, or not as many as points.
        100..=149 => cloud.covariances = Some(vec![covariance(u)?; cloud.len()]),
        150..=249 => {
            let each = (0..cloud.len()).map(|_| covariance(u)).collect::<Result<_>>()?;
            cloud.covariances = Some(each);
        }
        250..=255 => cloud.covariances = Some(vec![covariance(u)?; count(u, 1)?.min(MOST_POINTS)]),
    }
    if u.arbitrary()? {
        cloud.sensor_pose = Some(Pose::from_translation(point(u)?.coords));
    }
    if u.arbitrary()? {
        let width = count(u, 8)?;
        cloud.image_size = Some((width, count(u, cloud.len() / width.max(1))?));
    }
    Ok(cloud)
}

fn scattered(u: &mut Unstructured<'_>) -> Result<Vec<Point3>> {
    let length = u.int_in_range(0..=60)?;
    (0..length).map(|_| point(u)).collect()
}

/// A bent rectangle of points, with a jitter of its own for each.
fn patch(u: &mut Unstructured<'_>) -> Result<Vec<Point3>> {
    let (rows, columns) = (u.int_in_range(1..=12)?, u.int_in_range(1..=12)?);
    let corner = point(u)?;
    let (spacing, bend, jitter) = (number(u)?, number(u)?, 0.1 * number(u)?);
    let mut points = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let (x, y) = (spacing * f64::from(row), spacing * f64::from(column));
            let z = bend * (x * x + y * y) + jitter * f64::from(u.arbitrary::<i8>()?);
            points.push(Point3::new(corner.x + x, corner.y + y, corner.z + z));
        }
    }
    points.truncate(MOST_POINTS);
    Ok(points)
}

fn mesh(u: &mut Unstructured<'_>) -> Result<std::result::Result<TriangleMesh, String>> {
    let (vertices, triangles) = if u.arbitrary()? { solid(u)? } else { soup(u)? };
    Ok(TriangleMesh::new(vertices, triangles).map_err(|error| error.to_string()))
}

/// A box, whichever way its sides run: watertight, unless a side is nothing.
fn solid(u: &mut Unstructured<'_>) -> Result<(Vec<Point3>, Vec<[u32; 3]>)> {
    const SIDES: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let (low, high) = (point(u)?, point(u)?);
    let vertices = (0..8)
        .map(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
            Point3::new(pick(0), pick(1), pick(2))
        })
        .collect();
    let triangles = SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Ok((vertices, triangles))
}

fn soup(u: &mut Unstructured<'_>) -> Result<(Vec<Point3>, Vec<[u32; 3]>)> {
    let vertices: Vec<Point3> =
        (0..u.int_in_range(0..=16)?).map(|_| point(u)).collect::<Result<_>>()?;
    let most = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
    let corner = |u: &mut Unstructured<'_>| u.int_in_range(0..=most);
    let triangles = (0..u.int_in_range(0..=24)?)
        .map(|_| Ok([corner(u)?, corner(u)?, corner(u)?]))
        .collect::<Result<_>>()?;
    Ok((vertices, triangles))
}
