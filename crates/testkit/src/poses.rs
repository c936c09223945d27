//! Poses of an object around contact with a scene, labelled with the exact answer.

use cloudtouch_geom::{Pose, Vector3, seed};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::{
    exact::{ExactMesh, Touch},
    random,
    surface::{SurfaceSample, sample_surface},
};

/// A pose and what is true in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelledPose {
    /// Maps the object's frame into the scene's.
    pub scene_from_object: Pose,
    /// Whether the two solids overlap.
    pub in_collision: bool,
    /// Distance when free; in overlap minus an upper bound on the penetration depth, m; minus
    /// infinity when no way out was found.
    pub signed_distance: f64,
}

/// How far from contact "near" reaches, m.
pub const NEAR: f64 = 0.03;

/// The gap at which an approach counts as contact, m.
pub(crate) const CONTACT_GAP: f64 = 1e-4;

/// `count` poses: at least half with |signed distance| ≤ 3 cm, the rest up to 50 cm of retreat
/// from the first contact or 20 cm of advance into it, in an order of no meaning.
///
/// The object starts free, turned at random, somewhere in the scene's box (or around it when there
/// is no room), and moves straight toward a random point of the scene's surface until it touches;
/// then it goes back or on. Both
/// meshes must be closed; coarse ones give the same answers sooner.
///
/// # Panics
/// When no free place is found for the object in 10,000 tries.
pub fn poses_near_contact(
    scene: &ExactMesh,
    object: &ExactMesh,
    count: usize,
    seed: u64,
) -> Vec<LabelledPose> {
    let targets = sample_surface(scene.mesh(), 1000, seed::derive(seed, 0, 0));
    let grips = sample_surface(object.mesh(), 1000, seed::derive(seed, 0, 1));
    (0..count)
        .map(|i| {
            let mut rng = seed::generator(seed::derive(seed, 1, i as u64));
            let approach = Approach::draw(scene, object, Touch::Solids, &targets, &grips, &mut rng);
            let share = rng.random::<f64>();
            // Positive is back into the open.
            let retreat = match i % 4 {
                0 | 2 => (NEAR - CONTACT_GAP) * (2.0 * share - 1.0),
                1 => NEAR + (0.5 - NEAR) * share,
                _ => -(NEAR + (0.2 - NEAR) * share),
            };
            approach.labelled(scene, object, (approach.contact - retreat).max(0.0))
        })
        .collect()
}

/// What is true of one pose.
pub fn label(scene: &ExactMesh, object: &ExactMesh, scene_from_object: &Pose) -> LabelledPose {
    let depth = scene.penetration_depth(object, scene_from_object);
    let in_collision = depth > 0.0;
    let signed_distance =
        if in_collision { -depth } else { scene.distance(object, scene_from_object) };
    LabelledPose { scene_from_object: *scene_from_object, in_collision, signed_distance }
}

/// A straight path from a free pose into the scene.
pub(crate) struct Approach {
    pub(crate) rotation: UnitQuaternion<f64>,
    pub(crate) start: Vector3,
    /// Unit length.
    pub(crate) direction: Vector3,
    /// The last free distance along the path before the first contact, m.
    pub(crate) contact: f64,
}

impl Approach {
    /// Straight ahead from somewhere free to where the object touches.
    ///
    /// # Panics
    /// When no free place is found in 10,000 tries.
    pub(crate) fn draw(
        scene: &ExactMesh,
        object: &ExactMesh,
        touch: Touch,
        targets: &[SurfaceSample],
        grips: &[SurfaceSample],
        rng: &mut ChaCha8Rng,
    ) -> Self {
        let (low, high) = scene.mesh().bounding_box().expect("a mesh has vertices");
        let (object_low, object_high) = object.mesh().bounding_box().expect("a mesh has vertices");
        let diagonal = (object_high - object_low).norm();
        for attempt in 0..10_000 {
            let rotation = random::rotation(rng);
            // A room has free places within its box; around a solid the box has to grow.
            let margin = diagonal * (f64::from(attempt) / 100.0).min(1.0);
            let start = Vector3::from_fn(|k, _| {
                low[k] - margin + (high[k] - low[k] + 2.0 * margin) * rng.random::<f64>()
            });
            let grip = rotation * grips[rng.random_range(0..grips.len())].position.coords;
            let target = targets[rng.random_range(0..targets.len())].position.coords;
            // On arrival the two surface points coincide, so there is a contact before.
            let path = target - grip - start;
            let Some(direction) = path.try_normalize(0.05) else { continue };
            let mut approach = Self { rotation, start, direction, contact: 0.0 };
            if scene.touches(object, &approach.pose(0.0), touch) {
                continue;
            }
            // Rounding apart, the contact is there at the latest.
            if approach.advance(scene, object, path.norm() + CONTACT_GAP) {
                return approach;
            }
        }
        panic!("no free place for the object in or around the scene's box");
    }

    pub(crate) fn pose(&self, along: f64) -> Pose {
        let offset = Translation3::from(self.start + self.direction * along);
        Pose::from_isometry(Isometry3::from_parts(offset, self.rotation))
    }

    /// Moves on by the exact distance, which cannot jump over a contact, until that is small;
    /// whether it was before `limit` metres.
    pub(crate) fn advance(&mut self, scene: &ExactMesh, object: &ExactMesh, limit: f64) -> bool {
        while self.contact <= limit {
            let gap = scene.distance(object, &self.pose(self.contact));
            if gap < CONTACT_GAP {
                return true;
            }
            self.contact += gap;
        }
        false
    }

    fn labelled(&self, scene: &ExactMesh, object: &ExactMesh, along: f64) -> LabelledPose {
        let mut labelled = label(scene, object, &self.pose(along));
        if labelled.in_collision && along > self.contact {
            // The way it came is a way out, perhaps shorter than those tried.
            labelled.signed_distance = labelled.signed_distance.max(self.contact - along);
        }
        labelled
    }
}
