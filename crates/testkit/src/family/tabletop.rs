//! Household objects on a table before a depth camera, and a gripper.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3, seed};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    depth_view::DepthView,
    grasp::{Grasp, gripper},
    motion::Motion,
    place::SUNK,
    scene::FamilyScene,
    seeing::Seen,
};
use crate::{
    exact::{ExactMesh, Touch},
    random::between,
    scene::{assemble, cuboid, cylinder, moved, sphere, union_of_boxes},
    surface::{positions, sample_surface},
};

/// Half the sides of the table top, m.
const HALF_TABLE: [f64; 2] = [0.5, 0.35];

/// The table and four to six objects in the frame of a camera 0.8 to 1.5 m away that looks down at
/// 30° to 55°; the whole surface of the gripper is seen.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let world = table_with_objects(rng);
    let distance = between(0.8, 1.5, rng);
    let camera_from_world = look_at_table(distance, rng);
    let a = ExactMesh::new(&moved(&world, &camera_from_world));
    // Most of the table, whatever the distance.
    let view = DepthView::new(&a, 0.5 / distance, distance);
    let targets = positions(&view.surface(&a, 2000, seed::derive(seed, 100, 0)));
    let b = gripper();
    let grips = positions(&sample_surface(&b, 1000, seed::derive(seed, 100, 1)));
    let down = camera_from_world.transform_vector(&-Vector3::z());
    let b = ExactMesh::new(&b);
    let seen_b = Seen::Surface(Box::new(ExactMesh::new(b.mesh())));
    let motion = Motion::Grasp(Grasp { down, targets, grips });
    FamilyScene { a, b, touch: Touch::Solids, seen: [Seen::Image(view), seen_b], motion }
}

/// The camera's optical frame: z toward a point 5 cm above the table's middle, y down.
fn look_at_table(distance: f64, rng: &mut ChaCha8Rng) -> Pose {
    let (elevation, around) = (between(0.52, 0.96, rng), between(0.0, 7.0, rng));
    let aside = UnitQuaternion::from_scaled_axis(Vector3::z() * around) * Vector3::x();
    let back = aside * elevation.cos() + Vector3::z() * elevation.sin();
    let forward = -back;
    let right = forward.cross(&Vector3::z()).normalize();
    let axes = Matrix3::from_columns(&[right, forward.cross(&right), forward]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let position = Point3::new(0.0, 0.0, 0.05) + back * distance;
    Pose::from_isometry(Isometry3::from_parts(Translation3::from(position.coords), rotation))
        .inverse()
}

/// The table top at z = 0 on its legs, z up, with objects that keep apart.
fn table_with_objects(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let [w, d] = HALF_TABLE;
    let mut boxes = vec![[[-w, -d, -0.03], [w, d, 0.0]]];
    for [x, y] in [[-w, -d], [w - 0.05, -d], [w - 0.05, d - 0.05], [-w, d - 0.05]] {
        boxes.push([[x, y, -0.7], [x + 0.05, y + 0.05, -0.03]]);
    }
    let mut parts = vec![union_of_boxes(&boxes)];
    let mut taken: Vec<([f64; 2], f64)> = Vec::new();
    let wanted = rng.random_range(4..=6);
    // The first five are of different kinds.
    for kind in (0..5).cycle().take(wanted) {
        let (object, radius) = household_object(kind, rng);
        for _ in 0..100 {
            let at = [between(-0.75 * w, 0.75 * w, rng), between(-0.7 * d, 0.7 * d, rng)];
            let clear =
                |&([x, y], r): &([f64; 2], f64)| (x - at[0]).hypot(y - at[1]) > r + radius + 0.01;
            if taken.iter().all(clear) {
                taken.push((at, radius));
                let yaw = between(0.0, 7.0, rng);
                let offset = Vector3::new(at[0], at[1], -SUNK);
                let place = Pose::from_translation_rpy(offset, [0.0, 0.0, yaw]);
                parts.push(moved(&object, &place));
                break;
            }
        }
    }
    assemble(parts)
}

/// An object standing on z = 0 and the radius it needs around the z axis.
fn household_object(kind: usize, rng: &mut ChaCha8Rng) -> (TriangleMesh, f64) {
    let on_z = |part: &TriangleMesh, z: f64| {
        moved(part, &Pose::from_translation(Vector3::new(0.0, 0.0, z)))
    };
    match kind {
        // A mug with a handle that reaches into it.
        0 => {
            let (r, h) = (between(0.035, 0.05, rng), between(0.08, 0.12, rng));
            let handle = union_of_boxes(&[
                [[0.9 * r, -0.008, 0.25 * h], [r + 0.03, 0.008, 0.37 * h]],
                [[0.9 * r, -0.008, 0.68 * h], [r + 0.03, 0.008, 0.8 * h]],
                [[r + 0.018, -0.008, 0.37 * h], [r + 0.03, 0.008, 0.68 * h]],
            ]);
            (assemble([on_z(&cylinder(r, h, 24), 0.5 * h), handle]), r + 0.03)
        }
        // A carton.
        1 => {
            let [x, y] = [between(0.05, 0.1, rng), between(0.1, 0.2, rng)];
            let h = between(0.15, 0.28, rng);
            (on_z(&cuboid([x, y, h]), 0.5 * h), 0.5 * x.hypot(y))
        }
        // A ball.
        2 => {
            let r = between(0.04, 0.08, rng);
            (on_z(&sphere(r, 2), r - SUNK), r)
        }
        // A bottle: the neck starts within the body.
        3 => {
            let (r, h) = (between(0.03, 0.045, rng), between(0.15, 0.2, rng));
            let neck = on_z(&cylinder(0.4 * r, 0.12, 16), h + 0.04);
            (assemble([on_z(&cylinder(r, h, 24), 0.5 * h), neck]), r)
        }
        // A board standing upright.
        _ => {
            let (width, h) = (between(0.2, 0.3, rng), between(0.15, 0.25, rng));
            (on_z(&cuboid([0.02, width, h]), 0.5 * h), 0.5 * width)
        }
    }
}
