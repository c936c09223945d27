//! A gripper on its way to the objects on a table.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use parry3d_f64::query::{ClosestPoints, closest_points};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{guided::reaching, pair::Pair, seeing::Seen};
use crate::exact::parry_pose;
use crate::{
    poses::{Approach, CONTACT_GAP},
    random::direction_near,
    scene::union_of_boxes,
};

/// Where the gripper goes, in the camera's frame.
pub(super) struct Grasp {
    /// Unit vector toward the floor.
    pub(super) down: Vector3,
    /// Points of A that the camera sees.
    pub(super) targets: Vec<Point3>,
    /// Points of the gripper.
    pub(super) grips: Vec<Point3>,
}

/// A palm of 10 cm × 8 cm × 3 cm below z = 0 and two fingers of 2 cm × 1.5 cm × 6 cm above, 6 cm
/// apart, along z; watertight as a whole.
pub(super) fn gripper() -> TriangleMesh {
    union_of_boxes(&[
        [[-0.05, -0.04, -0.03], [0.05, 0.04, 0.0]],
        [[-0.05, -0.0075, 0.0], [-0.03, 0.0075, 0.06]],
        [[0.03, -0.0075, 0.0], [0.05, 0.0075, 0.06]],
    ])
}

impl Grasp {
    /// Fingers ahead, from above or along the camera's view, half a metre to a point the camera
    /// sees; `None` when the first contact is at a place it does not see.
    pub(super) fn approach(
        &self,
        pair: Pair,
        seen: &Seen,
        rng: &mut ChaCha8Rng,
    ) -> Option<Approach> {
        let target = self.targets[rng.random_range(0..self.targets.len())].coords;
        let ahead = if rng.random() {
            direction_near(&self.down, 0.6, rng)
        } else {
            direction_near(&target, 0.25, rng)
        };
        let grip = self.grips[rng.random_range(0..self.grips.len())].coords;
        let approach = pair.straight(reaching(target, grip, ahead, 0.5, rng))?;
        first_contact_is_seen(pair, seen, &approach).then_some(approach)
    }
}

fn first_contact_is_seen(pair: Pair, seen: &Seen, approach: &Approach) -> bool {
    let Seen::Image(view) = seen else { return true };
    let placed = parry_pose(&approach.pose(approach.contact));
    let here = parry3d_f64::math::Pose::IDENTITY;
    let nearest =
        closest_points(&here, pair.a.shape(), &placed, pair.b.shape(), 10.0 * CONTACT_GAP)
            .expect("parry finds closest points of triangle meshes");
    match nearest {
        ClosestPoints::WithinMargin(on_a, _) => {
            view.sees(pair.a, &Point3::new(on_a.x, on_a.y, on_a.z))
        }
        ClosestPoints::Intersecting | ClosestPoints::Disjoint => false,
    }
}
