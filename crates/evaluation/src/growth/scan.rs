//! The scan near the gripper, with noise added to it, and the surface that a mesh of it makes.

use std::path::Path;

use anyhow::{Context, Result, bail};
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch_io::read_cloud;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// All randomness of the noise comes from this.
pub(super) const SEED: u64 = 2011;
/// How far around the gripper the scan is kept, m.
const MARGIN: f64 = 0.1;
/// Rows and columns of the pixels whose mean is one vertex of the mesh.
const BLOCK: usize = 4;
/// Measured points farther apart than this are on different surfaces, m.
const EDGE: f64 = 0.02;

/// The part of a depth image that the gripper comes near to.
pub(super) struct Scan {
    cloud: PointCloud,
    /// Rows of the pixels of each block that makes a vertex.
    blocks: Vec<Vec<usize>>,
    /// Triangles between the blocks.
    triangles: Vec<[u32; 3]>,
}

impl Scan {
    /// Reads the scan and forgets what is farther than 10 cm from a box around these points.
    pub(super) fn read(path: &Path, around: &[Point3]) -> Result<Self> {
        let mut cloud = read_cloud(path)?;
        let Some((width, height)) = cloud.image_size else {
            bail!("{} is no depth image", path.display());
        };
        let (low, high) = PointCloud::from_points(around.to_vec())
            .bounding_box()
            .context("nothing to be near")?;
        let (low, high) = (low.map(|v| v - MARGIN), high.map(|v| v + MARGIN));
        let is_near = |p: &Point3| low < *p && *p < high;
        for point in cloud.points.iter_mut().filter(|p| !is_near(p)) {
            *point = Vector3::repeat(f64::NAN).into();
        }
        let (blocks, triangles) = connect(&cloud.points, width, height);
        Ok(Self { cloud, blocks, triangles })
    }

    /// Number of points kept.
    pub(super) fn len(&self) -> usize {
        self.cloud.points.iter().filter(|p| is_finite(p)).count()
    }

    /// The image with normal errors of this standard deviation along each axis, m, added; those of
    /// one draw differ in nothing but their size.
    pub(super) fn with_noise(&self, std: f64, draw: u64) -> PointCloud {
        let seed = seed::derive(SEED, 5, draw);
        let points = add_noise(&self.cloud.points, NoiseKind::Gaussian, std, seed);
        PointCloud { points, ..self.cloud.clone() }
    }

    /// The mesh of a noisy image of this scan: means of 4 × 4 pixels, joined where the scan itself
    /// has no edge, which is more than a mesh of the noisy image alone could know.
    pub(super) fn mesh(&self, noisy: &PointCloud) -> Result<TriangleMesh> {
        let mean = |block: &Vec<usize>| {
            let sum: Vector3 = block.iter().map(|&row| noisy.points[row].coords).sum();
            Point3::from(sum / block.len() as f64)
        };
        let vertices = self.blocks.iter().map(mean).collect();
        Ok(TriangleMesh::try_new(vertices, self.triangles.clone())?)
    }
}

/// The corners of a box around the mesh in each of these poses.
pub(super) fn reach(mesh: &TriangleMesh, poses: &[Pose]) -> Vec<Point3> {
    let placed =
        |pose: &Pose| mesh.vertices().iter().map(|v| pose.transform_point(v)).collect::<Vec<_>>();
    poses.iter().flat_map(placed).collect()
}

fn is_finite(point: &Point3) -> bool {
    point.iter().all(|v| v.is_finite())
}

/// Blocks of pixels on one surface, and triangles between neighbouring blocks.
fn connect(points: &[Point3], width: usize, height: usize) -> (Vec<Vec<usize>>, Vec<[u32; 3]>) {
    let (columns, rows) = (width / BLOCK, height / BLOCK);
    let mut blocks = Vec::new();
    // For each place in the grid of blocks the number of the block and its middle.
    let mut grid: Vec<Option<(u32, Point3)>> = vec![None; columns * rows];
    for (place, cell) in grid.iter_mut().enumerate() {
        let (left, top) = (place % columns * BLOCK, place / columns * BLOCK);
        let pixels: Vec<usize> =
            (0..BLOCK * BLOCK).map(|k| (top + k / BLOCK) * width + left + k % BLOCK).collect();
        let middle = points[pixels[BLOCK * BLOCK / 2]];
        // NaN is not near.
        if pixels.iter().all(|&row| (points[row] - middle).norm() < EDGE) {
            *cell = Some((blocks.len() as u32, middle));
            blocks.push(pixels);
        }
    }
    let mut triangles = Vec::new();
    for row in 1..rows {
        for column in 1..columns {
            let at = |up: usize, left: usize| grid[(row - up) * columns + column - left];
            for corners in [[at(1, 1), at(0, 1), at(0, 0)], [at(1, 1), at(0, 0), at(1, 0)]] {
                let [Some(a), Some(b), Some(c)] = corners else { continue };
                if [(a, b), (b, c), (c, a)].iter().all(|(p, q)| (p.1 - q.1).norm() < EDGE) {
                    triangles.push([a.0, b.0, c.0]);
                }
            }
        }
    }
    (blocks, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_and_a_hole_are_no_surface() {
        // A wall a millimetre per pixel, with a step of 10 cm after half of its columns.
        let (width, height) = (32, 12);
        let mut points: Vec<Point3> = (0..width * height)
            .map(|row| {
                let (x, y) = ((row % width) as f64, (row / width) as f64);
                Point3::new(1e-3 * x, 1e-3 * y, if x < 16.0 { 1.0 } else { 1.1 })
            })
            .collect();
        let (blocks, triangles) = connect(&points, width, height);
        // Eight by three blocks; of seven gaps between columns one is the step.
        assert_eq!((blocks.len(), triangles.len()), (24, 2 * 6 * 2));
        points[0].x = f64::NAN;
        let (blocks, triangles) = connect(&points, width, height);
        assert_eq!((blocks.len(), triangles.len()), (23, 22));
    }
}
