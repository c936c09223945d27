//! Whether the robot was where it is said to have been.

use crate::filter::SelfMesh;

use super::raster::CLEARLY;
use super::seeing::Seeing;
use super::seen::Sight;

/// What collision meshes are larger than links are at most, m.
const LARGER: f64 = 0.05;
/// Of the surface of all links that a camera could have seen it looks past no more than this part where they are, ...
const MOST: f64 = 0.4;
/// ... and of one no more than this: hulls of open grippers have much that nothing is in.
const MOST_OF_LINK: f64 = 0.8;
/// Fewer samples tell nothing.
const LEAST: usize = 100;

impl Seeing<'_> {
    /// Of the surface of the robot, or of a link, that the camera could have seen, the share that it looked past; `None`
    /// where that is no more than of a robot that is there.
    pub(super) fn robot_passed(&self) -> Option<f64> {
        let of_link = |link: &SelfMesh| {
            let rays = link.samples().map(|place| place - self.image.sensor_origin);
            rays.fold([0; 2], |[passed, met], ray| {
                match self.raster.looks_past(&ray, LARGER / CLEARLY) {
                    true => [passed + 1, met],
                    false => [passed, met + usize::from(self.raster.sight(&ray) == Sight::Seen)],
                }
            })
        };
        let links: Vec<[usize; 2]> = self.image.robot.iter().map(of_link).collect();
        let all = links.iter().fold([0; 2], |[p, m], [q, n]| [p + q, m + n]);
        let told = |[passed, met]: [usize; 2], most: f64| {
            let share = passed as f64 / (passed + met).max(LEAST) as f64;
            (share > most).then_some(share)
        };
        told(all, MOST).or_else(|| links.into_iter().find_map(|link| told(link, MOST_OF_LINK)))
    }
}
