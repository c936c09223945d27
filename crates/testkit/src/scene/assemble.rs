//! Putting meshes together out of boxes and extruded outlines.

use cloudtouch_geom::{Point3, Pose, TriangleMesh};

use super::polygon::triangulate;

/// One mesh with the components of all `parts`; vertices are not merged across parts.
pub fn assemble(parts: impl IntoIterator<Item = TriangleMesh>) -> TriangleMesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for part in parts {
        let offset = vertices.len() as u32;
        vertices.extend_from_slice(part.vertices());
        triangles.extend(part.triangles().iter().map(|t| t.map(|i| i + offset)));
    }
    mesh(vertices, triangles)
}

/// The same mesh in another place.
pub fn moved(part: &TriangleMesh, pose: &Pose) -> TriangleMesh {
    let vertices = part.vertices().iter().map(|p| pose.transform_point(p)).collect();
    mesh(vertices, part.triangles().to_vec())
}

/// A mesh from parts that are valid by construction.
pub(super) fn mesh(vertices: Vec<Point3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(vertices, triangles).expect("generated meshes are valid")
}

/// The closed box between two corners.
pub(super) fn block(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let outline = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    prism(&outline, low[2], high[2])
}

/// The closed prism over an anticlockwise `outline` (x, y) between two heights.
pub(super) fn prism(outline: &[[f64; 2]], bottom: f64, top: f64) -> TriangleMesh {
    let n = outline.len() as u32;
    let level = |z: f64| outline.iter().map(move |&[x, y]| Point3::new(x, y, z));
    let vertices: Vec<_> = level(bottom).chain(level(top)).collect();
    let mut triangles = Vec::new();
    for [a, b, c] in triangulate(outline) {
        triangles.push([a, c, b]);
        triangles.push([a + n, b + n, c + n]);
    }
    for i in 0..n {
        let next = (i + 1) % n;
        triangles.push([i, next, next + n]);
        triangles.push([i, next + n, i + n]);
    }
    mesh(vertices, triangles)
}
