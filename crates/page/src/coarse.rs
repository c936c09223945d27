//! A mesh of fewer triangles, for pictures of meshes that are too large.

use std::collections::{BTreeSet, HashMap};

use cloudtouch::geom::{Point3, bounding_box};

/// How much larger the cells become until few enough triangles are left.
const GROWTH: f64 = 1.3;
/// How much smaller where a few corners far away left hardly any: fewer than one of so many that may be, ...
const FINER: f64 = 4.0;
const FEW: usize = 8;
/// ... and how often at most, for of triangles that are all one no more are left by any cells.
const MOST_FINER: u32 = 20;

/// The mesh itself if it has no more than `limit` triangles; otherwise with all corners of a cell of a
/// grid moved to the first of them, in cells so large that few enough triangles are left.
pub(crate) fn coarse(
    vertices: &[Point3],
    triangles: &[[u32; 3]],
    limit: usize,
) -> (Vec<Point3>, Vec<[u32; 3]>) {
    if triangles.len() <= limit {
        return (vertices.to_vec(), triangles.to_vec());
    }
    let Some((low, high)) = bounding_box(vertices) else { return (Vec::new(), Vec::new()) };
    // A flat square of so many cells along its sides would have about `limit` triangles.
    let mut cell = (high - low).norm() / (limit.max(1) as f64).sqrt();
    let mut found = clustered(vertices, triangles, &low, cell);
    if FEW * found.1.len() < limit {
        for _ in 0..MOST_FINER {
            cell /= FINER;
            found = clustered(vertices, triangles, &low, cell);
            if found.1.len() > limit {
                break;
            }
        }
    }
    while found.1.len() > limit {
        cell *= GROWTH;
        found = clustered(vertices, triangles, &low, cell);
    }
    found
}

fn clustered(
    vertices: &[Point3],
    triangles: &[[u32; 3]],
    low: &Point3,
    cell: f64,
) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let mut cells: HashMap<[i64; 3], u32> = HashMap::new();
    let mut corners = Vec::new();
    let mut moved = |vertex: &Point3| {
        let offset: [f64; 3] = (vertex - low).into();
        let key = offset.map(|x| (x / cell) as i64);
        *cells.entry(key).or_insert_with(|| {
            corners.push(*vertex);
            corners.len() as u32 - 1
        })
    };
    let to_corner: Vec<u32> = vertices.iter().map(&mut moved).collect();
    let mut seen = BTreeSet::new();
    let faces = triangles.iter().filter_map(|corners| {
        let face @ [a, b, c] = corners.map(|corner| to_corner[corner as usize]);
        let mut key = face;
        key.sort_unstable();
        (a != b && b != c && c != a && seen.insert(key)).then_some(face)
    });
    let faces = faces.collect();
    (corners, faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 1 m of `n` by `n` quads.
    fn square(n: u32) -> (Vec<Point3>, Vec<[u32; 3]>) {
        let side = n + 1;
        let at = |i: u32| f64::from(i) / f64::from(n);
        let vertices = (0..side * side).map(|i| Point3::new(at(i % side), at(i / side), 0.0));
        let quads = (0..n * n).map(|i| i / n * side + i % n);
        let triangles =
            quads.flat_map(|a| [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]).collect();
        (vertices.collect(), triangles)
    }

    #[test]
    fn a_large_mesh_keeps_its_extent_and_few_triangles_and_a_small_one_is_as_it_was() {
        let (vertices, triangles) = square(60);
        assert_eq!(coarse(&vertices, &triangles, 7200), (vertices.clone(), triangles.clone()));
        let (few, faces) = coarse(&vertices, &triangles, 1000);
        assert!((300..=1000).contains(&faces.len()), "{}", faces.len());
        assert!(faces.iter().flatten().all(|&corner| (corner as usize) < few.len()));
        let area = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| few[*i as usize]);
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        let total: f64 = faces.iter().map(area).sum();
        assert!(total > 0.85 && total < 1.0 + 1e-9, "{total}");
        assert_eq!(coarse(&vertices, &triangles, 0).1, Vec::<[u32; 3]>::new());
    }

    #[test]
    fn a_large_mesh_vanished_beside_a_triangle_far_away() {
        let (mut vertices, mut triangles) = square(60);
        let count = vertices.len() as u32;
        vertices.extend([0.0, 1.0, 2.0].map(|y| Point3::new(1e4, y, y * y)));
        triangles.push([count, count + 1, count + 2]);
        let (_, faces) = coarse(&vertices, &triangles, 1000);
        assert!((300..=1000).contains(&faces.len()), "{}", faces.len());
        // Of the same triangle over and over one is left, whatever the cells.
        assert_eq!(coarse(&vertices, &vec![[0, 1, 61]; 2000], 1000).1.len(), 1);
    }
}
