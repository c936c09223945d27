//! Poses of a family's scene, free and colliding, near contact and not.

use cloudtouch_geom::seed;
use rand_chacha::ChaCha8Rng;

use super::{FamilyScene, observe::Seen};
use crate::{
    exact::WayOut,
    poses::{Approach, CONTACT_GAP, LabelledPose, NEAR},
    random::between,
};

/// How far free poses go back from contact, m.
const FARTHEST: f64 = 0.5;
/// How much closer than what is seen the surfaces may come near contact, m.
const HIDDEN: f64 = 0.005;

/// What a pose is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    NearFree,
    Free,
    NearDeep,
    Deep,
}

impl Wanted {
    const ALL: [Self; 4] = [Self::NearFree, Self::Free, Self::NearDeep, Self::Deep];

    pub(super) fn is_near(self) -> bool {
        matches!(self, Self::NearFree | Self::NearDeep)
    }

    fn is_free(self) -> bool {
        matches!(self, Self::NearFree | Self::Free)
    }
}

impl FamilyScene {
    /// `count` poses with exact answers, in an order of no meaning: at least half have a
    /// |signed distance| up to 3 cm, half collide, and so do about half of the near ones (exactly,
    /// but for these, when `count` is a multiple of four).
    ///
    /// The object goes straight to a first contact in a way that suits the family and then back, up
    /// to 50 cm, or on, up to 20 cm (the gripper 6 cm, a sheet 60 cm). The depth of an overlap is
    /// bounded from above, see [`ExactMesh::shortest_way_out`](crate::exact::ExactMesh::shortest_way_out).
    pub fn poses(&self, count: usize, seed: u64) -> Vec<LabelledPose> {
        let mut order: Vec<u64> = (0..count as u64).collect();
        order.sort_by_key(|&i| seed::derive(seed, 2, i));
        order
            .into_iter()
            .map(|i| {
                let mut rng = seed::generator(seed::derive(seed, 1, i));
                self.pose(Wanted::ALL[i as usize % 4], &mut rng)
            })
            .collect()
    }

    fn pose(&self, wanted: Wanted, rng: &mut ChaCha8Rng) -> LabelledPose {
        for _ in 0..1000 {
            let Some(approach) = self.approach(wanted, rng) else { continue };
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
