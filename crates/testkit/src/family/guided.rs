//! Paths of bodies that do not turn at random: hands ahead, upright robots, things set down flat.

use cloudtouch_geom::Vector3;
use nalgebra::UnitQuaternion;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{ends::Ends, pair::Pair};
use crate::{
    poses::Approach,
    random::{between, direction, direction_near, small_rotation, within},
};

/// A body whose z axis goes ahead, as a gripper's does.
pub(super) struct Reach {
    pub(super) ends: Ends,
    /// Where it may go, each with the angle that it may be off, rad.
    pub(super) ways: Vec<(Vector3, f64)>,
    /// The box, by its corners, of the things that it reaches for three times in four, m; else for
    /// any place that is seen.
    pub(super) things: [[f64; 3]; 2],
    /// How far before what it reaches for it starts, m.
    pub(super) from: f64,
}

impl Reach {
    /// To a point of the scene, rolled at random; `None` when it would start in contact.
    pub(super) fn approach(&self, pair: Pair, rng: &mut ChaCha8Rng) -> Option<Approach> {
        let (way, off) = &self.ways[rng.random_range(0..self.ways.len())];
        let ahead = direction_near(way, *off, rng);
        let is_thing = |p: &Vector3| {
            let [low, high] = self.things;
            (0..3).all(|k| low[k] < p[k] && p[k] < high[k])
        };
        let [mut target, grip] = self.ends.draw(rng);
        if rng.random::<f64>() < 0.75 {
            let mut others = (0..200).map(|_| self.ends.draw(rng)[0]);
            target = others.find(is_thing).unwrap_or(target);
        }
        pair.straight(reaching(target, grip, ahead, self.from, rng))
    }
}

/// With the z axis ahead, rolled at random, so far before the place where `grip` is at `target`.
pub(super) fn reaching(
    target: Vector3,
    grip: Vector3,
    ahead: Vector3,
    from: f64,
    rng: &mut ChaCha8Rng,
) -> Approach {
    let rotation = UnitQuaternion::face_towards(&ahead, &direction(rng));
    let start = target - rotation * grip - ahead * from;
    Approach { rotation, start, direction: ahead, contact: 0.0 }
}

/// A body that stays upright, as what stands on a floor or is carried does.
pub(super) struct Upright {
    pub(super) ends: Ends,
    /// How far it leans at most, rad.
    pub(super) lean: f64,
    /// The heights between which its origin keeps on a level path, m; any path when `None`.
    pub(super) level: Option<[f64; 2]>,
}

impl Upright {
    /// Turned about the vertical, from anywhere in the scene's box toward a point of the scene;
    /// `None` when it would start in contact or pass by.
    pub(super) fn approach(&self, pair: Pair, rng: &mut ChaCha8Rng) -> Option<Approach> {
        let about = Vector3::z() * between(0.0, std::f64::consts::TAU, rng);
        let rotation = small_rotation(self.lean, rng) * UnitQuaternion::from_scaled_axis(about);
        let (low, high) = pair.a.mesh().bounding_box().expect("a mesh has vertices");
        let mut start = Vector3::from_fn(|k, _| between(low[k], high[k], rng));
        let [target, grip] = self.ends.draw(rng);
        let mut path = target - rotation * grip - start;
        if let Some([lowest, highest]) = self.level {
            start.z = between(lowest, highest, rng);
            path.z = 0.0;
        }
        let direction = path.try_normalize(0.05)?;
        pair.straight(Approach { rotation, start, direction, contact: 0.0 })
    }
}

/// Upright but for a little, straight down or straight to a side.
pub(super) struct Flat {
    pub(super) ends: Ends,
}

impl Flat {
    /// Half of them lean by up to a degree, others by up to six; `None` when it would start in contact.
    pub(super) fn approach(&self, pair: Pair, rng: &mut ChaCha8Rng) -> Option<Approach> {
        let lean = if rng.random() { 0.02 } else { 0.1 };
        let quarter = std::f64::consts::FRAC_PI_2 * f64::from(rng.random_range(0..4_u8));
        let about = Vector3::z() * (quarter + within(0.3 * f64::from(rng.random::<bool>()), rng));
        let rotation = small_rotation(lean, rng) * UnitQuaternion::from_scaled_axis(about);
        let direction = match rng.random_range(0..4) {
            0 => Vector3::y(),
            1 => Vector3::x() * if rng.random() { 1.0 } else { -1.0 },
            _ => -Vector3::z(),
        };
        let [target, grip] = self.ends.draw(rng);
        let start = target - rotation * grip - direction * between(0.2, 0.6, rng);
        pair.straight(Approach { rotation, start, direction, contact: 0.0 })
    }
}
