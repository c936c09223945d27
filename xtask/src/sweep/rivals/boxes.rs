//! Collision maps as motion planners keep them: every measured point fills a box of a grid, and
//! boxes either touch the other body or do not.

use std::time::Instant;

use cloudtouch_geom::{Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{
    math::Vector,
    partitioning::Bvh,
    query,
    shape::{Cuboid, Shape, TriMesh},
};

use super::box_cells::BoxCells;
use super::observed::spread;
use super::{Answer, Observed, RivalError, micros_since};

/// Boxes around the points of a cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BoxMap {
    side: f64,
}

/// The mesh that stands for B, indexed once for all poses.
pub(crate) struct ObjectMesh(TriMesh);

impl ObjectMesh {
    /// Builds the index.
    ///
    /// # Errors
    /// When parry refuses the mesh.
    pub(crate) fn try_new(mesh: &TriangleMesh) -> Result<Self, RivalError> {
        let vertices = mesh.vertices().iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
        TriMesh::new(vertices, mesh.triangles().to_vec())
            .map(Self)
            .map_err(|error| RivalError::Mesh { reason: error.to_string() })
    }
}

impl BoxMap {
    /// Boxes with that side in metres: 0.01 is what collision maps use.
    ///
    /// # Errors
    /// When the side is not positive and finite.
    pub(crate) fn try_new(side: f64) -> Result<Self, RivalError> {
        if side > 0.0 && side.is_finite() {
            return Ok(Self { side });
        }
        Err(RivalError::BoxSide { value: side })
    }

    /// The boxes of A against the surface of a mesh in the frame of B, which is how a scanned
    /// scene meets a known robot or object. B's own points are not used.
    ///
    /// The probability is 1 when a box touches a triangle, else 0. The score is minus the smallest
    /// distance, m, so all collisions have score 0. A box wholly inside the mesh does not touch its
    /// surface and is no collision.
    pub(crate) fn against_mesh(&self, observed: &Observed<'_>, mesh: &ObjectMesh) -> Answer {
        let start = Instant::now();
        let cells = BoxCells::around(observed.a(), self.side);
        let prepare_micros = micros_since(start);

        let start = Instant::now();
        let mesh_from_a = parry_pose(&observed.a_from_b().inverse());
        let part = |triangle: u32, cell: &Cuboid, mesh_from_cell: &DPose3| {
            distance(&DPose3::IDENTITY, &mesh.0.triangle(triangle), mesh_from_cell, cell)
        };
        let distance = least_distance(&cells, &mesh_from_a, mesh.0.bvh(), part);
        answer(distance, start, prepare_micros)
    }

    /// The boxes of A, along the axes of A, against those of B, along the axes of B; probability
    /// and score as in [`Self::against_mesh`].
    pub(crate) fn against_boxes(&self, observed: &Observed<'_>) -> Answer {
        let start = Instant::now();
        let cells = BoxCells::around(observed.a(), self.side);
        let others = BoxCells::around(observed.b(), self.side);
        let tree = others.tree();
        let prepare_micros = micros_since(start);

        let start = Instant::now();
        let b_from_a = parry_pose(&observed.a_from_b().inverse());
        let part = |other: u32, cell: &Cuboid, b_from_cell: &DPose3| {
            let b_from_other = DPose3::from_translation(others.centers[other as usize]);
            distance(&b_from_other, cell, b_from_cell, cell)
        };
        let distance = least_distance(&cells, &b_from_a, &tree, part);
        answer(distance, start, prepare_micros)
    }
}

fn answer(distance: f64, start: Instant, prepare_micros: f64) -> Answer {
    let probability = if distance == 0.0 { 1.0 } else { 0.0 };
    let micros = micros_since(start);
    Answer { score: -distance, probability: Some(probability), micros, prepare_micros }
}

/// The least distance of a cell to a part in the tree, m; zero as soon as one touches.
///
/// `distance_to_part` gets the name of a part, a cell, and the pose of the cell in the tree's frame.
fn least_distance(
    cells: &BoxCells,
    tree_from_cells: &DPose3,
    tree: &Bvh,
    distance_to_part: impl Fn(u32, &Cuboid, &DPose3) -> f64,
) -> f64 {
    let cell = Cuboid::new(Vector::splat(cells.half));
    let mut least = f64::MAX;
    for i in spread(cells.centers.len()) {
        let middle = tree_from_cells.transform_point(cells.centers[i]);
        let tree_from_cell = DPose3::from_parts(middle, tree_from_cells.rotation);
        // All cells are turned alike, but only parry knows how far a turned one reaches.
        let around = cell.compute_aabb(&tree_from_cell);
        let found = tree.find_best(
            least,
            |node, _| {
                let apart = (node.mins() - around.maxs).max(around.mins - node.maxs());
                apart.max(Vector::ZERO).length()
            },
            |part, _| Some(distance_to_part(part, &cell, &tree_from_cell)),
        );
        if let Some((_, distance)) = found {
            least = distance;
        }
        if least == 0.0 {
            break;
        }
    }
    least
}

/// Two shapes touch when no axis separates them; the distance otherwise, m, never zero.
fn distance(a_pose: &DPose3, a: &dyn Shape, b_pose: &DPose3, b: &dyn Shape) -> f64 {
    // Both are total for boxes and triangles. What cannot be told apart counts as touching.
    let touch = query::intersection_test(a_pose, a, b_pose, b).map_or(true, |t| t.intersecting);
    if touch {
        return 0.0;
    }
    query::distance(a_pose, a, b_pose, b).map_or(0.0, |d| d.distance).max(f64::MIN_POSITIVE)
}

fn parry_pose(pose: &Pose) -> DPose3 {
    DPose3::from(*pose.isometry())
}
