//! Poses of a family's scene, free and colliding, near contact and not.

use cloudtouch_geom::seed;
use rand_chacha::ChaCha8Rng;

use super::{scene::FamilyScene, seeing::Seen, wanted::Wanted};
use crate::{
    exact::WayOut,
    poses::{Approach, CONTACT_GAP, LabelledPose, NEAR},
    random::between,
};

/// How far free poses go back from contact, m.
const FARTHEST: f64 = 0.5;
/// How much closer than what is seen the surfaces may come near contact, m.
const HIDDEN: f64 = 0.005;

impl FamilyScene {
    /// `count` poses with exact answers; a smaller count with the same seed gives the first of them.
    ///
    /// The base rate of collisions is one half at every count: exactly when it is even, within one
    /// pose when it is odd. Of the free ones and of the colliding ones half are drawn within 3 cm of
    /// first contact (exactly when `count` is a multiple of four, else within one pose); since an
    /// overlap may be less deep than the way the body went, at least half have a |signed distance|
    /// up to 3 cm. Where a stratum stands in the sequence is drawn by the seed.
    ///
    /// The object goes straight to a first contact in a way that suits the family and then back, up
    /// to 50 cm, or on, up to 20 cm (hands and tools 6 to 10 cm, a sheet 60 cm). The depth of an
    /// overlap is bounded from above, see
    /// [`ExactMesh::shortest_way_out`](crate::exact::ExactMesh::shortest_way_out).
    ///
    /// # Panics
    /// When a thousand paths give no pose of a stratum: the bodies can hardly meet.
    pub fn poses(&self, count: usize, seed: u64) -> Vec<LabelledPose> {
        (0..count as u64)
            .map(|i| {
                let mut rng = seed::generator(seed::derive(seed, 1, i));
                self.pose(Wanted::of(i, seed), &mut rng)
            })
            .collect()
    }

    fn pose(&self, wanted: Wanted, rng: &mut ChaCha8Rng) -> LabelledPose {
        for _ in 0..1000 {
            let path = self.motion.approach(self.pair(), &self.seen[0], wanted, rng);
            let Some(approach) = path else { continue };
            let deepest = self.motion.deepest();
            let retreat = match wanted {
                // Not beyond where it came from: that is not known to be free.
                Wanted::NearFree => between(0.0, approach.contact.min(NEAR - CONTACT_GAP), rng),
                Wanted::Free => {
                    between(NEAR.min(approach.contact), approach.contact.min(FARTHEST), rng)
                }
                Wanted::NearDeep => -between(CONTACT_GAP, NEAR, rng),
                Wanted::Deep => -between(NEAR, deepest, rng),
            };
            let labelled = self.label(&approach, approach.contact - retreat);
            // Far enough ahead there may be no overlap any more.
            if labelled.in_collision != wanted.is_free() && self.shows(&labelled) {
                return labelled;
            }
        }
        panic!("a thousand approaches gave no pose that is {wanted:?}");
    }

    /// Whether the surface that sensors see shows what is true of a pose: it crosses where the bodies
    /// collide, and comes about as close as they do near contact. What nobody saw no method could
    /// tell.
    fn shows(&self, pose: &LabelledPose) -> bool {
        let [Seen::Surface(a), Seen::Surface(b)] = &self.seen else { return true };
        if pose.in_collision {
            return a.intersects(b, &pose.scene_from_object);
        }
        pose.signed_distance > NEAR
            || a.distance(b, &pose.scene_from_object) < pose.signed_distance + HIDDEN
    }

    /// The answer for a place on an approach, which is free up to its contact.
    fn label(&self, approach: &Approach, along: f64) -> LabelledPose {
        let scene_from_object = approach.pose(along);
        let in_collision = self.a.touches(&self.b, &scene_from_object, self.touch);
        let signed_distance = if in_collision {
            let back = WayOut { direction: -approach.direction, length: along - approach.contact };
            -self.a.shortest_way_out(&self.b, &scene_from_object, self.touch, back).length
        } else {
            self.a.distance(&self.b, &scene_from_object)
        };
        LabelledPose { scene_from_object, in_collision, signed_distance }
    }
}
